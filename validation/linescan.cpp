// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-linescan: the concentration along a line through a simulated track, against EDS.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "base/units.hpp"
#include "validation/csv.hpp"
#include "validation/linescan/line_comparison.hpp"

namespace {

using namespace meltproof;
using namespace meltproof::validation;

/// What was typed, before it is understood.
struct Typed {
  std::string run, output = "linescan.json", grain, start, end, measured, sigma, silicon;
  std::string length = "20 um", step = "0.25 um", voltage = "30 kV", shift = "0 um", element = "Al";
};

/// The value of an option, with the option named in what is refused.
double quantity(const std::string& option, const std::string& text, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const InputError& problem) {
    throw InputError(fmt::format("{}: {}", option, problem.what()));
  }
}

Point point(const std::string& option, const std::string& text) {
  const auto parts = split_cells(text, ',');
  if (parts.size() != 3) {
    throw InputError(fmt::format(
        "{}: \"{}\" is no point: expected x, y and z with units, for example \"200 um, 40 um, -5 "
        "um\".",
        option, text));
  }
  return {quantity(option, parts[0], "m"), quantity(option, parts[1], "m"),
          quantity(option, parts[2], "m")};
}

LineRequest understand(const Typed& typed) {
  LineRequest request;
  request.run = typed.run;
  if (typed.grain.empty() == (typed.start.empty() || typed.end.empty())) {
    throw InputError(
        "which line? Expected either --grain depth, --grain lateral, or both --start and --end.");
  }
  if (!typed.grain.empty()) {
    request.grain = typed.grain == "depth" ? Direction::depth : Direction::lateral;
  } else {
    request.start = point("--start", typed.start);
    request.end = point("--end", typed.end);
  }
  request.length = quantity("--length", typed.length, "m");
  if (!(request.length > 0)) {
    throw InputError(fmt::format("--length: {} is no length of a line.", typed.length));
  }
  request.step = quantity("--step", typed.step, "m");
  request.voltage = quantity("--voltage", typed.voltage, "kV");
  request.bounds.shift = quantity("--shift", typed.shift, "m");
  if (!(request.bounds.shift >= 0)) {
    throw InputError(fmt::format("--shift: {} is less than nothing.", typed.shift));
  }
  if (!typed.sigma.empty()) {
    request.sigma = quantity("--interaction", typed.sigma, "m");
    if (!(*request.sigma >= 0)) {
      throw InputError(fmt::format("--interaction: {} is less than nothing.", typed.sigma));
    }
  }
  request.measured = typed.measured;
  request.from_silicon = typed.element == "Si";
  if (request.from_silicon) {
    if (typed.silicon.empty()) {
      throw InputError(
          "--element Si needs the silicon of the steel: add, for example, --base-silicon \"0.5 "
          "%\" as measured away from the track.");
    }
    request.silicon_of_base = quantity("--base-silicon", typed.silicon, "1");
  }
  return request;
}

}  // namespace

int main(int argc, char** argv) {
  Provenance provenance = begin_provenance(argc, argv);
  Program program("meltproof-linescan",
                  "Samples the concentration of AlSi10Mg along a line through the solidified track "
                  "of a\nrun, as the electron beam of an EDS measurement sees it, and compares it "
                  "with a measured\nline scan. Without one the result says \"pending\".\n\n"
                  "  meltproof-linescan run.h5 --grain depth --output linescan_depth.json\n"
                  "  meltproof-linescan run.h5 --grain depth --measured scan.csv --shift \"2 um\"");
  Typed typed;
  bool reversible = false;
  auto& app = program.app;
  app.add_option("run", typed.run, "run.h5 of meltproof-solve")->required();
  app.add_option("-o,--output", typed.output, "where the result goes (JSON)")
      ->capture_default_str();
  app.add_option("--grain", typed.grain,
                 "line through the molten additive grain nearest to the pool's edge")
      ->check(CLI::IsMember({"depth", "lateral"}));
  app.add_option("--start", typed.start, "first point of a line, \"x, y, z\" with units");
  app.add_option("--end", typed.end, "last point of a line");
  app.add_option("--length", typed.length, "of the line through a grain")->capture_default_str();
  app.add_option("--step", typed.step, "distance of the samples")->capture_default_str();
  app.add_option("--voltage", typed.voltage, "of the electron beam")->capture_default_str();
  app.add_option("--interaction", typed.sigma,
                 "standard deviation of the interaction volume, \"0 um\" for none; default from "
                 "the range of the X-rays");
  app.add_option("--measured", typed.measured, "measured line scan (CSV export with wt% or at%)");
  app.add_option("--shift", typed.shift, "largest shift that registration may fit")
      ->capture_default_str();
  app.add_flag("--reversible", reversible, "registration may also turn the line round");
  app.add_option("--element", typed.element, "that the measured concentration is taken from")
      ->check(CLI::IsMember({"Al", "Si"}))
      ->capture_default_str();
  app.add_option("--base-silicon", typed.silicon, "silicon in the steel, for --element Si");
  return program.run(argc, argv, [&] {
    LineRequest request = understand(typed);
    request.bounds.reversible = reversible;
    nlohmann::json result;
    try {
      result = compare_line(request);
    } catch (const NoGrain& none) {
      fmt::print(stderr, "meltproof-linescan: {}\n", none.what());
      return ExitStatus::no_result;
    }
    provenance.add_input(request.run);
    if (!request.measured.empty()) {
      provenance.add_input(request.measured);
    }
    provenance.wall_time = provenance.elapsed();
    result["provenance"] = provenance.json();
    write_file(typed.output, result.dump(2) + "\n");
    spdlog::info("{}: {} points, {}", typed.output, result["simulated"]["position_um"].size(),
                 result["status"] == "pending"
                     ? std::string("pending: no measured line scan was given")
                     : fmt::format("RMSE {:.4f} over {} measured points",
                                   result["metrics"]["RMSE"].get<double>(),
                                   result["metrics"]["points"].get<std::size_t>()));
    return ExitStatus::success;
  });
}
