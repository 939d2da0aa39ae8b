// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace meltproof::imaging {
namespace {

/// A fit whose chi-squared is larger than this many degrees of freedom is none.
constexpr double worst_misfit = 12;

struct Ends {
  SharpEdge leading, tail;
  double length() const { return leading.position - tail.position; }
};

std::optional<Ends> fit_ends(const Stack& stack, double dark, const Blur& blur,
                             const PlateEdge& edge, double log_level) {
  const auto leading = fit_edge(stack, dark, blur, edge, log_level, true);
  const auto tail = fit_edge(stack, dark, blur, edge, log_level, false);
  if (!leading || !tail || leading->misfit > worst_misfit || tail->misfit > worst_misfit)
    return std::nullopt;
  return Ends{*leading, *tail};
}

/// Blur whose variance has changed, px^2; never sharper than a tenth of a pixel.
Blur with_variance(const Blur& blur, double change) {
  const auto root = [&](double sigma) { return std::sqrt(std::max(sigma * sigma + change, 0.01)); };
  return {root(blur.along), root(blur.across)};
}

/// Value at no blur by a parabola, and how far a straight line through the first two would differ.
std::pair<double, double> extrapolated(const std::array<double, 4>& added,
                                       const std::array<double, 4>& values) {
  Eigen::Matrix<double, 4, 3> m;
  Eigen::Vector4d v;
  for (int i = 0; i < 4; ++i) {
    const double s = added[static_cast<std::size_t>(i)];
    m.row(i) << 1, s, s * s;
    v(i) = values[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector3d p = m.colPivHouseholderQr().solve(v);
  const double parabola = p(0) - p(1) + p(2);
  const double slope = (values[1] - values[0]) / (added[1] - added[0]);
  return {parabola, std::abs(parabola - values[0] + slope * (added[0] + 1))};
}

}  // namespace

PlateEdge refined_plate_edge(const Stack& stack, double dark, double level, const Blur& blur,
                             const PlateEdge& edge) {
  if (!edge.present) return edge;
  constexpr double apart = 0.07;
  Eigen::Matrix<double, 5, 3> m;
  Eigen::Matrix<double, 5, 1> v;
  for (int i = 0; i < 5; ++i) {
    const double shift = (i - 2) * apart;
    PlateEdge moved = edge;
    moved.row += shift;
    const auto leading = fit_edge(stack, dark, blur, moved, std::log(level - dark), true);
    const auto tail = fit_edge(stack, dark, blur, moved, std::log(level - dark), false);
    if (!leading || !tail) return edge;
    m.row(i) << 1, shift, shift * shift;
    v(i) = leading->misfit + tail->misfit;
  }
  const Eigen::Vector3d p = m.colPivHouseholderQr().solve(v);
  PlateEdge refined = edge;
  if (!(p(2) > 0)) return edge;
  refined.row += std::clamp(-0.5 * p(1) / p(2), -2.5 * apart, 2.5 * apart);
  refined.u_row = std::min(edge.u_row, 0.05);
  return refined;
}

namespace {

constexpr double d_log = 0.02;

/// Change of a number with the plate's border, for one px.
template <class At>
double by_row(const PlateEdge& edge, const At& at) {
  constexpr double step = 0.05;  // px
  PlateEdge up = edge, down = edge;
  up.row += step;
  down.row -= step;
  const std::optional<double> above = at(up), below = at(down);
  return above && below ? (*above - *below) / (2 * step) : 0;
}

/// Both ends at the level.
bool fit_at_level(CorrectedPool& pool, const Stack& stack, double dark, const Blur& blur,
                  const PlateEdge& edge, double log_level) {
  const auto ends = fit_ends(stack, dark, blur, edge, log_level);
  if (!ends) return false;
  pool.onset = ends->leading.position;
  pool.u_onset = ends->leading.u;
  pool.end = ends->tail.position;
  pool.u_end = ends->tail.u;
  pool.misfit = std::max(1.0, ends->tail.misfit);
  pool.by_log_level = ends->leading.by_log_level - ends->tail.by_log_level;
  // By fits with more and less blur: to first order the ends move too little, since the terms that
  // the samples hardly tell follow the blur.
  constexpr double d_blur = 0.05;  // px
  const auto length_with = [&](double d) -> std::optional<double> {
    const auto there = fit_ends(stack, dark, {blur.along + d, blur.across + d}, edge, log_level);
    if (!there) return std::nullopt;
    return there->length();
  };
  const auto longer = length_with(-d_blur), shorter = length_with(d_blur);
  if (longer && shorter) pool.by_blur = (*shorter - *longer) / (2 * d_blur);
  if (edge.present)
    pool.by_plate_edge = by_row(edge, [&](const PlateEdge& e) -> std::optional<double> {
      const auto there = fit_ends(stack, dark, blur, e, log_level);
      if (!there) return std::nullopt;
      return there->length();
    });
  return true;
}

/// The end is the front; leading edge and sides follow the law and the point spread that the tail
/// told.
bool fit_with_front(CorrectedPool& pool, const Stack& stack, double dark, const Blur& blur,
                    const PlateEdge& edge, const ReferenceSignal& found) {
  const TailModel& m = found.model;
  pool.front_found = true;
  pool.end = found.front;
  pool.u_end = found.u_front;
  pool.misfit = m.misfit;
  const Blur told = with_variance(blur, m.variance);
  const auto onset_at = [&](const PlateEdge& e) -> std::optional<SharpEdge> {
    auto there = fit_edge(stack, dark, told, e, m.log_signal, true, &m.law);
    if (there && there->misfit > worst_misfit) there.reset();
    return there;
  };
  const auto onset = onset_at(edge);
  if (!onset) return false;
  pool.onset = onset->position;
  pool.u_onset = onset->u;
  pool.by_log_level = onset->by_log_level;
  pool.by_blur = onset->by_variance * 2 * blur.along;
  // In a side view one of the sides is the plate's border.
  std::optional<SharpEdge> high, low;
  if (!edge.present) {
    high = fit_side(stack, dark, told, edge, m.log_signal, 1, &m.law);
    low = fit_side(stack, dark, told, edge, m.log_signal, -1, &m.law);
  }
  SharpEdge sides;
  if (high && low && high->misfit <= worst_misfit && low->misfit <= worst_misfit) {
    pool.sides_fitted = true;
    pool.depth = high->position - low->position;
    pool.u_sides = std::hypot(high->u, low->u);
    sides.by_log_level = pool.depth_by_log_level = high->by_log_level - low->by_log_level;
    sides.by_ratio = high->by_ratio - low->by_ratio;
    sides.by_interval = high->by_interval - low->by_interval;
    sides.by_variance = high->by_variance - low->by_variance;
  }
  if (edge.present)
    pool.by_plate_edge = by_row(edge, [&](const PlateEdge& e) -> std::optional<double> {
      const auto there = onset_at(e);
      if (!there) return std::nullopt;
      return there->position;
    });
  for (const TailDraw& d : m.draws) {
    const auto moved = [&](const SharpEdge& e) {
      return e.by_log_level * (d.log_signal - m.log_signal) +
             e.by_variance * (d.variance - m.variance) + e.by_ratio * (d.ratio - m.law.ratio) +
             e.by_interval * (d.interval - m.law.interval);
    };
    pool.draws.push_back({moved(*onset) - (d.front - m.front), moved(sides)});
  }
  return true;
}

/// By extrapolation over added blur.
bool extrapolate_depth(CorrectedPool& pool, const Stack& stack, double dark, const Blur& blur,
                       const PlateEdge& edge, const Level& contour) {
  const double log_level = std::log(*contour.value - dark);
  const Stack whole = edge.present ? mirrored(stack, dark, edge, blur) : stack;
  const double half = edge.present ? 0.5 : 1;
  constexpr std::array<double, 4> added = {0.25, 0.75, 1.25, 2.0};
  const auto depth_at = [&](double shift) -> std::optional<std::pair<double, double>> {
    Level shifted = contour;
    shifted.value = dark + std::exp(log_level + shift);
    std::array<double, 4> depth{};
    for (std::size_t i = 0; i < added.size(); ++i) {
      const double root = std::sqrt(added[i]);
      const auto m = measure_stack(whole, shifted, root * blur.along, root * blur.across);
      if (!m) return std::nullopt;
      depth[i] = half * m->depth;
    }
    return extrapolated(added, depth);
  };
  const auto depth = depth_at(0), deeper = depth_at(-d_log), shallower = depth_at(d_log);
  if (!depth || !deeper || !shallower) return false;
  pool.depth = depth->first;
  pool.doubt_depth = depth->second;
  pool.depth_by_log_level = (shallower->first - deeper->first) / (2 * d_log);
  return true;
}

}  // namespace

std::optional<CorrectedPool> corrected_pool(const Stack& stack, const Level& level, double dark,
                                            const Blur& blur, const PlateEdge& edge,
                                            const ReferenceSignal* found) {
  const bool front = found != nullptr && found->signature != Signature::none;
  Level contour = level;
  contour.step.reset();
  if (front) contour.value = found->blurred_signal;
  const auto plain = measure_stack(stack, contour);
  if (!plain) return std::nullopt;
  CorrectedPool pool;
  pool.blurred_length = plain->length;
  pool.blurred_depth = plain->depth;
  const bool fitted =
      front ? fit_with_front(pool, stack, dark, blur, edge, *found)
            : fit_at_level(pool, stack, dark, blur, edge, std::log(*contour.value - dark));
  if (!fitted) return std::nullopt;
  if (!pool.sides_fitted && !extrapolate_depth(pool, stack, dark, blur, edge, contour))
    return std::nullopt;
  return pool;
}

}  // namespace meltproof::imaging
