// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/line_scan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meltproof::validation {

void check_totals(LineScan& scan) {
  if (scan.alloy) {
    scan.total.assign(scan.position.size(), 1);
    scan.flagged.clear();
    for (std::size_t i = 0; i < scan.alloy->fraction.size(); ++i) {
      if (!std::isfinite(scan.alloy->fraction[i])) {
        scan.flagged.push_back(i);  // not known
      }
    }
    return;
  }
  if (scan.total.empty()) {
    scan.total.assign(scan.position.size(), 0);
    for (const auto& [symbol, profile] : scan.elements) {
      for (std::size_t i = 0; i < scan.total.size(); ++i) {
        scan.total[i] += profile.fraction[i];
      }
    }
  }
  scan.flagged.clear();
  for (std::size_t i = 0; i < scan.total.size(); ++i) {
    if (!(scan.total[i] >= 0.95 && scan.total[i] <= 1.05)) {
      scan.flagged.push_back(i);
    }
  }
  if (!scan.flagged.empty()) {
    const bool fractions = scan.flagged.size() == scan.total.size() &&
                           std::all_of(scan.total.begin(), scan.total.end(),
                                       [](double total) { return total > 0.005 && total < 0.015; });
    scan.remarks.push_back(fmt::format(
        "{} of {} points have a total outside 95 to 105 %: they are shown but not compared.{}",
        scan.flagged.size(), scan.total.size(),
        fractions ? " The totals are near 1 %: the columns seem to hold fractions, not percent."
                  : ""));
  }
  const bool hundred =
      scan.total.size() > 1 && std::all_of(scan.total.begin(), scan.total.end(),
                                           [](double total) { return std::abs(total - 1) < 1e-4; });
  if (hundred && !scan.of_atoms) {
    scan.remarks.push_back(
        "every total is 100 %: the values were normalised before the export, so the totals say "
        "nothing of their quality.");
  }
}

double counting_noise(double net, double background) {
  return std::sqrt(std::max(0.0, net) + 2 * std::max(0.0, background));
}

}  // namespace meltproof::validation
