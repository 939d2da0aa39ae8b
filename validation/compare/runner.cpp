// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/runner.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "validation/compare/metric.hpp"
#include "validation/compare/recordings.hpp"
#include "validation/compare/rule.hpp"
#include "validation/metrics/log_ratio.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

bool simulated_there(const Row& row, const Places& places) {
  const auto files = simulated_files(row, places);
  return std::all_of(files.begin(), files.end(),
                     [](const auto& path) { return std::filesystem::is_regular_file(path); });
}

std::string number_text(const std::optional<double>& value, const std::string& unit) {
  return value ? fmt::format("{:.4g}{}", *value, unit == "1" ? "" : " " + unit) : "-";
}

std::string source_text(const Row& row, const Places& places) {
  if (!row.has_reference) {
    return !row.simulated.verification_case.empty() ? "exact solution"
           : row.metric == "number"                 ? "asked of every run"
                                                    : "conservation law";
  }
  if (!row.reference.recordings.empty()) {
    const auto paths = recordings(row, places);
    const bool synthetic = recorded_quantity(paths, row.reference.column).synthetic;
    return fmt::format("{}{} recording{} of {}: {}", synthetic ? "SYNTHETIC: " : "", paths.size(),
                       paths.size() > 1 ? "s" : "", row.reference.campaign, row.reference.column);
  }
  const Campaign campaign = reference_campaign(row, places);
  const auto& file = campaign.file(row.reference.file);
  return fmt::format("{}, doi {}; {}/{}: {} ({})",
                     file.source.empty() ? campaign.title : file.source, campaign.doi,
                     row.reference.campaign, file.name, row.reference.column, file.obtained);
}

std::string finding_text(const Row& row, const RowNumbers& n) {
  if (n.rises) {
    return fmt::format("smallest rise {}, u {}: {}", number_text(n.simulated, row.unit),
                       number_text(n.u_val, row.unit), n.details["trend"].get<std::string>());
  }
  if (n.error) {
    const auto absent = n.details.value("not_evaluated", std::vector<std::string>{});
    return fmt::format(
        "E = {}, u_val = {}{}", number_text(n.error, row.unit), number_text(n.u_val, row.unit),
        absent.empty()
            ? ""
            : fmt::format(" (a lower bound: {} not fully evaluated)", fmt::join(absent, " and ")));
  }
  return fmt::format("S = {}", number_text(n.simulated, row.unit));
}

void judge(RowResult& result, const Places& places) {
  const Row& row = result.row;
  result.source = source_text(row, places);
  if (row.waits_for == "simulation" && !simulated_there(row, places)) {
    result.verdict = "pending";
    result.finding = "there is no simulation of this row yet";
    if (row.metric == "difference" &&
        !(row.reference.where.empty() && row.reference.recordings.empty())) {
      const Datum measured = reference_number(row, places);
      result.numbers.measured = measured.value;
      result.numbers.u_data = measured.uncertainty;
    }
    return;
  }
  result.numbers = compute(row, places);
  if (result.numbers.reference_pending) {
    result.verdict = "pending";
    result.finding = result.numbers.simulated
                         ? finding_text(row, result.numbers) + "; the reference holds no number"
                         : "simulated; the reference holds no number";
    return;
  }
  const bool held = !result.numbers.details.contains("broken");
  result.verdict = held && obeys(row, result.numbers) ? "agrees" : "differs";
  result.finding = finding_text(row, result.numbers);
  for (const auto& sentence : result.numbers.details.value("broken", json::array())) {
    result.finding += "; " + sentence.get<std::string>();
  }
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(); }

json row_json(const RowResult& result) {
  const Row& row = result.row;
  const RowNumbers& n = result.numbers;
  json simulated = {{"value", row.simulated.value}};
  if (!row.simulated.verification_case.empty()) {
    simulated = {{"case", row.simulated.verification_case}};
  } else if (row.simulated.files.empty()) {
    simulated["file"] = row.simulated.file;
  } else {
    simulated["files"] = row.simulated.files;
  }
  json entry = {{"name", row.name},
                {"title", row.title},
                {"kind", row.kind},
                {"quantity", row.quantity},
                {"window", row.window},
                {"metric", row.metric},
                {"rule", rule_text(row)},
                {"rule_reason", row.rule_reason},
                {"coverage", row.coverage},
                {"S", or_null(n.simulated)},
                {"D", or_null(n.measured)},
                {"E", or_null(n.error)},
                {"u_num", or_null(n.u_num)},
                {"u_input", or_null(n.u_input)},
                {"u_D", or_null(n.u_data)},
                {"u_val", or_null(n.u_val)},
                {"lower", or_null(n.lower)},
                {"upper", or_null(n.upper)},
                {"unit", row.unit},
                {"verdict", result.verdict},
                {"declared", row.verdict},
                {"waits_for", row.waits_for.empty() ? json() : json(row.waits_for)},
                {"reason", row.reason},
                {"finding", result.finding},
                {"figure", row.figure},
                {"source", result.source},
                {"simulated", simulated},
                {"details", n.details}};
  entry["limit"] = row.rule == "at_most" ? json(row.limit) : json();
  entry["failure"] = result.failure.empty() ? json() : json(result.failure);
  return entry;
}

}  // namespace

RowResult run_row(const Row& row, const Places& places) {
  RowResult result;
  result.row = row;
  try {
    judge(result, places);
  } catch (const InputError& problem) {
    result.numbers = {};
    result.verdict = "not computed";
    result.finding = problem.what();
    result.failure = fmt::format("row \"{}\" cannot be computed: {}", row.name, problem.what());
    return result;
  }
  if (result.verdict != row.verdict) {
    result.failure = fmt::format(
        "row \"{}\": the table declares \"{}\", but it {} ({}). Find out why; only then change the "
        "declared verdict and its reason.",
        row.name, row.verdict, result.verdict == "pending" ? "is pending" : result.verdict,
        result.finding);
  }
  return result;
}

std::vector<RowResult> run_table(const ComparisonTable& table, const Places& places,
                                 const std::string& profile) {
  std::vector<RowResult> results;
  const json cases = std::filesystem::is_regular_file(places.verification)
                         ? read_json(places.verification)
                         : json::object();
  std::vector<bool> used(table.exceptions.size(), false);
  const auto applies = [&profile](const Exception& e) {
    return e.profile == profile || e.profile == "every";
  };
  for (auto& row : expand(table, cases)) {
    const Exception* exception = nullptr;
    for (std::size_t i = 0; i < table.exceptions.size(); ++i) {
      if (applies(table.exceptions[i]) && table.exceptions[i].is_about(row)) {
        exception = &table.exceptions[i];
        used[i] = true;
      }
    }
    if (exception != nullptr && exception->verdict == "left out") {
      RowResult result;
      result.row = row;
      result.row.reason = exception->reason;
      result.verdict = "pending";
      result.finding = fmt::format("not made in the profile {}", profile);
      results.push_back(std::move(result));
      continue;
    }
    if (exception != nullptr) {
      row.verdict = exception->verdict;
      row.reason = exception->reason;
      row.waits_for.clear();
    }
    results.push_back(run_row(row, places));
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    // Rows of verification cases exist only once the suite has run.
    const bool may_be_missing = table.exceptions[i].profile == "every" && cases.empty();
    if (applies(table.exceptions[i]) && !used[i] && !may_be_missing) {
      throw InputError(fmt::format(
          "an exception of the profile {} (\"{}\") is about no row: correct its rows or track.",
          profile, table.exceptions[i].reason));
    }
  }
  return results;
}

json statistics(const std::vector<RowResult>& results) {
  std::map<std::string, std::vector<RatioDatum>> quantities;
  for (const auto& result : results) {
    const auto& n = result.numbers;
    if (result.row.metric == "difference" && n.simulated && n.measured && *n.simulated > 0 &&
        *n.measured > 0) {
      const RatioDatum datum{*n.simulated, *n.measured, n.u_data.value_or(0) / *n.measured};
      quantities[result.row.quantity].push_back(datum);
      quantities["all"].push_back(datum);
    }
  }
  json list = json::array();
  for (const auto& [quantity, data] : quantities) {
    if (data.size() >= 2) {
      const auto found = log_ratio(data);
      list.push_back({{"quantity", quantity},
                      {"points", found.points},
                      {"bias", found.bias},
                      {"model_scatter", found.model_scatter},
                      {"measured_scatter", found.measured_scatter},
                      {"scatter_is_noise", found.scatter_is_noise}});
    }
  }
  return list;
}

json report(const std::vector<RowResult>& results, const std::string& profile) {
  json document = {{"profile", profile}, {"rows", json::array()}, {"failures", json::array()}};
  document["summary"] = {{"agrees", 0}, {"differs", 0}, {"pending", 0}, {"not computed", 0}};
  for (const auto& result : results) {
    document["rows"].push_back(row_json(result));
    auto& count = document["summary"][result.verdict];
    count = count.get<int>() + 1;
    if (!result.failure.empty()) {
      document["failures"].push_back(result.failure);
    }
  }
  document["statistics"] = statistics(results);
  return document;
}

std::string text_table(const std::vector<RowResult>& results) {
  std::size_t width = 4;
  for (const auto& result : results) {
    width = std::max(width, result.row.name.size());
  }
  std::string text = fmt::format("{:{}}  {:>12}  {:>12}  {:>10}  {:22}  {}\n", "row", width,
                                 "simulated", "measured", "u_val", "rule", "verdict");
  for (const auto& result : results) {
    const auto& n = result.numbers;
    const auto& unit = result.row.unit;
    text += fmt::format("{:{}}  {:>12}  {:>12}  {:>10}  {:22}  {}{}\n", result.row.name, width,
                        number_text(n.simulated, unit), number_text(n.measured, unit),
                        number_text(n.u_val, unit), rule_text(result.row), result.verdict,
                        result.failure.empty() ? "" : "  <-- not as declared");
  }
  return text;
}

}  // namespace meltproof::validation
