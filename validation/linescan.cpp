// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-linescan: the concentration along a line through a simulated track, against EDS.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "validation/eds/formats.hpp"
#include "validation/linescan/line_comparison.hpp"
#include "validation/linescan/line_options.hpp"
#include "validation/linescan/spectrum_report.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  using namespace meltproof::validation;
  Provenance provenance = begin_provenance(argc, argv);
  Program program("meltproof-linescan", line_scan_help());
  TypedLine typed;
  add_line_options(program.app, typed);
  return program.run(argc, argv, [&] {
    if (!typed.spectrum.empty()) {
      fmt::print("{}", describe_export(understand_spectrum(typed)));
      return ExitStatus::success;
    }
    const LineRequest request = understand(typed);
    nlohmann::json result;
    try {
      result = compare_line(request);
    } catch (const NoGrain& none) {
      fmt::print(stderr, "meltproof-linescan: {}\n", none.what());
      return ExitStatus::no_result;
    }
    provenance.add_input(request.run);
    for (const auto& file : files_of(request.measured)) {
      provenance.add_input(file);
    }
    provenance.wall_time = provenance.elapsed();
    result["provenance"] = provenance.json();
    write_file(typed.output, result.dump(2) + "\n");
    spdlog::info(
        "{}: {} points, {}", typed.output, result["simulated"]["position_um"].size(),
        result["status"] == "pending"
            ? "pending: " + result.value("pending_because", "no measured line scan was given")
            : fmt::format("RMSE {:.4f} over {} measured points",
                          result["metrics"]["RMSE"].get<double>(),
                          result["metrics"]["points"].get<std::size_t>()));
    return ExitStatus::success;
  });
}
