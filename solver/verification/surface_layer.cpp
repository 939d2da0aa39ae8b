// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/surface_layer.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "solver/verification/setup.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {
namespace {

/// Particles of a wall, so that nothing sees through it.
constexpr std::int64_t wall_layers = 4;

/// A layer on a wall whose surface is z = 0, periodic across.
struct Layer {
  Particles particles;
  Domain domain;
};

Layer make_layer(const VerificationCase& c, const Mixture& mixture, double spacing) {
  const auto across = static_cast<std::int64_t>(particles_along(c, c.width, spacing));
  const auto deep = static_cast<std::int64_t>(particles_along(c, c.height, spacing));
  Layer layer;
  layer.particles =
      fill_cells(c, spacing, mixture, {0, 0, -wall_layers}, {across, across, deep},
                 [](const Vector& at) { return at[2] < 0 ? Fill::wall : Fill::melt; });
  layer.domain.lower = {0, 0, -spacing * wall_layers};
  layer.domain.upper = {c.width, c.width, 2 * c.height};
  layer.domain.face[0] = layer.domain.face[1] = {Face::periodic, Face::periodic};
  return layer;
}

VerificationRun layer_run(const Engine& engine) {
  VerificationRun run;
  run.steps = engine.flow_steps();
  run.particles = engine.particles().size();
  run.position_name = "height above the wall";
  run.value_name = "pressure";
  run.value_unit = "Pa";
  return run;
}

}  // namespace

VerificationRun run_hydrostatic_free(const VerificationCase& c, double spacing) {
  const Mixture mixture = melt_and_wall(c);
  Layer layer = make_layer(c, mixture, spacing);
  Model model = surface_model(c);
  model.domain = layer.domain;
  const double stiffness = c.density * c.sound_speed * c.sound_speed;
  const double weight = c.density * c.height * c.gravity;
  // Layers of equal mass lie closer where they are compressed.
  const double depth_scale = c.sound_speed * c.sound_speed / c.gravity;
  for (Vector& at : layer.particles.position) {
    if (at[2] > 0) {
      at[2] = -depth_scale * std::log1p(-at[2] / (depth_scale * (1 + weight / stiffness)));
    }
  }
  Engine engine(std::move(layer.particles), mixture, constant_diffusivity(0), model);
  const auto exact = [&](const Vector& at) {
    return stiffness * ((1 + weight / stiffness) *
                            std::exp(-c.gravity * at[2] / (c.sound_speed * c.sound_speed)) -
                        1);
  };
  start_at_rest(engine, exact);
  const auto steps = static_cast<std::size_t>(c.steps);
  double early = 0, late = 0, fastest = 0;
  while (engine.flow_steps() < steps) {
    engine.step(1);
    const MeltMotion motion = melt_motion(engine);
    fastest = std::max(fastest, motion.fastest);
    double& part = engine.flow_steps() * 4 < steps ? early : late;
    if (engine.flow_steps() * 4 < steps || engine.flow_steps() * 4 > 3 * steps) {
      part = std::max(part, motion.root_mean_square);
    }
  }
  VerificationRun run = layer_run(engine);
  const Particles& particles = engine.particles();
  double worst = 0;
  for (const std::uint32_t i : engine.flow().liquid()) {
    run.position.push_back(particles.position[i][2]);
    run.value.push_back(engine.flow().pressure(i));
    run.exact.push_back(exact(particles.position[i]));
    worst = std::max(worst, std::abs(run.value.back() - run.exact.back()) / weight);
  }
  run.error = l2_error(run);
  const double free_fall = std::sqrt(c.gravity * c.height);
  run.extra = {{"largest_error_over_bottom_pressure", worst},
               {"time_us", 1e6 * engine.time()},
               {"rms_speed_first_quarter_over_sqrt_gh", early / free_fall},
               {"rms_speed_last_quarter_over_sqrt_gh", late / free_fall},
               {"fastest_speed_over_sqrt_gh", fastest / free_fall},
               {"clumped_share", melt_motion(engine).clumped}};
  if (!(late <= 0.01 * free_fall) || !(late <= early)) {
    run.broken.push_back(
        fmt::format("the layer does not come to rest: rms speed {:.3g} of sqrt(g h) in the last "
                    "quarter, {:.3g} "
                    "in the first",
                    late / free_fall, early / free_fall));
  }
  return run;
}

VerificationRun run_recoil_flat(const VerificationCase& c, double spacing) {
  Material melt = melt_and_wall(c).base(), wall = melt_and_wall(c).additive();
  for (Material* vapour : {&melt, &wall}) {
    vapour->molar_mass = 57.96e-3;
    vapour->latent_heat_vaporisation = 6.09e6;
    vapour->boiling = 3073;
  }
  const Mixture mixture(melt, wall);
  // Written out once more, so that a wrong factor in the term cannot hide in both.
  const double exact =
      0.54 * 101325 *
      std::exp(6.09e6 * 57.96e-3 / 8.31446261815324 * (1 / 3073. - 1 / c.temperature));
  Layer layer = make_layer(c, mixture, spacing);
  Model model = surface_model(c);
  model.flow->recoil = true;
  model.domain = layer.domain;
  Engine engine(std::move(layer.particles), mixture, constant_diffusivity(0), model);
  std::mt19937 random(1);
  const auto shake = [&] {
    return c.speed * (2 * static_cast<double>(random()) / 4294967295.0 - 1);
  };
  start_moving(
      engine, [&](const Vector&) { return exact; },
      [&](const Vector&) -> Vector {
        // In this order: a list in braces is evaluated from the left.
        return {shake(), shake(), shake()};
      });
  std::vector<double> sum(static_cast<std::size_t>(c.height / spacing) + 1), count(sum.size());
  double below = 0, repulsion = 0;
  int counted = 0;
  constexpr int samples = 200;
  for (int i = 1; i <= samples; ++i) {
    run_until(engine, c.time * i / samples);
    if (2 * i <= samples) {
      continue;
    }
    const MeanPressure deep = mean_pressure(
        engine, [&](const Vector& at) { return at[2] < c.height - engine.kernel().support(); });
    below += deep.total();
    repulsion += deep.repulsion;
    ++counted;
    for (const std::uint32_t p : engine.flow().liquid()) {
      const double z = engine.particles().position[p][2];
      const auto bin = static_cast<std::size_t>(
          std::clamp(z / spacing, 0.0, static_cast<double>(sum.size()) - 1));
      sum[bin] += engine.flow().pressure(p);
      ++count[bin];
    }
  }
  VerificationRun run = layer_run(engine);
  for (std::size_t bin = 0; bin < sum.size(); ++bin) {
    if (count[bin] > 0) {
      run.position.push_back((static_cast<double>(bin) + 0.5) * spacing);
      run.value.push_back(sum[bin] / count[bin]);
      run.exact.push_back(exact);
    }
  }
  const double pressure = below / counted;
  const MeltMotion motion = melt_motion(engine);
  run.error = std::abs(pressure / exact - 1);
  run.extra = {{"pressure_Pa", pressure},
               {"of_it_by_repulsion_Pa", repulsion / counted},
               {"exact_pressure_Pa", exact},
               {"parasitic_speed_m_per_s", motion.fastest},
               {"parasitic_speed_rms_m_per_s", motion.root_mean_square},
               {"clumped_share", motion.clumped}};
  return run;
}

VerificationRun run_thermocapillary_layer(const VerificationCase& c, double spacing) {
  const auto along = static_cast<std::int64_t>(particles_along(c, c.length, spacing));
  const auto deep = static_cast<std::int64_t>(particles_along(c, c.height, spacing));
  const Mixture mixture = melt_and_wall(c);
  const bool flat = c.dimensions == 2;
  const std::size_t up = flat ? 1 : 2;
  const auto across =
      flat ? std::int64_t{1} : static_cast<std::int64_t>(particles_along(c, c.width, spacing));
  Particles particles =
      fill_cells(c, spacing, mixture, {0, flat ? -wall_layers : 0, flat ? 0 : -wall_layers},
                 {along, flat ? deep : across, flat ? 1 : deep},
                 [up](const Vector& at) { return at[up] < 0 ? Fill::wall : Fill::melt; });
  const auto temperature = [&](double x) {
    return c.temperature + c.temperature_gradient * (x - c.length / 2);
  };
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.enthalpy[i] =
        mixture.enthalpy(temperature(particles.position[i][0]), particles.concentration[i]);
  }
  Model model = surface_model(c);
  model.conduction = true;
  model.domain.lower[up] = -spacing * wall_layers;
  model.domain.upper = {c.length, c.width, 0};
  model.domain.upper[up] = 2 * c.height;
  if (!flat) {
    model.domain.face[1] = {Face::periodic, Face::periodic};
  }
  model.domain.face[0] = {Face::temperature, Face::temperature};
  model.domain.temperature[0] = {temperature(0), temperature(c.length)};
  Engine engine(std::move(particles), mixture, constant_diffusivity(0), model);
  start_at_rest(engine,
                [&](const Vector& at) { return c.density * c.gravity * (c.height - at[up]); });

  struct Bin {
    double height = 0, speed = 0, count = 0;
  };
  std::vector<Bin> bins(static_cast<std::size_t>(deep));
  double gradient = 0, area = 0;
  int counted = 0;
  constexpr int samples = 200;
  const auto in_the_middle = [&](const Vector& at) {
    return std::abs(at[0] - c.length / 2) < c.length / 6;
  };
  for (int i = 1; i <= samples; ++i) {
    run_until(engine, c.time * i / samples);
    if (2 * i <= samples) {
      continue;
    }
    double tx = 0, xx = 0;
    for (const std::uint32_t p : engine.flow().liquid()) {
      const Vector& at = engine.particles().position[p];
      if (!in_the_middle(at)) {
        continue;
      }
      area += engine.flow().area(p);
      Bin& bin = bins[static_cast<std::size_t>(
          std::clamp(at[up] / spacing, 0.0, static_cast<double>(deep) - 1))];
      bin.height += at[up];
      bin.speed += engine.particles().velocity[p][0];
      ++bin.count;
      tx += (engine.particles().temperature[p] - c.temperature) * (at[0] - c.length / 2);
      xx += std::pow(at[0] - c.length / 2, 2);
    }
    gradient += tx / xx;
    ++counted;
  }
  const double pull = c.surface_tension_slope * c.temperature_gradient;
  const double scale = pull * c.height / c.viscosity;
  const auto exact = [&](double s) { return scale * (0.75 * s * s - 0.5 * s); };
  VerificationRun run = layer_run(engine);
  run.value_name = "speed";
  run.value_unit = "m s-1";
  Eigen::MatrixXd base(static_cast<Eigen::Index>(bins.size()), 3);
  Eigen::VectorXd value(base.rows());
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double z = bins[b].height / bins[b].count, s = z / c.height;
    run.position.push_back(z);
    run.value.push_back(bins[b].speed / bins[b].count);
    run.exact.push_back(exact(s));
    base.row(static_cast<Eigen::Index>(b)) << 1, s, s * s;
    value(static_cast<Eigen::Index>(b)) = run.value.back();
  }
  const Eigen::Vector3d parabola = base.colPivHouseholderQr().solve(value);
  const double surface = parabola.sum();
  const MeltMotion motion = melt_motion(engine);
  run.error = std::abs(surface / exact(1) - 1);
  run.extra = {{"surface_speed_m_per_s", surface},
               {"exact_surface_speed_m_per_s", exact(1)},
               {"wall_speed_over_surface_speed", parabola[0] / exact(1)},
               {"shear_at_the_surface_over_exact", (parabola[1] + 2 * parabola[2]) / scale},
               {"surface_area_over_exact", area / counted / (c.length / 3) / (flat ? 1 : c.width)},
               {"profile_l2_error", l2_error(run)},
               {"temperature_gradient_over_imposed", gradient / counted / c.temperature_gradient},
               {"reynolds_number", c.density * std::abs(exact(1)) * c.height / c.viscosity},
               {"peclet_number", std::abs(exact(1)) * c.height / c.diffusivity},
               {"clumped_share", motion.clumped}};
  return run;
}

}  // namespace meltproof::solver
