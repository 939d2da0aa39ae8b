// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <omp.h>
#include <spdlog/spdlog.h>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/progress.hpp"
#include "base/provenance.hpp"
#include "solver/verification/case.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  Program program(
      "meltproof-verify",
      "Runs verification cases and compares them with their exact solutions.\n"
      "Example: meltproof-verify solver/verification --output reports/verification.json");
  std::vector<std::string> folders;
  std::string output, profiles;
  bool reference = false;
  program.app.add_option("folders", folders, "case folders, or folders of case folders");
  program.app.add_option("-o,--output", output, "the table of results (JSON)");
  program.app.add_option("--profiles-folder", profiles,
                         "folder for <case>/profile.csv; default: beside the output");
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
    // The cases are small: starting threads would cost more than they do.
    omp_set_num_threads(1);
    Provenance provenance = begin_provenance(argc, argv);
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::path folder : folders) {
      if (std::filesystem::exists(folder / "case.toml")) {
        files.push_back(folder / "case.toml");
        continue;
      }
      if (!std::filesystem::is_directory(folder)) {
        throw InputError(
            fmt::format("{} is no folder: expected one with a case.toml, or one of such folders",
                        folder.string()));
      }
      for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (std::filesystem::exists(entry.path() / "case.toml")) {
          files.push_back(entry.path() / "case.toml");
        }
      }
    }
    std::sort(files.begin(), files.end());
    if (files.empty()) {
      throw InputError(fmt::format("{}: no folder in it holds a case.toml", folders.front()));
    }
    const std::filesystem::path profile_folder =
        profiles.empty() ? std::filesystem::path(output).parent_path() / "verification"
                         : std::filesystem::path(profiles);
    nlohmann::json cases = nlohmann::json::array();
    bool all_pass = true;
    Progress progress("verify", static_cast<double>(files.size()));
    for (std::size_t i = 0; i < files.size(); ++i) {
      solver::VerificationCase c;
      Input input = solver::declare(c);
      input.read(files[i]);
      provenance.add_input(files[i]);
      c.name = files[i].parent_path().filename().string();
      progress.update(static_cast<double>(i), c.name);
      std::string profile;
      auto row = solver::verify(c, profile);
      const auto place = profile_folder / c.name / "profile.csv";
      write_file(place, profile);
      row["profile_csv"] = place.string();
      all_pass = all_pass && row["pass"].get<bool>();
      if (!program.quiet()) {
        fmt::print("{:<22} error {:8.2e}, asked {:7.1e}, order {:>5}  {}\n", c.name,
                   row["error"].get<double>(), c.asked,
                   row["order"].is_null() ? "-" : fmt::format("{:.2f}", row["order"].get<double>()),
                   row["pass"].get<bool>() ? "pass" : "FAIL");
      }
      cases.push_back(std::move(row));
    }
    provenance.wall_time = provenance.elapsed();
    write_file(output,
               nlohmann::json{{"cases", cases}, {"provenance", provenance.json()}}.dump(2) + "\n");
    return all_pass ? ExitStatus::success : ExitStatus::failure;
  });
}
