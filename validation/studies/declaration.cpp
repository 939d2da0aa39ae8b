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
                                .about = "Three spacings, numerical choices, physics, or an "
                                         "uncertain input.",
                                .required = true,
                                .choices = {"resolution", "numerical", "physics", "input"}})
            .text(series.base,
                  {.name = "base", .about = "What the others are compared with.", .required = true})
            .texts(series.runs, {.name = "runs",
                                 .about = "The runs; of a resolution from coarse to fine.",
                                 .required = true})
            .text(series.about, {.name = "about", .about = "What it is for.", .required = true})
            .flag(series.counted,
                  {.name = "counted", .about = "Whether its uncertainty enters u_num or u_input."})
            .text(series.key,
                  {.name = "input", .about = "Key of the case that the runs of an input set."})
            .text(series.value, {.name = "value",
                                 .about = "Of the input at the base, with unit; left out for a "
                                          "choice between laws."})
            .text(series.uncertainty,
                  {.name = "uncertainty",
                   .about = "Standard uncertainty of the input, with unit or in %."})
            .text(series.reason,
                  {.name = "reason", .about = "Where value and uncertainty of an input come from."})
            .flag(series.logarithmic,
                  {.name = "logarithmic",
                   .about = "The input is a factor, whose logarithm is uncertain."});
        return table;
      },
      true);
  return Input(std::move(root));
}

std::string setting_of(const StudyRun& run, const std::string& key) {
  for (const auto& setting : run.set) {
    if (setting.starts_with(key + "=")) {
      return setting.substr(key.size() + 1);
    }
  }
  return {};
}

namespace {

/// What is wrong with a series of kind input; empty if nothing is.
std::string fault_of_input(const StudySeries& series, const StudyDeclaration& studies) {
  if (series.key.empty() || series.reason.empty()) {
    return "needs the key `input` that its runs set and a `reason` with its source";
  }
  if (series.value.empty() != series.uncertainty.empty()) {
    return "has only one of `value` and `uncertainty`: give both, or, for a choice, neither";
  }
  if (series.runs.size() < 2 || series.runs.size() > 3) {
    return "expects its base and one or two other runs";
  }
  for (const auto& run : studies.runs) {
    const bool named =
        std::find(series.runs.begin(), series.runs.end(), run.name) != series.runs.end();
    if (named && run.name != series.base && setting_of(run, series.key).empty()) {
      return fmt::format("names the run \"{}\", which does not set {}", run.name, series.key);
    }
  }
  return {};
}

}  // namespace

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
    if (series.kind == "input") {
      if (const auto fault = fault_of_input(series, studies); !fault.empty()) {
        refuse(fmt::format("the input \"{}\" {}", series.name, fault));
      }
    }
  }
}

}  // namespace meltproof::validation
