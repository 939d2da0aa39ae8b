// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-studies: observed orders and spreads of the runs that `make studies` left.
#include <filesystem>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "validation/studies/summary.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  using namespace meltproof::validation;
  Provenance provenance = begin_provenance(argc, argv);
  Program program("meltproof-studies",
                  "Compares the runs of the studies: observed order and uncertainty by spacing, "
                  "spread over\nnumerical choices, effect of physics. Runs that are not there yet "
                  "are named, not missed.\n\n"
                  "  meltproof-studies pipelines/studies.toml --results "
                  "validation/results/desk/studies \\\n    --output reports/studies.json");
  std::string declared, results, output;
  bool reference = false, schema = false;
  program.app.add_option("declaration", declared, "pipelines/studies.toml");
  program.app.add_option("--results", results, "folder with <run>.json of every finished run");
  program.app.add_option("-o,--output", output, "where the summary goes (JSON)");
  program.app.add_flag("--schema", schema, "print the JSON Schema of the declaration and stop");
  program.app.add_flag("--reference", reference, "print its reference page and stop");
  return program.run(argc, argv, [&] {
    StudyDeclaration studies;
    Input input = study_input(studies);
    if (schema || reference) {
      fmt::print("{}", schema ? input.schema().dump(2) + "\n" : input.reference());
      return ExitStatus::success;
    }
    if (declared.empty() || results.empty() || output.empty()) {
      throw InputError("name the declaration, --results and --output; see --help for an example");
    }
    input.read(declared);
    check(studies, declared);
    nlohmann::json summary = summarise(studies, results);
    provenance.add_input(declared);
    for (const auto& run : studies.runs) {
      const auto path = std::filesystem::path(results) / (run.name + ".json");
      if (std::filesystem::is_regular_file(path)) {
        provenance.add_input(path);
      }
    }
    provenance.resolved_input = input.resolved();
    provenance.wall_time = provenance.elapsed();
    summary["provenance"] = provenance.json();
    write_file(output, summary.dump(2) + "\n");
    return ExitStatus::success;
  });
}
