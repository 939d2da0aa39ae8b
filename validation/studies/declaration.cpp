// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/studies/declaration.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {

Input study_input(StudyDeclaration& studies) {
  InputTable root("The studies", "Runs that differ in one number, and how they are compared.");
  root.text(studies.profile, {.name = "profile",
                              .about = "Whose spacing the base run has.",
                              .required = true,
                              .choices = {"smoke", "desk", "paper"}});
  root.tables(
      "run", "The runs, in the order in which they are made.",
      [&studies](std::size_t) {
        StudyRun& run = studies.runs.emplace_back();
        InputTable table("run", "One run.");
        table.text(run.name, {.name = "name", .about = "Of its result.", .required = true})
            .text(run.title, {.name = "title", .about = "What is different.", .required = true})
            .text(run.track, {.name = "track", .about = "Case of the solver.", .required = true})
            .text(run.powder, {.name = "powder", .about = "Case of its powder bed, if any."})
            .texts(run.set, {.name = "set", .about = "Overrides, \"table.key=value\"."});
        return table;
      },
      true);
  root.tables(
      "series", "What is compared with what.",
      [&studies](std::size_t) {
        StudySeries& series = studies.series.emplace_back();
        InputTable table("series", "Runs to be compared.");
        table.text(series.name, {.name = "name", .about = "Short and unique.", .required = true})
            .text(series.title, {.name = "title", .about = "For the report.", .required = true})
            .text(series.kind, {.name = "kind",
                                .about = "Three spacings, numerical choices, or physics.",
                                .required = true,
                                .choices = {"resolution", "numerical", "physics"}})
            .text(series.base,
                  {.name = "base", .about = "What the others are compared with.", .required = true})
            .texts(series.runs, {.name = "runs",
                                 .about = "The runs; of a resolution from coarse to fine.",
                                 .required = true})
            .text(series.about, {.name = "about", .about = "What it is for.", .required = true})
            .flag(series.counted,
                  {.name = "counted", .about = "Whether its uncertainty enters u_num."});
        return table;
      },
      true);
  return Input(std::move(root));
}

void check(const StudyDeclaration& studies, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}.", path.string(), what));
  };
  std::set<std::string> runs, series_names;
  for (const auto& run : studies.runs) {
    if (!runs.insert(run.name).second) {
      refuse(fmt::format("two runs are called \"{}\": give each its own name", run.name));
    }
  }
  for (const auto& series : studies.series) {
    if (!series_names.insert(series.name).second) {
      refuse(fmt::format("two series are called \"{}\": give each its own name", series.name));
    }
    for (const auto& name : series.runs) {
      if (!runs.contains(name)) {
        refuse(fmt::format("the series \"{}\" names the run \"{}\", which is not declared",
                           series.name, name));
      }
    }
    if (std::find(series.runs.begin(), series.runs.end(), series.base) == series.runs.end()) {
      refuse(
          fmt::format("the series \"{}\" does not hold its base \"{}\"", series.name, series.base));
    }
    if (series.kind == "resolution" && series.runs.size() != 3) {
      refuse(fmt::format("the resolution \"{}\" has {} runs: expected three spacings", series.name,
                         series.runs.size()));
    }
  }
}

}  // namespace meltproof::validation
