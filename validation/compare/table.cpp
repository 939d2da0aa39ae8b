// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/table.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/compare/metric.hpp"
#include "validation/compare/rule.hpp"

namespace meltproof::validation {
namespace {

InputTable simulated_table(SimulatedSource& s) {
  InputTable table("simulated", "Where the simulated number stands.");
  table
      .text(s.verification_case,
            {.name = "case", .about = "A case of verification.json, instead of a file."})
      .text(s.file, {.name = "file", .about = "JSON file in the folder of the profile."})
      .texts(s.files, {.name = "files", .about = "JSON files of a trend, in its order."})
      .text(s.value, {.name = "value", .about = "JSON pointer to the number."})
      .text(s.uncertainty,
            {.name = "uncertainty", .about = "JSON pointer to its standard uncertainty."})
      .text(s.over, {.name = "over",
                     .about = "JSON pointer to a number of the same file that divides `value`."})
      .text(s.spacing, {.name = "spacing",
                        .about = "JSON pointer to the particle spacing: both edges of an extent "
                                 "are taken as known to within one, so u = spacing / sqrt(6). "
                                 "Where `study` knows better, it is left out."})
      .text(s.study, {.name = "study",
                      .about = "Quantity of the studies (length, width, depth) whose relative "
                               "uncertainty by spacing and numerical choices enters u_num, and "
                               "by uncertain inputs u_input."})
      .texts(s.inputs, {.name = "inputs",
                        .about = "\"name = 5 %\": inputs of the studies whose relative standard "
                                 "uncertainty is another one here, with another material or beam; "
                                 "0 %: it does not exist here."})
      .text(s.unit, {.name = "unit", .about = "Of these numbers (udunits2)."});
  return table;
}

InputTable reference_table(ReferenceSource& r) {
  InputTable table("reference", "Where the measured number stands.");
  table
      .text(r.campaign,
            {.name = "campaign", .about = "Folder in data/experiments.", .required = true})
      .text(r.file, {.name = "file", .about = "CSV file of the campaign."})
      .texts(
          r.recordings,
          {.name = "recordings",
           .about = "Instead of `file`: summary.json of meltproof-thermography of each track, in "
                    "the campaign's folder."})
      .text(r.column, {.name = "column",
                       .about = "Column of the file; of recordings length or depth.",
                       .required = true})
      .texts(r.where, {.name = "where",
                       .about = "Conditions \"column = value\" that pick one row of the file; of a "
                                "trend one for each setting, in its order."})
      .quantity(r.relative_uncertainty,
                {.name = "relative_uncertainty",
                 .unit = "1",
                 .about = "Standard uncertainty as a share of the number, added in quadrature.",
                 .minimum = 0,
                 .maximum = 1});
  return table;
}

InputTable row_table(Row& row) {
  InputTable table("row", "One comparison.");
  table.text(row.name, {.name = "name", .about = "Short and unique.", .required = true})
      .texts(row.for_each, {.name = "for_each",
                            .about = "The row stands for one row per word, which replaces {} in "
                                     "name, title, case and file. Another row that has such a "
                                     "name counts instead."})
      .flag(row.every_case,
            {.name = "every_case",
             .about = "The row stands for one row per verification case that no other row names; "
                      "each keeps to what its case asks, at most `limit`."})
      .text(row.title, {.name = "title", .about = "For the report.", .required = true})
      .text(row.kind, {.name = "kind",
                       .about = "Against an exact solution, a published computation, a "
                                "measurement, or an order of settings.",
                       .required = true,
                       .choices = {"verification", "benchmark", "validation", "trend"}})
      .text(row.quantity, {.name = "quantity", .about = "What is compared.", .required = true})
      .text(row.unit, {.name = "unit", .about = "Of all numbers of the row (udunits2)."})
      .text(row.window, {.name = "window", .about = "What was averaged.", .required = true})
      .text(row.metric, {.name = "metric",
                         .about = "What is computed.",
                         .required = true,
                         .choices = metric_names()})
      .text(row.rule, {.name = "rule",
                       .about = "When the row agrees.",
                       .required = true,
                       .choices = rule_names()})
      .text(row.rule_reason, {.name = "rule_reason", .about = "Why this rule.", .required = true})
      .quantity(row.limit, {.name = "limit",
                            .unit = "1",
                            .about = "Of the rules at_most and at_least, in the row's unit."})
      .quantity(row.coverage, {.name = "coverage",
                               .unit = "1",
                               .about = "k: how many standard uncertainties a rule allows.",
                               .minimum = 0})
      .quantity(row.input_uncertainty,
                {.name = "input_uncertainty",
                 .unit = "1",
                 .about = "u_input in the row's unit; left out: what the studies found.",
                 .minimum = 0})
      .text(row.figure, {.name = "figure", .about = "That shows it.", .required = true})
      .text(row.verdict, {.name = "verdict",
                          .about = "What the row is known to give.",
                          .required = true,
                          .choices = {"agrees", "differs", "pending"}})
      .text(row.reason, {.name = "reason", .about = "Of the verdict.", .required = true})
      .text(row.waits_for, {.name = "waits_for",
                            .about = "What a pending row waits for.",
                            .choices = {"reference", "simulation"}})
      .table(simulated_table(row.simulated))
      .table(reference_table(row.reference), &row.has_reference);
  return table;
}

InputTable exception_table(Exception& e) {
  InputTable table("exception", "Rows that are otherwise in one profile.");
  table
      .text(e.profile, {.name = "profile",
                        .about = "In which profile.",
                        .required = true,
                        .choices = {"every", "smoke", "desk", "paper"}})
      .text(e.track, {.name = "track", .about = "Rows that read a file of this folder."})
      .texts(e.rows, {.name = "rows", .about = "Rows by name."})
      .text(e.verdict, {.name = "verdict",
                        .about = "What these rows are known to give there.",
                        .required = true,
                        .choices = {"agrees", "differs", "left out"}})
      .text(e.reason, {.name = "reason", .about = "Why.", .required = true});
  return table;
}

}  // namespace

bool Exception::is_about(const Row& row) const {
  if (std::find(rows.begin(), rows.end(), row.name) != rows.end()) {
    return true;
  }
  const auto reads = [&](const std::string& file) { return file.starts_with(track + "/"); };
  return !track.empty() &&
         (reads(row.simulated.file) ||
          std::any_of(row.simulated.files.begin(), row.simulated.files.end(), reads));
}

Input comparison_input(ComparisonTable& table) {
  InputTable root("The comparison table", "One row is one comparison.");
  root.tables(
      "row", "The comparisons, in the order of the report.",
      [&table](std::size_t) { return row_table(table.rows.emplace_back()); }, true);
  root.tables("exception", "What is known to be otherwise in one profile.",
              [&table](std::size_t) { return exception_table(table.exceptions.emplace_back()); });
  return Input(std::move(root));
}

void check(const ComparisonTable& table, const std::filesystem::path& path) {
  std::set<std::string> names;
  const auto refuse = [&](const Row& row, const std::string& what) {
    throw InputError(fmt::format("{}: row \"{}\": {}.", path.string(), row.name, what));
  };
  for (const auto& row : table.rows) {
    if (!names.insert(row.name).second) {
      refuse(row, "there are two rows of this name: give each its own");
    }
    if ((row.verdict == "pending") == row.waits_for.empty()) {
      refuse(row, row.waits_for.empty()
                      ? "it is pending but does not say what it waits_for (reference or simulation)"
                      : "it waits_for something although its verdict is not pending");
    }
    const auto& s = row.simulated;
    if (row.every_case) {
      if (!s.value.empty() || !s.file.empty() || !row.for_each.empty()) {
        refuse(row, "it stands for every_case, so it takes no for_each, file or value");
      }
      continue;
    }
    const int sources = (s.verification_case.empty() ? 0 : 1) + (s.file.empty() ? 0 : 1) +
                        (s.files.empty() ? 0 : 1);
    if (sources != 1) {
      refuse(row, "expected exactly one of case, file and files under [row.simulated]");
    }
    if (s.verification_case.empty() && s.value.empty()) {
      refuse(row, "[row.simulated] names no value: expected a JSON pointer");
    }
    const auto& r = row.reference;
    if (row.has_reference && r.file.empty() == r.recordings.empty()) {
      refuse(row, "expected exactly one of file and recordings under [row.reference]");
    }
    if (!r.recordings.empty() && (row.metric != "difference" || !r.where.empty())) {
      refuse(row, "recordings give one number: expected the metric \"difference\" and no `where`");
    }
    if (row.metric != "error_norm" && row.metric != "number" && !row.has_reference) {
      refuse(row, fmt::format("the metric \"{}\" needs a [row.reference]", row.metric));
    }
  }
}

namespace {

std::string filled(std::string text, const std::string& word) {
  for (auto at = text.find("{}"); at != std::string::npos; at = text.find("{}", at + word.size())) {
    text.replace(at, 2, word);
  }
  return text;
}

/// One row per case that ran or should have.
std::vector<Row> rows_of_cases(const Row& row, const nlohmann::json& verification) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const std::string& title, double asked) {
    Row one = row;
    one.name = one.simulated.verification_case = name;
    one.title = title;
    one.limit = std::min(asked, row.limit);
    rows.push_back(std::move(one));
  };
  for (const auto& entry : verification.value("cases", nlohmann::json::array())) {
    add(entry.value("name", ""), entry.value("title", ""), entry.value("asked", row.limit));
  }
  // A case without a result has no row to be judged by: it must fail, not vanish.
  for (const auto& name : verification.value("not_run", nlohmann::json::array())) {
    add(name.get<std::string>(), name.get<std::string>() + ", without a result", row.limit);
  }
  return rows.empty() ? std::vector{row} : rows;
}

}  // namespace

std::deque<Row> expand(const ComparisonTable& table, const nlohmann::json& verification) {
  std::set<std::string> written;
  for (const auto& row : table.rows) {
    if (row.for_each.empty() && !row.every_case) {
      written.insert(row.name);
    }
  }
  std::deque<Row> result;
  for (const auto& row : table.rows) {
    std::vector<Row> several;
    if (row.every_case) {
      several = rows_of_cases(row, verification);
    }
    for (const auto& word : row.for_each) {
      Row one = row;
      one.name = filled(row.name, word);
      one.title = filled(row.title, word);
      one.simulated.verification_case = filled(row.simulated.verification_case, word);
      one.simulated.file = filled(row.simulated.file, word);
      several.push_back(std::move(one));
    }
    if (row.for_each.empty() && !row.every_case) {
      result.push_back(row);
    }
    for (auto& one : several) {
      if (written.insert(one.name).second) {
        result.push_back(std::move(one));
      }
    }
  }
  return result;
}

}  // namespace meltproof::validation
