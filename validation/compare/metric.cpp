// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/metric.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/compare/input_share.hpp"
#include "validation/compare/recordings.hpp"
#include "validation/metrics/trend.hpp"
#include "validation/metrics/validation_error.hpp"

namespace meltproof::validation {
namespace {

RowNumbers difference(const Row& row, const Places& places) {
  RowNumbers n;
  const Datum measured = reference_number(row, places);
  n.measured = measured.value;
  n.u_data = measured.uncertainty;
  n.reference_pending = !measured.value;
  if (!row.reference.recordings.empty()) {
    const auto recorded = recorded_quantity(recordings(row, places), row.reference.column);
    n.details["u_D_parts"] = {{"scatter", recorded.scatter}, {"systematic", recorded.systematic}};
  }
  const auto simulated = simulated_number(row, row.simulated.file, places);
  n.simulated = simulated.value;
  n.u_num = simulated.uncertainty;
  n.details["u_num_parts"] = simulated.parts;
  const auto inputs = input_share(row, places);
  n.u_input = row.input_uncertainty;
  if (!n.u_input && inputs.relative) {
    n.u_input = *inputs.relative * std::abs(*n.simulated);
    n.details["u_input_shares"] = inputs.parts;
  }
  if (!row.input_uncertainty && !inputs.missing.empty()) {
    n.details["inputs_not_evaluated"] = inputs.missing;
  }
  if (n.measured) {
    const auto e = validation_error(*n.simulated, *n.measured,
                                    {.numerical = n.u_num, .input = n.u_input, .data = n.u_data},
                                    row.coverage);
    n.error = e.error;
    n.u_val = e.uncertainty;
    n.lower = e.lower;
    n.upper = e.upper;
    n.details["u_val_is_lower_bound"] =
        !e.complete || !simulated.studied || n.details.contains("inputs_not_evaluated");
    // Which one is absent, so that a missing sigma is named and not taken for zero.
    n.details["not_evaluated"] = nlohmann::json::array();
    for (const auto& [name, known] :
         {std::pair{"u_num", n.u_num.has_value() && simulated.studied},
          {"u_input", n.u_input && !n.details.contains("inputs_not_evaluated")},
          {"u_D", n.u_data.has_value()}}) {
      if (!known) {
        n.details["not_evaluated"].push_back(name);
      }
    }
  }
  return n;
}

RowNumbers error_norm(const Row& row, const Places& places) {
  RowNumbers n;
  if (row.simulated.verification_case.empty()) {
    n.simulated = std::abs(simulated_number(row, row.simulated.file, places).value);
    return n;
  }
  const auto found = verification_number(row, places);
  // The table, not the program that is tested, says what is asked.
  if (found.asked > row.limit) {
    throw InputError(fmt::format("{}: the case \"{}\" asks for {}, the comparison table for {}.",
                                 places.verification.string(), row.simulated.verification_case,
                                 found.asked, row.limit));
  }
  n.simulated = found.error;
  if (!found.broken.empty()) {
    n.details["broken"] = found.broken;
  }
  return n;
}

RowNumbers number(const Row& row, const Places& places) {
  RowNumbers n;
  n.simulated = simulated_number(row, row.simulated.file, places).value;
  return n;
}

RowNumbers curve(const Row& row, const Places& places) {
  RowNumbers n;
  const Campaign campaign = reference_campaign(row, places);
  n.reference_pending = campaign.file(row.reference.file).obtained == "pending";
  campaign.file(row.reference.file).column(row.reference.column);
  const auto path = places.results / row.simulated.file;
  const auto document = read_json(path);
  if (document.value("status", "") == "compared") {
    n.simulated = number_at(document, row.simulated.value, path);
  } else if (!n.reference_pending) {
    throw InputError(fmt::format(
        "{}: it was made without the measured curve that {} now holds: run meltproof-linescan "
        "again with --measured.",
        path.string(), row.reference.file));
  }
  return n;
}

/// What the reference says of the settings of a trend, in their order: a whole column (ranks, or
/// lengths), or, where the row names conditions, one number for each of them.
std::vector<double> measured_order(const Row& row, const Places& places) {
  const Campaign campaign = reference_campaign(row, places);
  const auto& file = campaign.file(row.reference.file);
  const auto& numbers = file.column(row.reference.column).numbers;
  if (row.reference.where.empty()) {
    return numbers;
  }
  std::vector<double> picked;
  for (const auto& condition : row.reference.where) {
    picked.push_back(numbers.at(file.row({condition})));
  }
  return picked;
}

RowNumbers trend_of(const Row& row, const Places& places) {
  RowNumbers n;
  const auto ranks = measured_order(row, places);
  if (ranks.size() != row.simulated.files.size()) {
    throw InputError(fmt::format("row \"{}\": {} files for {} ranks in {}: expected as many.",
                                 row.name, row.simulated.files.size(), ranks.size(),
                                 row.reference.file));
  }
  std::vector<double> values, uncertainties;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (i > 0 && !(ranks[i] > ranks[i - 1])) {
      throw InputError(
          fmt::format("row \"{}\": {} of {} does not rise from {} to {}: expected the settings in "
                      "the order in which it does.",
                      row.name, row.reference.column, row.reference.file, ranks[i - 1], ranks[i]));
    }
    const auto number = simulated_number(row, row.simulated.files[i], places);
    values.push_back(number.value);
    uncertainties.push_back(number.uncertainty.value_or(0));
  }
  // u_input has no part here: an input that is off moves all settings alike.
  const auto found = trend(values, uncertainties, row.coverage);
  const auto& weakest = found.steps[found.weakest];
  n.simulated = weakest.rise;
  n.u_num = n.u_val = weakest.uncertainty;
  n.rises = found.result == TrendResult::rises;
  n.details["values"] = values;
  n.details["reference"] = ranks;
  n.details["uncertainties"] = uncertainties;
  n.details["trend"] = found.result == TrendResult::rises   ? "rises"
                       : found.result == TrendResult::falls ? "falls"
                                                            : "undecided";
  n.details["confidence_of_each_rise"] = nlohmann::json::array();
  for (const auto& step : found.steps) {
    n.details["confidence_of_each_rise"].push_back(step.confidence);
  }
  return n;
}

using Metric = RowNumbers (*)(const Row&, const Places&);

const std::map<std::string, Metric>& metrics() {
  static const std::map<std::string, Metric> all = {{"difference", difference},
                                                    {"error_norm", error_norm},
                                                    {"number", number},
                                                    {"curve", curve},
                                                    {"trend", trend_of}};
  return all;
}

}  // namespace

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const auto& [name, metric] : metrics()) {
    names.push_back(name);
  }
  return names;
}

RowNumbers compute(const Row& row, const Places& places) {
  return metrics().at(row.metric)(row, places);
}

}  // namespace meltproof::validation
