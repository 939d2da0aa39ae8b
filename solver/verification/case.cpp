// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "solver/verification/kinds.hpp"

namespace meltproof::solver {
namespace {

void declare_texts(VerificationCase& c, InputTable& root) {
  std::vector<std::string> kinds;
  for (const auto& kind : verification_kinds()) {
    kinds.push_back(kind.name);
  }
  root.text(c.kind, {.name = "kind", .about = "Which problem.", .required = true, .choices = kinds})
      .text(c.title, {.name = "title", .about = "Shown in the report.", .required = true})
      .text(
          c.reference,
          {.name = "reference", .about = "Where the exact solution comes from.", .required = true})
      .text(c.quantity,
            {.name = "quantity", .about = "What the error is the error of.", .required = true})
      .flag(c.long_running,
            {.name = "long",
             .about = "Runs for more than 30 s: only with --long, otherwise its committed result "
                      "stands in the table."})
      .text(c.scheme, {.name = "scheme",
                       .about = "Of the species in time.",
                       .choices = {"midpoint", "as_printed"}})
      .text(c.species_operator, {.name = "operator",
                                 .about = "Lattice moments of the species operator that are exact.",
                                 .choices = {"none", "second", "fourth"}})
      .text(c.factor, {.name = "factor",
                       .about = "Of the species term.",
                       .choices = {"consistent", "as_printed"}})
      .text(c.variant, {.name = "variant",
                        .about = "Which of several forms of the problem; its kind says which."});
}

void declare_numbers(VerificationCase& c, InputTable& root) {
  const auto number = [&](double& target, std::string name, std::string unit, std::string about,
                          double minimum, double maximum) {
    root.quantity(target, {.name = std::move(name),
                           .unit = std::move(unit),
                           .about = std::move(about),
                           .minimum = minimum,
                           .maximum = maximum});
  };
  const double small = 1e-9, none = 0, any = std::numeric_limits<double>::infinity();
  root.quantity(c.asked, {.name = "asked",
                          .unit = "1",
                          .about = "The largest relative error allowed at the finest spacing.",
                          .required = true,
                          .minimum = 0,
                          .maximum = 1})
      .quantities(c.spacings, {.name = "spacings",
                               .unit = "m",
                               .about = "Particle spacings, finest first; two give an order.",
                               .required = true,
                               .minimum = 1e-9,
                               .maximum = 1})
      .whole(c.dimensions, {.name = "dimensions", .about = "Of space.", .minimum = 2, .maximum = 3})
      .whole(c.steps, {.name = "steps",
                       .about = "How many steps to run; 0: until `time`.",
                       .minimum = 0,
                       .maximum = 100'000'000});
  number(c.length, "length", "m", "Of the domain along the axis.", small, any);
  number(c.width, "width", "m", "Of the domain across.", small, any);
  number(c.height, "height", "m", "Of the domain, or of a layer.", small, any);
  number(c.radius, "radius", "m", "Of a drop, or 1/e2 radius of a beam.", small, any);
  number(c.z1, "z1", "m", "Where the stripe begins.", -any, any);
  number(c.z2, "z2", "m", "Where the stripe ends.", -any, any);
  number(c.time, "time", "s",
         "At which the solutions are compared; stefan: when the front is at `front`.", none, any);
  number(c.diffusivity, "diffusivity", "m2 s-1", "Of species, or of heat.", none, any);
  number(c.conductivity, "conductivity", "W m-1 K-1", "Of heat.", none, any);
  number(c.temperature, "temperature", "K", "At the start.", 1, 1e5);
  number(c.stefan, "stefan", "1", "Stefan number c |T_wall - T_melt|/L.", 1e-3, 100);
  number(c.superheat, "superheat", "1",
         "Two phases: |T_start - T_melt| on the far side over |T_wall - T_melt|.", none, 10);
  number(c.front, "front", "1", "Where the front ends, in lengths.", 0.01, 0.9);
  number(c.conductivity_ratio, "conductivity_ratio", "1", "Right over left, or solid over liquid.",
         1e-4, 1e4);
  number(c.power, "power", "W", "Of the laser.", none, 1e5);
  number(c.absorptivity, "absorptivity", "1", "For the laser.", none, 1);
  number(c.incidence_angle, "incidence_angle", "rad", "Of the laser, from the vertical.", none,
         1.4);
  number(c.reynolds, "reynolds", "1", "Reynolds number.", 1e-6, 1e6);
  number(c.speed, "speed", "m s-1", "Of the wall, the scan, or the mean flow.", none, 1e4);
  number(c.sound_speed, "sound_speed", "m s-1", "0: ten times the largest speed.", none, 1e6);
  number(c.density, "density", "kg m-3", "Of the (first) fluid.", 1e-6, 1e6);
  number(c.viscosity, "viscosity", "Pa s", "Of the (first) fluid.", none, 1e6);
  number(c.density_ratio, "density_ratio", "1", "First over second fluid.", 1e-6, 1e6);
  number(c.viscosity_ratio, "viscosity_ratio", "1", "First over second fluid.", 1e-6, 1e6);
  number(c.surface_tension, "surface_tension", "N m-1", "Of the interface.", none, 1e3);
  number(c.surface_tension_slope, "surface_tension_slope", "N m-1 K-1", "d sigma/d T.", -1e3, 1e3);
  number(c.temperature_gradient, "temperature_gradient", "K m-1", "Imposed.", -1e12, 1e12);
  number(c.gravity, "gravity", "m s-2", "Downward.", none, 1e6);
  number(c.pressure, "pressure", "Pa", "Imposed.", -1e12, 1e12);
}

}  // namespace

Input declare(VerificationCase& c) {
  InputTable root(
      "verification",
      "A case of the verification suite: an exact solution and how close the solver must come.");
  declare_texts(c, root);
  declare_numbers(c, root);
  return Input(std::move(root));
}

double observed_order(const std::vector<VerificationRun>& runs) {
  return runs.size() < 2 ? 0
                         : std::log(runs[1].error / runs[0].error) /
                               std::log(runs[1].spacing / runs[0].spacing);
}

std::size_t particles_along(const VerificationCase& c, double length, double spacing) {
  const double ratio = length / spacing;
  if (std::abs(ratio - std::round(ratio)) > 1e-6) {
    throw InputError(fmt::format("{}: the spacing {} um does not divide the length {} um", c.name,
                                 shortest(1e6 * spacing), shortest(1e6 * length)));
  }
  return static_cast<std::size_t>(std::llround(ratio));
}

VerificationRun run_case(const VerificationCase& c, double spacing) {
  VerificationRun run = find_kind(c.kind).run(c, spacing);
  run.spacing = spacing;
  return run;
}

namespace {

/// A run that blows up must not take the table of the others with it.
VerificationRun run_or_report(const VerificationCase& c, double spacing) {
  VerificationRun run;
  try {
    run = run_case(c, spacing);
    if (!std::isfinite(run.error)) {
      run.broken.emplace_back("the error is not a number");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& stopped) {
    run = {};
    run.spacing = spacing;
    run.error = std::numeric_limits<double>::infinity();
    run.broken.emplace_back(stopped.what());
  }
  // JSON has no infinity.
  run.error = std::isfinite(run.error) ? run.error : std::numeric_limits<double>::max();
  return run;
}

}  // namespace

nlohmann::json verify(const VerificationCase& c, std::string& profile) {
  if (c.spacings.empty() || !std::is_sorted(c.spacings.begin(), c.spacings.end())) {
    throw InputError(fmt::format("{}: spacings: expected at least one, finest first", c.name));
  }
  std::vector<VerificationRun> runs;
  for (const double spacing : c.spacings) {
    runs.push_back(run_or_report(c, spacing));
  }
  std::vector<double> spacings, errors;
  std::vector<std::size_t> steps, particles;
  const VerificationRun& finest = runs.front();
  profile = fmt::format("spacing [um],position [{}],value [{}],exact [{}]\n", finest.position_unit,
                        finest.value_unit, finest.value_unit);
  for (const auto& run : runs) {
    spacings.push_back(1e6 * run.spacing);
    errors.push_back(run.error);
    steps.push_back(run.steps);
    particles.push_back(run.particles);
    for (std::size_t i = 0; i < run.position.size(); ++i) {
      profile += fmt::format("{:.6g},{:.6g},{:.9g},{:.9g}\n", 1e6 * run.spacing,
                             run.position_scale * run.position[i], run.value[i], run.exact[i]);
    }
  }
  // Errors at the level of round-off have no order, nor has a single run.
  const nlohmann::json order = runs.size() > 1 && finest.error > 1e-10
                                   ? nlohmann::json(observed_order(runs))
                                   : nlohmann::json();
  const bool pass = finest.error <= c.asked && finest.broken.empty();
  return {{"name", c.name},
          {"kind", c.kind},
          {"title", c.title},
          {"reference", c.reference},
          {"quantity", c.quantity},
          {"error", finest.error},
          {"asked", c.asked},
          {"order", order},
          {"pass", pass},
          {"spacings_um", spacings},
          {"errors", errors},
          {"steps", steps},
          {"particles", particles},
          {"extra", finest.extra},
          {"broken", finest.broken},
          {"long", c.long_running},
          {"profile",
           {{"position", fmt::format("{} [{}]", finest.position_name, finest.position_unit)},
            {"value", fmt::format("{} [{}]", finest.value_name, finest.value_unit)}}}};
}

}  // namespace meltproof::solver
