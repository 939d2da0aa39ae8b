// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace meltproof::imaging {
namespace {

/// Sorts `v` and counts its pairs (i, j > i) with v[i] > v[j] on the way (Knight 1966): merging
/// two sorted halves, each number taken from the later one passes all that are left in the earlier.
std::int64_t sort_and_count(std::span<double> v, std::span<double> spare) {
  if (v.size() < 2) return 0;
  const std::size_t half = v.size() / 2;
  std::int64_t falling = sort_and_count(v.first(half), spare.first(half)) +
                         sort_and_count(v.subspan(half), spare.subspan(half));
  for (std::size_t i = 0, j = half, k = 0; k < v.size(); ++k) {
    const bool later = j < v.size() && (i == half || v[j] < v[i]);
    if (later) falling += static_cast<std::int64_t>(half - i);
    spare[k] = later ? v[j++] : v[i++];
  }
  std::copy_n(spare.begin(), v.size(), v.begin());
  return falling;
}

/// S / sqrt(var S), both of Mann (1945) and Kendall (1975). Of series longer than 2000 evenly
/// spaced values are taken.
double mann_kendall(std::span<const double> all) {
  constexpr std::size_t most = 2000;
  const std::size_t step = (all.size() + most - 1) / most;
  std::vector<double> v;
  for (std::size_t i = 0; i < all.size(); i += step) v.push_back(all[i]);
  const auto n = static_cast<double>(v.size());
  if (v.size() < 4) return 0;
  std::vector<double> spare(v.size());
  const std::int64_t falling = sort_and_count(v, spare);
  double variance = n * (n - 1) * (2 * n + 5);
  const auto size = static_cast<std::int64_t>(v.size());
  std::int64_t pairs = size * (size - 1) / 2;  // that are not tied
  for (std::size_t i = 0; i < v.size();) {
    std::size_t end = i + 1;
    while (end < v.size() && v[end] == v[i]) ++end;
    const auto t = static_cast<double>(end - i);
    variance -= t * (t - 1) * (2 * t + 5);
    pairs -= static_cast<std::int64_t>((end - i) * (end - i - 1) / 2);
    i = end;
  }
  const auto s = static_cast<double>(pairs - 2 * falling);
  if (!(variance > 0) || s == 0) return 0;
  return (s > 0 ? s - 1 : s + 1) / std::sqrt(variance / 18);
}

}  // namespace

double Series::uncertainty_of_mean() const {
  return effective > 0 ? deviation / std::sqrt(effective) : 0;
}

Series summarise(std::span<const double> v) {
  Series s;
  s.n = v.size();
  if (v.empty()) return s;
  const auto n = static_cast<double>(v.size());
  for (const double x : v) s.mean += x / n;
  s.effective = n;
  if (v.size() < 2) return s;
  double sum = 0;
  for (const double x : v) sum += (x - s.mean) * (x - s.mean);
  s.deviation = std::sqrt(sum / (n - 1));
  s.trend = mann_kendall(v);
  double rho_sum = 0;
  for (std::size_t lag = 1; sum > 0 && lag < v.size() / 2; ++lag) {
    double c = 0;
    for (std::size_t i = 0; i + lag < v.size(); ++i) c += (v[i] - s.mean) * (v[i + lag] - s.mean);
    if (c <= 0) break;
    rho_sum += c / sum;
  }
  s.effective = std::max(1.0, n / (1 + 2 * rho_sum));
  return s;
}

double median(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

RobustLine robust_line(std::span<const double> x, std::span<const double> y) {
  std::vector<double> slopes, rest;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = i + 1; j < x.size(); ++j) slopes.push_back((y[j] - y[i]) / (x[j] - x[i]));
  RobustLine line;
  line.slope = median(std::move(slopes));
  for (std::size_t i = 0; i < x.size(); ++i) rest.push_back(y[i] - line.slope * x[i]);
  line.intercept = median(rest);
  for (auto& r : rest) r = std::abs(r - line.intercept);
  line.deviation = 1.4826 * median(std::move(rest));
  return line;
}

double slope(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mx) * (y[i] - my);
    xx += (x[i] - mx) * (x[i] - mx);
  }
  return xx > 0 ? xy / xx : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace meltproof::imaging
