// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/uniformity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::imaging {

Uniformity two_point(const std::vector<double>& cold, const std::vector<double>& hot) {
  if (cold.size() != hot.size() || cold.empty())
    throw InputError(
        fmt::format("The cold reference has {} pixels and the hot one {}; expected as "
                    "many, from the same window of the camera.",
                    cold.size(), hot.size()));
  std::vector<double> response(cold.size());
  for (std::size_t i = 0; i < cold.size(); ++i) response[i] = hot[i] - cold[i];
  std::vector<double> sorted;
  for (const double r : response)
    if (std::isfinite(r)) sorted.push_back(r);
  if (sorted.empty()) throw InputError("The references for the pixels' gains hold no numbers.");
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle;
  if (!(median > 0))
    throw InputError(
        fmt::format("The hot reference is not brighter than the cold one (median "
                    "difference {:.4g} counts); exchange them or record them anew.",
                    median));
  Uniformity u;
  u.offset = cold;
  u.gain.assign(cold.size(), 0);
  double level = 0, mean = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < cold.size(); ++i) {
    if (!(response[i] >= 0.5 * median && response[i] <= 2 * median)) {
      ++u.dead;
      continue;
    }
    n += 1;
    level += cold[i];
    mean += response[i];
    squares += (response[i] / median) * (response[i] / median);
  }
  u.level = level / n;
  mean /= n;
  u.spread = std::sqrt(std::max(0.0, squares / n - (mean / median) * (mean / median)));
  for (std::size_t i = 0; i < cold.size(); ++i)
    if (response[i] >= 0.5 * median && response[i] <= 2 * median) u.gain[i] = mean / response[i];
  return u;
}

void correct(const Uniformity& u, std::vector<float>& values, double saturation,
             double under_range) {
  if (values.size() != u.gain.size())
    throw InputError(
        fmt::format("The references for the pixels' gains have {} pixels, the "
                    "recording {}; record them in the same window of the camera.",
                    u.gain.size(), values.size()));
  const auto high = static_cast<float>(saturation), low = static_cast<float>(under_range);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float raw = values[i];
    if (u.gain[i] == 0) {
      values[i] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    auto value = static_cast<float>(u.level + u.gain[i] * (static_cast<double>(raw) - u.offset[i]));
    if (raw >= high)
      value = std::max(value, high);
    else if (raw <= low)
      value = std::min(value, low);
    else
      value = std::clamp(value, std::nextafter(low, high), std::nextafter(high, low));
    values[i] = value;
  }
}

}  // namespace meltproof::imaging
