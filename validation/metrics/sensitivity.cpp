// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {

Sensitivity sensitivity(double input, double relative_uncertainty, double result,
                        std::span<const VariedInput> varied, bool logarithmic) {
  if (varied.empty() || varied.size() > 2) {
    throw InputError(fmt::format(
        "a sensitivity needs one or two runs beside the base: {} were given.", varied.size()));
  }
  if (result == 0 || input == 0 || (logarithmic && input < 0)) {
    throw InputError(
        fmt::format("a share of {} is no number: expected an input and a result other than zero{}.",
                    result == 0 ? result : input, logarithmic ? ", and a positive factor" : ""));
  }
  const auto step = [&](const VariedInput& run) {
    if (logarithmic && run.input <= 0) {
      throw InputError(
          fmt::format("the factor {} has no logarithm: expected a positive number.", run.input));
    }
    const double dx = logarithmic ? std::log(run.input / input) : run.input / input - 1;
    if (dx == 0) {
      throw InputError(
          fmt::format("a run has the base's own input, {}: it changes nothing.", input));
    }
    return dx;
  };
  std::vector<double> dx, df;
  for (const auto& run : varied) {
    dx.push_back(step(run));
    df.push_back(run.result / result - 1);
  }
  Sensitivity found;
  found.one_sided = varied.size() == 1;
  if (found.one_sided) {
    found.relative = df[0] / dx[0];
  } else {
    if (dx[0] * dx[1] > 0) {
      throw InputError(
          fmt::format("both runs lie on one side of the base's input {}: {} and {}; expected one "
                      "below and one above.",
                      input, varied[0].input, varied[1].input));
    }
    found.same_side = df[0] * df[1] > 0;
    const double first = df[0] / dx[0], second = df[1] / dx[1];
    found.relative = !found.same_side                     ? (df[1] - df[0]) / (dx[1] - dx[0])
                     : std::abs(first) > std::abs(second) ? first
                                                          : second;
  }
  found.uncertainty = std::abs(found.relative) * relative_uncertainty;
  return found;
}

double choice_uncertainty(double result, std::span<const double> alternatives) {
  if (alternatives.empty() || result == 0) {
    throw InputError("a choice needs another law's result, and a base other than zero.");
  }
  double largest = 0;
  for (const double other : alternatives) {
    largest = std::max(largest, std::abs(other / result - 1));
  }
  return largest / std::sqrt(3.0);
}

}  // namespace meltproof::validation
