// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/level_doubt.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "imaging/meltpool/budget.hpp"

namespace meltproof::imaging {
namespace {

/// Change of ln(length) for one unit of ln(S - dark) where it cannot be measured: behind
/// Rosenthal's source R (T - T0) is constant, and d ln S / d ln T is 2.56 at 1683 K.
constexpr double usual_slope = -0.47;

/// Standard uncertainty of ln(emissivity) and the words for it.
std::pair<double, std::string> emissivity_doubt(double emissivity, const BudgetSettings& s) {
  if (s.u_emissivity)
    return {*s.u_emissivity, fmt::format("emissivity {:.3g} %", 100 * *s.u_emissivity)};
  const double u = u_assumed_emissivity(emissivity);
  return {u, fmt::format("emissivity {:.2g} % (assumed: two of them reach the farther end of {} to "
                         "{}, published for liquid metals between 3 and 5 um; [budget] "
                         "u_emissivity, if more is known)",
                         100 * u, least_published_emissivity, most_published_emissivity)};
}

}  // namespace

double u_assumed_emissivity(double emissivity) {
  return 0.5 * std::max(std::log(most_published_emissivity / emissivity),
                        std::log(emissivity / least_published_emissivity));
}

LevelDoubt level_doubt(const RecordingHeader& h, const Level& level, const BudgetSettings& s,
                       double u_reference_signal) {
  switch (level.kind) {
    case LevelKind::given:
      return {s.u_level, "of the level that was given (u_level)"};
    case LevelKind::recording:
      return {u_reference_signal,
              "of S*, found in the recording; independent of emissivity and transmission"};
    case LevelKind::radiometry: {
      const auto& r = *h.radiometry;
      const double t = level.reference_temperature, dark = level.interpolation.dark;
      const double slope = std::log((signal(r, t + 1) - dark) / (signal(r, t - 1) - dark)) / 2;
      const auto [u, how] = emissivity_doubt(level.emissivity, s);
      return {std::hypot(slope * s.u_reference_temperature, std::hypot(u, s.u_transmission)),
              fmt::format("reference temperature {:.3g} K, {}, transmission {:.3g} %: the level is "
                          "not independent of them",
                          s.u_reference_temperature, how, 100 * s.u_transmission)};
    }
    case LevelKind::temperature: {
      // What the camera's software took, or else the middle of what is published.
      const double middle = std::sqrt(least_published_emissivity * most_published_emissivity);
      const auto told = h.calibration.find("emissivity");
      const auto [u, how] = emissivity_doubt(
          told != h.calibration.end() && told->second > 0 ? told->second : middle, s);
      return {std::hypot(s.u_reference_temperature / level.reference_temperature,
                         u / steepness_of_steel),
              fmt::format("reference temperature {:.3g} K; {} in the temperatures that the "
                          "camera's software has computed, over d ln S / d ln T = {}",
                          s.u_reference_temperature, how, steepness_of_steel)};
    }
    default:
      return {0, "of a threshold of brightness none is known"};
  }
}

LevelEffect::LevelEffect(double u_log, const Effect& seen, const SizeAt& size_at)
    : at_level_(seen) {
  if (!(u_log > 0)) return;
  constexpr int nodes = 6;  // on either side, half a standard uncertainty apart
  for (int k = -nodes; k <= nodes; ++k) {
    const double shift = 0.5 * k * u_log;
    const auto size = size_at(shift);
    if (k == 0 && size) at_level_ = *size;
    if (k == 0 || size) nodes_.push_back({shift, size.value_or(at_level_)});
  }
}

double LevelEffect::along(double shift, double Effect::*dimension) const {
  const auto value = [&](const Node& n) { return n.size.*dimension; };
  // Beyond the outermost two, by their slope of ln.
  const auto beyond = [&](const Node& last, const Node& before) {
    double slope = usual_slope;
    if (value(last) > 0 && value(before) > 0 && last.shift != before.shift)
      slope = std::log(value(last) / value(before)) / (last.shift - before.shift);
    return value(last) * std::exp(std::min(slope, 0.0) * (shift - last.shift));
  };
  const auto above = std::find_if(nodes_.begin(), nodes_.end(),
                                  [shift](const Node& n) { return n.shift >= shift; });
  if (above == nodes_.begin()) return beyond(nodes_.front(), nodes_[nodes_.size() > 1 ? 1 : 0]);
  if (above == nodes_.end())
    return beyond(nodes_.back(), nodes_[nodes_.size() > 1 ? nodes_.size() - 2 : 0]);
  const Node &low = *(above - 1), &high = *above;
  const double part = (shift - low.shift) / (high.shift - low.shift);
  return value(low) + part * (value(high) - value(low));
}

Effect LevelEffect::operator()(double shift) const {
  if (nodes_.empty()) return {};
  return {along(shift, &Effect::length) - at_level_.length,
          along(shift, &Effect::depth) - at_level_.depth};
}

}  // namespace meltproof::imaging
