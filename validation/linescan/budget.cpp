// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/budget.hpp"

#include <algorithm>
#include <cmath>

namespace meltproof::validation {
namespace {

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) {
    sum += value * value / static_cast<double>(values.size());
  }
  return sum;
}

bool usable(const std::vector<double>& u) {
  return !u.empty() && std::all_of(u.begin(), u.end(), [](double value) { return value > 0; });
}

}  // namespace

std::vector<double> LineBudget::measured() const {
  if (!usable(reported)) {
    return usable(counting) ? counting : std::vector<double>{};
  }
  std::vector<double> larger = reported;
  if (usable(counting)) {
    for (std::size_t i = 0; i < larger.size(); ++i) {
      larger[i] = std::max(larger[i], counting[i]);
    }
  }
  return larger;
}

std::vector<double> LineBudget::total() const {
  std::vector<double> sum = measured();
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = std::sqrt(sum[i] * sum[i] + (strip.empty() ? 0 : strip[i] * strip[i]) +
                       (numerical.empty() ? 0 : numerical[i] * numerical[i]));
  }
  return sum;
}

double strip_uncertainty(double scatter, double width, double depth, double spacing) {
  return scatter / std::sqrt(std::max(1.0, width * depth / (spacing * spacing)));
}

std::vector<double> edge_uncertainty(std::span<const double> position,
                                     std::span<const double> profile, double spacing) {
  std::vector<double> u;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::size_t left = i > 0 ? i - 1 : i, right = i + 1 < profile.size() ? i + 1 : i;
    const double slope =
        right > left ? (profile[right] - profile[left]) / (position[right] - position[left]) : 0;
    u.push_back(std::isnan(slope) ? 0 : std::abs(slope) * spacing / std::sqrt(12.0));
  }
  return u;
}

ValidationError line_validation_error(double bias, double level, const LineBudget& budget,
                                      std::optional<double> systematic, double coverage,
                                      ComparisonUncertainty& parts) {
  parts = {};
  if (!budget.strip.empty() || !budget.numerical.empty()) {
    parts.numerical = std::sqrt(mean_square(budget.strip) + mean_square(budget.numerical));
  }
  const auto measured = budget.measured();
  const double common = systematic.value_or(0) * level;
  if (!measured.empty()) {
    parts.data =
        std::sqrt(mean_square(measured) / static_cast<double>(measured.size()) + common * common);
  } else if (systematic) {
    parts.data = std::abs(common);
  }
  return validation_error(bias, 0, parts, coverage);
}

}  // namespace meltproof::validation
