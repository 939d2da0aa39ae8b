// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/metrics/area.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace meltproof::validation {

double area_metric(std::vector<double> simulated, std::vector<double> measured) {
  if (simulated.empty() || measured.empty()) {
    throw InputError("the area metric compares two samples: expected at least one value in each.");
  }
  std::sort(simulated.begin(), simulated.end());
  std::sort(measured.begin(), measured.end());
  const double s_step = 1.0 / static_cast<double>(simulated.size());
  const double d_step = 1.0 / static_cast<double>(measured.size());
  // Both distributions are constant between neighbouring values of the merged samples.
  std::size_t s = 0, d = 0;
  double area = 0, at = std::min(simulated.front(), measured.front());
  while (s < simulated.size() || d < measured.size()) {
    const bool from_s =
        d == measured.size() || (s < simulated.size() && simulated[s] <= measured[d]);
    const double next = from_s ? simulated[s] : measured[d];
    area +=
        std::abs(static_cast<double>(s) * s_step - static_cast<double>(d) * d_step) * (next - at);
    at = next;
    ++(from_s ? s : d);
  }
  return area;
}

}  // namespace meltproof::validation
