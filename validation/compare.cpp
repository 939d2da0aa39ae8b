// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-compare: runs the comparison table over the results of a profile.
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "validation/compare/runner.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  using namespace meltproof::validation;
  namespace fs = std::filesystem;
  Provenance provenance = begin_provenance(argc, argv);
  Program program("meltproof-compare",
                  "Runs the comparison table: every row is computed from the results of a profile, "
                  "judged by\nits rule, and checked against the verdict that the table declares. "
                  "Ends with status 1, after\nthe result is written, if a row cannot be computed "
                  "or is not as declared.\n\n"
                  "  meltproof-compare --table validation/comparisons.toml --results reports/work "
                  "--profile desk \\\n    --output reports/validation.json");
  std::string table_path, results, profile, output, verification, experiments, studies;
  bool schema = false, reference = false;
  auto& app = program.app;
  app.add_option("--table", table_path, "the comparison table (TOML)");
  app.add_option("--results", results, "folder of the results, with one folder for each profile");
  app.add_option("--profile", profile, "smoke, desk or paper: the folder within the results");
  app.add_option("-o,--output", output, "where the result goes (JSON)");
  app.add_option("--verification", verification,
                 "verification.json; default: beside the folder of the results");
  app.add_option("--experiments", experiments,
                 "folder of the campaigns; default: data/experiments beside the table's folder");
  app.add_option("--studies", studies,
                 "studies.json of meltproof-studies; without it u_num holds no study");
  app.add_flag("--schema", schema, "print the JSON Schema of the table and stop");
  app.add_flag("--reference", reference, "print the reference page of the table and stop");
  return program.run(argc, argv, [&] {
    ComparisonTable table;
    Input input = comparison_input(table);
    if (schema || reference) {
      fmt::print("{}", schema ? input.schema().dump(2) + "\n" : input.reference());
      return ExitStatus::success;
    }
    for (const auto& [option, value] : {std::pair{"--table", table_path},
                                        {"--results", results},
                                        {"--profile", profile},
                                        {"--output", output}}) {
      if (value.empty()) {
        throw InputError(fmt::format("{} is missing; see --help for an example", option));
      }
    }
    input.read(table_path);
    check(table, table_path);
    const fs::path base = fs::path(table_path).parent_path();
    const Places places{fs::path(results) / profile,
                        verification.empty()
                            ? (fs::path(results) / "../verification.json").lexically_normal()
                            : fs::path(verification),
                        experiments.empty() ? (base / "../data/experiments").lexically_normal()
                                            : fs::path(experiments),
                        studies};
    const auto rows = run_table(table, places, profile);

    std::set<fs::path> read = {table_path};
    if (fs::is_regular_file(places.studies)) {
      read.insert(places.studies);
    }
    for (const auto& result : rows) {
      const Row& row = result.row;
      for (const auto& path : simulated_files(row, places)) {
        if (fs::is_regular_file(path)) {
          read.insert(path);
        }
      }
      for (const auto& path : recordings(row, places)) {
        if (fs::is_regular_file(path)) {
          read.insert(path);
        }
      }
      const fs::path campaign = places.experiments / row.reference.campaign / "dataset.toml";
      if (row.has_reference && fs::is_regular_file(campaign)) {
        read.insert(campaign);
      }
    }
    for (const auto& path : read) {
      provenance.add_input(path);
    }
    provenance.resolved_input = input.resolved();
    provenance.wall_time = provenance.elapsed();
    auto document = report(rows, profile);
    document["provenance"] = provenance.json();
    write_file(output, document.dump(2) + "\n");

    if (!program.quiet()) {
      fmt::print("{}", text_table(rows));
    }
    for (const auto& failure : document["failures"]) {
      fmt::print(stderr, "meltproof-compare: {}\n", failure.get<std::string>());
    }
    return document["failures"].empty() ? ExitStatus::success : ExitStatus::failure;
  });
}
