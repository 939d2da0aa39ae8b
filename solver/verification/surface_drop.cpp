// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/surface_drop.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <gsl/gsl_multimin.h>

#include "solver/verification/setup.hpp"
#include "solver/verification/surface_setup.hpp"

namespace meltproof::solver {
namespace {

double norm(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// The drop's particles, its mixture, and its radius by volume.
struct Drop {
  Mixture mixture;
  Particles particles;
  double radius = 0;
};

Drop cut_drop(const VerificationCase& c, double spacing) {
  const auto cells = static_cast<std::int64_t>(std::ceil(c.radius / spacing)) + 1;
  Drop drop{.mixture = melt_and_wall(c), .particles = {}};
  drop.particles = fill_cells(
      c, spacing, drop.mixture, {-cells, -cells, -cells}, {cells, cells, cells},
      [&](const Vector& at) { return norm(at) < c.radius ? Fill::melt : Fill::nothing; });
  const double volume = static_cast<double>(drop.particles.size()) *
                        std::pow(spacing, static_cast<int>(c.dimensions));
  drop.radius = c.dimensions == 2 ? std::sqrt(volume / std::numbers::pi)
                                  : std::cbrt(3 * volume / (4 * std::numbers::pi));
  return drop;
}

Model drop_model(const VerificationCase& c) {
  Model model = surface_model(c);
  model.domain.lower = {-3 * c.radius, -3 * c.radius, -3 * c.radius};
  model.domain.upper = {3 * c.radius, 3 * c.radius, 3 * c.radius};
  return model;
}

/// A damped swing offset + exp(-decay t) [cosine cos(omega t) + sine sin(omega t)].
struct Swing {
  double omega = 0, decay = 0;              // 1/s
  double offset = 0, cosine = 0, sine = 0;  // of the quantity
  double residual = 0;                      // root mean square of what is left
};

/// Offset, cosine and sine are linear in the samples: least squares for given omega and decay.
Swing fit_linear(const std::vector<double>& t, const std::vector<double>& q, double omega,
                 double decay) {
  const auto n = static_cast<Eigen::Index>(t.size());
  Eigen::MatrixXd base(n, 3);
  Eigen::VectorXd value(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double now = t[static_cast<std::size_t>(i)], fade = std::exp(-decay * now);
    base.row(i) << 1, fade * std::cos(omega * now), fade * std::sin(omega * now);
    value(i) = q[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector3d x = base.colPivHouseholderQr().solve(value);
  return {.omega = omega,
          .decay = decay,
          .offset = x[0],
          .cosine = x[1],
          .sine = x[2],
          .residual = std::sqrt((base * x - value).squaredNorm() / static_cast<double>(n))};
}

/// The best omega and decay by a simplex that starts at the exact ones.
Swing fit_swing(const std::vector<double>& t, const std::vector<double>& q, double omega,
                double decay) {
  struct Samples {
    const std::vector<double>&t, &q;
    double omega;
  };
  Samples samples{t, q, omega};
  gsl_multimin_function misfit;
  misfit.n = 2;
  misfit.params = &samples;
  misfit.f = [](const gsl_vector* x, void* parameters) {
    const auto& s = *static_cast<Samples*>(parameters);
    return fit_linear(s.t, s.q, s.omega * gsl_vector_get(x, 0), s.omega * gsl_vector_get(x, 1))
        .residual;
  };
  gsl_vector* x = gsl_vector_alloc(2);
  gsl_vector* step = gsl_vector_alloc(2);
  gsl_vector_set(x, 0, 1);
  gsl_vector_set(x, 1, decay / omega);
  gsl_vector_set_all(step, 0.05);
  gsl_multimin_fminimizer* simplex =
      gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, 2);
  gsl_multimin_fminimizer_set(simplex, &misfit, x, step);
  for (int i = 0; i < 200 && gsl_multimin_fminimizer_size(simplex) > 1e-7; ++i) {
    if (gsl_multimin_fminimizer_iterate(simplex) != 0) {
      break;
    }
  }
  const gsl_vector* best = gsl_multimin_fminimizer_x(simplex);
  const Swing swing =
      fit_linear(t, q, omega * gsl_vector_get(best, 0), omega * gsl_vector_get(best, 1));
  gsl_multimin_fminimizer_free(simplex);
  gsl_vector_free(step);
  gsl_vector_free(x);
  return swing;
}

/// Second moment of mode n = 2 over the drop's own: zero for a sphere.
double prolateness(const Engine& engine, double radius) {
  const Particles& particles = engine.particles();
  double sum = 0, mass = 0;
  for (const std::uint32_t i : engine.flow().liquid()) {
    const Vector& at = particles.position[i];
    sum += particles.mass[i] * (2 * at[2] * at[2] - at[0] * at[0] - at[1] * at[1]);
    mass += particles.mass[i];
  }
  // A small swing a P2 of the radius gives 12/5 a/R... of R^2 M times 1/2; kept as the bare ratio.
  return sum / (mass * radius * radius);
}

}  // namespace

VerificationRun run_laplace_free(const VerificationCase& c, double spacing) {
  Drop drop = cut_drop(c, spacing);
  const double radius = drop.radius;
  const double exact = static_cast<double>(c.dimensions - 1) * c.surface_tension / radius;
  Engine engine(std::move(drop.particles), drop.mixture, constant_diffusivity(0), drop_model(c));
  start_at_rest(engine, [&](const Vector&) { return exact; });
  VerificationRun run;
  double sum = 0, repulsion = 0, speed_sum = 0, mean_speed_sum = 0;
  int counted = 0;
  constexpr int samples = 200;
  for (int i = 1; i <= samples; ++i) {
    run_until(engine, c.time * i / samples);
    const MeanPressure inside =
        mean_pressure(engine, [&](const Vector& at) { return norm(at) < radius / 2; });
    const double pressure = inside.total();
    run.position.push_back(engine.time());
    run.value.push_back(pressure);
    run.exact.push_back(exact);
    if (2 * i > samples) {
      const MeltMotion motion = melt_motion(engine);
      sum += pressure;
      repulsion += inside.repulsion;
      speed_sum += motion.fastest;
      mean_speed_sum += motion.root_mean_square;
      ++counted;
    }
  }
  const double pressure = sum / counted, fastest = speed_sum / counted;
  run.steps = engine.flow_steps();
  run.particles = engine.particles().size();
  run.position_name = "time";
  run.position_unit = "us";
  run.value_name = "pressure";
  run.value_unit = "Pa";
  run.error = std::abs(pressure / exact - 1);
  run.extra = {{"pressure_Pa", pressure},
               {"of_it_by_repulsion_Pa", repulsion / counted},
               {"exact_pressure_Pa", exact},
               {"radius_um", 1e6 * radius},
               {"radius_spacings", radius / spacing},
               {"parasitic_speed_m_per_s", fastest},
               {"parasitic_speed_rms_m_per_s", mean_speed_sum / counted},
               {"parasitic_capillary_number", c.viscosity * fastest / c.surface_tension},
               {"clumped_share", melt_motion(engine).clumped}};
  return run;
}

VerificationRun run_oscillating_drop(const VerificationCase& c, double spacing) {
  Drop drop = cut_drop(c, spacing);
  const double radius = drop.radius, pi = std::numbers::pi;
  const double rayleigh = std::sqrt(8 * c.surface_tension / (c.density * std::pow(radius, 3)));
  const double lamb = 5 * c.viscosity / (c.density * radius * radius);
  const double exact = std::sqrt(rayleigh * rayleigh - lamb * lamb);
  const double pressure = 2 * c.surface_tension / radius;
  Engine engine(std::move(drop.particles), drop.mixture, constant_diffusivity(0), drop_model(c));
  const double strain = c.speed / (2 * radius);
  start_moving(
      engine, [&](const Vector&) { return pressure; },
      [&](const Vector& at) -> Vector {
        return {-strain * at[0], -strain * at[1], 2 * strain * at[2]};
      });
  VerificationRun run;
  nlohmann::json crossings = nlohmann::json::array();
  constexpr int samples = 400;
  for (int i = 0; i <= samples; ++i) {
    run_until(engine, c.time * i / samples);
    const double now = engine.time(), q = prolateness(engine, radius);
    run.position.push_back(now);
    run.value.push_back(q);
  }
  const Swing swing = fit_swing(run.position, run.value, exact, lamb);
  const double amplitude = std::hypot(swing.cosine, swing.sine);
  for (std::size_t i = 1; i < run.value.size(); ++i) {
    const double before = run.value[i - 1] - swing.offset, after = run.value[i] - swing.offset;
    if ((before < 0) != (after < 0)) {
      const double share = before / (before - after);
      const double when = run.position[i - 1] + share * (run.position[i] - run.position[i - 1]);
      crossings.push_back(when * exact / pi);
    }
    // What the exact swing of the same amplitude and start would be.
  }
  for (const double now : run.position) {
    run.exact.push_back(amplitude * std::exp(-lamb * now) * std::sin(exact * now));
  }
  run.steps = engine.flow_steps();
  run.particles = engine.particles().size();
  run.position_name = "time";
  run.position_unit = "us";
  run.value_name = "second moment of mode 2 over M R^2";
  run.error = std::abs(swing.omega / exact - 1);
  run.extra = {{"frequency_over_exact", swing.omega / exact},
               {"period_us", 1e6 * 2 * pi / swing.omega},
               {"exact_period_us", 1e6 * 2 * pi / exact},
               {"undamped_period_us", 1e6 * 2 * pi / rayleigh},
               {"decay_rate_per_s", swing.decay},
               {"lamb_decay_rate_per_s", lamb},
               {"amplitude", amplitude},
               {"fit_residual_over_amplitude", swing.residual / amplitude},
               {"zero_crossings_in_half_periods", crossings},
               {"radius_um", 1e6 * radius},
               {"radius_spacings", radius / spacing},
               {"clumped_share", melt_motion(engine).clumped}};
  return run;
}

}  // namespace meltproof::solver
