// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/case.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "solver/verification/problems.hpp"

namespace meltproof::solver {

Input declare(VerificationCase& c) {
  InputTable root(
      "verification",
      "A case of the verification suite: an exact solution and how close the engine must come.");
  root.text(c.kind,
            {.name = "kind",
             .about = "Which exact solution.",
             .required = true,
             .choices = {"species_stripe", "conduction_slab", "conduction_contact", "stefan"}})
      .text(c.title, {.name = "title", .about = "Shown in the report.", .required = true})
      .text(
          c.reference,
          {.name = "reference", .about = "Where the exact solution comes from.", .required = true})
      .text(c.quantity,
            {.name = "quantity", .about = "What the error is the error of.", .required = true})
      .quantity(c.asked, {.name = "asked",
                          .unit = "1",
                          .about = "The largest relative error allowed at the finest spacing.",
                          .required = true,
                          .minimum = 0,
                          .maximum = 1})
      .quantities(c.spacings, {.name = "spacings",
                               .unit = "m",
                               .about = "Particle spacings, finest first, at least two.",
                               .required = true,
                               .minimum = 1e-9,
                               .maximum = 1})
      .quantity(c.length, {.name = "length",
                           .unit = "m",
                           .about = "Of the domain along the axis.",
                           .minimum = 1e-9})
      .quantity(c.width, {.name = "width",
                          .unit = "m",
                          .about = "Of the domain across, species_stripe only.",
                          .minimum = 1e-9})
      .quantity(
          c.z1,
          {.name = "z1", .unit = "m", .about = "Where the stripe begins, species_stripe only."})
      .quantity(c.z2,
                {.name = "z2", .unit = "m", .about = "Where the stripe ends, species_stripe only."})
      .quantity(c.diffusivity, {.name = "diffusivity",
                                .unit = "m2 s-1",
                                .about = "Of species, or of heat.",
                                .minimum = 0})
      .quantity(
          c.time,
          {.name = "time",
           .unit = "s",
           .about = "At which the solutions are compared; stefan: when the front is at `front`.",
           .minimum = 0})
      .quantity(c.stefan, {.name = "stefan",
                           .unit = "1",
                           .about = "Stefan number c (T_wall - T_melt)/L, stefan only.",
                           .minimum = 1e-3,
                           .maximum = 100})
      .quantity(c.front, {.name = "front",
                          .unit = "1",
                          .about = "Where the front ends, in lengths, stefan only.",
                          .minimum = 0.01,
                          .maximum = 0.9})
      .quantity(c.conductivity_ratio, {.name = "conductivity_ratio",
                                       .unit = "1",
                                       .about = "Right over left, conduction_contact only.",
                                       .minimum = 1e-4,
                                       .maximum = 1e4})
      .text(c.scheme, {.name = "scheme",
                       .about = "Of the species in time.",
                       .choices = {"midpoint", "as_printed"}})
      .text(c.species_operator, {.name = "operator",
                                 .about = "Lattice moments of the species operator that are exact.",
                                 .choices = {"none", "second", "fourth"}})
      .text(c.factor, {.name = "factor",
                       .about = "Of the species term.",
                       .choices = {"consistent", "as_printed"}});
  return Input(std::move(root));
}

double observed_order(const std::vector<VerificationRun>& runs) {
  return runs.size() < 2 ? 0
                         : std::log(runs[1].error / runs[0].error) /
                               std::log(runs[1].spacing / runs[0].spacing);
}

VerificationRun run_case(const VerificationCase& c, double spacing) {
  if (std::abs(c.length / spacing - std::round(c.length / spacing)) > 1e-6) {
    throw InputError(fmt::format("{}: the spacing {} um does not divide the length {} um", c.name,
                                 1e6 * spacing, 1e6 * c.length));
  }
  return c.kind == "species_stripe"       ? run_species_stripe(c, spacing)
         : c.kind == "conduction_slab"    ? run_conduction_slab(c, spacing)
         : c.kind == "conduction_contact" ? run_conduction_contact(c, spacing)
                                          : run_stefan(c, spacing);
}

nlohmann::json verify(const VerificationCase& c, std::string& profile) {
  if (c.spacings.size() < 2 || !std::is_sorted(c.spacings.begin(), c.spacings.end())) {
    throw InputError(fmt::format("{}: spacings: expected at least two, finest first", c.name));
  }
  std::vector<VerificationRun> runs;
  for (const double spacing : c.spacings) {
    runs.push_back(run_case(c, spacing));
  }
  std::vector<double> spacings, errors;
  std::vector<std::size_t> steps, particles;
  profile = "spacing [um],position [um],value [1],exact [1]\n";
  for (const auto& run : runs) {
    spacings.push_back(1e6 * run.spacing);
    errors.push_back(run.error);
    steps.push_back(run.steps);
    particles.push_back(run.particles);
    for (std::size_t i = 0; i < run.position.size(); ++i) {
      profile += fmt::format("{:.6g},{:.6g},{:.9g},{:.9g}\n", 1e6 * run.spacing,
                             1e6 * run.position[i], run.value[i], run.exact[i]);
    }
  }
  // Errors at the level of round-off have no order.
  const nlohmann::json order =
      runs.front().error > 1e-10 ? nlohmann::json(observed_order(runs)) : nlohmann::json();
  return {
      {"name", c.name},           {"kind", c.kind},         {"title", c.title},
      {"reference", c.reference}, {"quantity", c.quantity}, {"error", runs.front().error},
      {"asked", c.asked},         {"order", order},         {"pass", runs.front().error <= c.asked},
      {"spacings_um", spacings},  {"errors", errors},       {"steps", steps},
      {"particles", particles}};
}

}  // namespace meltproof::solver
