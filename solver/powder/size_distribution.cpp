// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/powder/size_distribution.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"

namespace meltproof::solver {
namespace {

/// The 90 % point of the standard normal distribution.
constexpr double normal_90 = 1.2815515655446004;

double normal_cumulative(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

std::string micrometres(double d) { return shortest(std::round(d * 1e12) / 1e6) + " um"; }

}  // namespace

SizeDistribution::SizeDistribution(const SizeSettings& s, const std::string& powder) {
  if (s.d10.has_value() != s.d90.has_value()) {
    throw InputError(fmt::format(
        "{}: only one of d10 and d90 is given: give both, or neither and geometric_deviation",
        powder));
  }
  deviation_ = std::log(s.geometric_deviation);
  if (s.d10) {
    if (!(*s.d10 < s.d50 && s.d50 < *s.d90)) {
      throw InputError(
          fmt::format("{}: d10 = {}, d50 = {}, d90 = {} do not rise: expected d10 < d50 < d90",
                      powder, micrometres(*s.d10), micrometres(s.d50), micrometres(*s.d90)));
    }
    deviation_ = std::log(*s.d90 / *s.d10) / (2 * normal_90);
  }
  median_ = s.by_volume ? s.d50 * std::exp(-3 * deviation_ * deviation_) : s.d50;
  smallest_ = s.d50 * std::exp(-s.truncation * deviation_);
  largest_ = s.d50 * std::exp(s.truncation * deviation_);
}

double SizeDistribution::draw(Random& random) const {
  if (deviation_ == 0) {
    return median_;
  }
  for (;;) {
    const double d = median_ * std::exp(deviation_ * random.normal());
    if (d >= smallest_ && d <= largest_) {
      return d;
    }
  }
}

double SizeDistribution::share(int k) const {
  const double median = median_ * std::exp(k * deviation_ * deviation_);
  return normal_cumulative(std::log(largest_ / median) / deviation_) -
         normal_cumulative(std::log(smallest_ / median) / deviation_);
}

double SizeDistribution::number_density(double d) const {
  if (d < smallest_ || d > largest_ || deviation_ == 0) {
    return 0;
  }
  const double x = std::log(d / median_) / deviation_;
  return std::exp(-x * x / 2) / (d * deviation_ * std::sqrt(2 * std::numbers::pi) * share(0));
}

double SizeDistribution::moment(int k) const {
  if (deviation_ == 0) {
    return std::pow(median_, k);
  }
  return std::pow(median_, k) * std::exp(0.5 * k * k * deviation_ * deviation_) * share(k) /
         share(0);
}

double SizeDistribution::volume_quantile(double q) const {
  if (deviation_ == 0) {
    return median_;
  }
  const double median = median_ * std::exp(3 * deviation_ * deviation_);
  const double below = normal_cumulative(std::log(smallest_ / median) / deviation_);
  double low = smallest_, high = largest_;
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    const double share_below =
        (normal_cumulative(std::log(middle / median) / deviation_) - below) / share(3);
    (share_below < q ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace meltproof::solver
