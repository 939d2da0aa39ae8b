// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-powder: from a size distribution to spheres at rest.
#include <chrono>
#include <iostream>

#include <fmt/format.h>

#include "base/program.hpp"
#include "base/progress.hpp"
#include "base/provenance.hpp"
#include "solver/powder/powder_bed.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  Provenance provenance = begin_provenance(argc, argv);
  Program program("meltproof-powder",
                  "Makes a powder bed by drop and roll.\n"
                  "Example: meltproof-powder bed.toml --output powder.h5");
  InputOptions options;
  options.add_to(program.app, "powder bed (TOML); see --reference");
  std::string output = "powder.h5";
  program.app.add_option("-o,--output", output, "artifact to write")->capture_default_str();
  return program.run(argc, argv, [&] {
    solver::PowderSettings settings;
    Input input(solver::powder_table(settings));
    const bool done = options.handle(input);
    if (!done || options.validate) {
      try {
        solver::check(settings);
      } catch (const InputError& problem) {
        throw InputError(options.path + ": " + problem.what());
      }
    }
    if (done) {
      return ExitStatus::success;
    }
    const auto start = std::chrono::steady_clock::now();
    solver::PowderBed bed;
    {
      Progress progress("powder", 1);
      bed = solver::generate(settings, [&progress](double share) { progress.update(share); });
    }
    provenance.resolved_input = input.resolved();
    for (const auto& file : input.files()) {
      provenance.add_input(file);
    }
    provenance.seed = settings.seed;
    provenance.wall_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    solver::write_powder_bed(output, bed, provenance);
    if (!program.quiet()) {
      std::cout << fmt::format(
          "{}: {} spheres of {} dropped\n"
          "  packing density {:.3f}, mean coordination {:.2f}\n"
          "  d10 {:.1f} um, d50 {:.1f} um, d90 {:.1f} um by volume\n"
          "  additive {:.2f} wt%\n",
          output, bed.spheres.size(), bed.dropped, bed.packing_density, bed.mean_coordination,
          bed.d10 * 1e6, bed.d50 * 1e6, bed.d90 * 1e6, 100 * bed.additive_mass_fraction);
    }
    return ExitStatus::success;
  });
}
