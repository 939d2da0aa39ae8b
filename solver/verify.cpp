// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include <fmt/format.h>
#include <omp.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/progress.hpp"
#include "base/provenance.hpp"
#include "solver/verification/suite.hpp"

namespace {

void print_row(const nlohmann::json& row) {
  fmt::print("{:<26} error {:8.2e}, asked {:7.1e}, order {:>5}  {}{}\n",
             row["name"].get<std::string>(), row["error"].get<double>(), row["asked"].get<double>(),
             row["order"].is_null() ? "-" : fmt::format("{:.2f}", row["order"].get<double>()),
             row["pass"].get<bool>() ? "pass" : "FAIL",
             !row.contains("from") ? ""
             : row["stale"].get<bool>()
                 ? fmt::format(" ({}, stale)", row["from"].get<std::string>())
                 : fmt::format(" ({})", row["from"].get<std::string>()));
  for (const auto& sentence : row["broken"]) {
    fmt::print("  {}\n", sentence.get<std::string>());
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace meltproof;
  Program program(
      "meltproof-verify",
      "Runs verification cases and compares them with their exact solutions.\n"
      "Example: meltproof-verify solver/verification --output reports/verification.json");
  std::vector<std::string> folders;
  std::string output, profiles, results;
  bool reference = false, with_long = false;
  int threads = 1;
  program.app.add_option("folders", folders, "case folders, or folders of case folders");
  program.app.add_option("-o,--output", output, "the table of results (JSON)");
  program.app.add_option("--profiles-folder", profiles,
                         "folder for <case>/profile.csv; default: beside the output");
  program.app.add_flag(
      "--long", with_long,
      "also run the long cases, and write each one's result to the results folder");
  program.app.add_option("--results-folder", results,
                         "the committed results of long cases; default: results beside the cases");
  // Most cases are small: starting threads would cost more than they do.
  program.app.add_option("--threads", threads, "threads; the results do not depend on them")
      ->check(CLI::Range(1, 1024));
  program.app.add_flag("--reference", reference,
                       "print the reference page of case.toml (Markdown) and stop");
  return program.run(argc, argv, [&] {
    if (reference) {
      solver::VerificationCase blank;
      fmt::print("{}", solver::declare(blank).reference());
      return ExitStatus::success;
    }
    if (folders.empty() || output.empty()) {
      throw InputError("name at least one case folder and --output; see --help for an example");
    }
    omp_set_num_threads(threads);
    Provenance provenance = begin_provenance(argc, argv);
    provenance.threads = threads;
    const auto files = solver::find_cases(folders);
    const std::filesystem::path profile_folder =
        profiles.empty() ? std::filesystem::path(output).parent_path() / "verification"
                         : std::filesystem::path(profiles);
    nlohmann::json cases = nlohmann::json::array(), not_run = nlohmann::json::array();
    bool all_pass = true;
    Progress progress("verify", static_cast<double>(files.size()));
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto c = solver::read_case(files[i]);
      provenance.add_input(files[i]);
      progress.update(static_cast<double>(i), c.name);
      const solver::CommittedResults committed{
          results.empty() ? files[i].parent_path().parent_path() / "results"
                          : std::filesystem::path(results)};
      nlohmann::json row;
      if (c.long_running && !with_long) {
        row = committed.read(c, files[i]);
        if (row.is_null()) {
          spdlog::warn("{} runs long and has no result in {} yet: run it once with --long", c.name,
                       committed.folder.string());
          not_run.push_back(c.name);
          all_pass = false;
          continue;
        }
      } else {
        std::string profile;
        row = solver::verify(c, profile);
        if (c.long_running) {
          committed.write(row, profile, files[i]);
        }
        const auto place = profile_folder / c.name / "profile.csv";
        write_file(place, profile);
        row["profile_csv"] = place.string();
      }
      all_pass = all_pass && row["pass"].get<bool>();
      if (!program.quiet()) {
        print_row(row);
      }
      cases.push_back(std::move(row));
    }
    provenance.wall_time = provenance.elapsed();
    write_file(
        output,
        nlohmann::json{{"cases", cases}, {"not_run", not_run}, {"provenance", provenance.json()}}
                .dump(2) +
            "\n");
    return all_pass ? ExitStatus::success : ExitStatus::failure;
  });
}
