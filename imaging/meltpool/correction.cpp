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
constexpr std::uint64_t seed = 1;

struct Ends {
  SharpEdge leading, tail;
  double length() const { return leading.position - tail.position; }
};

std::optional<Ends> fit_ends(const Stack& stack, double dark, const Blur& blur,
                             const PlateEdge& edge, double log_level) {
  const auto leading = fit_edge(stack, dark, blur, edge, log_level, true, seed);
  const auto tail = fit_edge(stack, dark, blur, edge, log_level, false, seed);
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
    const auto leading = fit_edge(stack, dark, blur, moved, std::log(level - dark), true, seed);
    const auto tail = fit_edge(stack, dark, blur, moved, std::log(level - dark), false, seed);
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

double central(double up, double down, double twice_step) {
  const double d = (up - down) / twice_step;
  return std::isfinite(d) ? d : 0;
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
  const auto length_with = [&](const Blur& b, const PlateEdge& e, double l) {
    const auto there = fit_ends(stack, dark, b, e, l);
    return there ? there->length() : std::nan("");
  };
  constexpr double d_blur = 0.05, d_row = 0.05;
  pool.by_log_level = central(length_with(blur, edge, log_level + d_log),
                              length_with(blur, edge, log_level - d_log), 2 * d_log);
  const auto widened = [&](double d) { return Blur{blur.along + d, blur.across + d}; };
  pool.by_blur = central(length_with(widened(d_blur), edge, log_level),
                         length_with(widened(-d_blur), edge, log_level), 2 * d_blur);
  if (edge.present) {
    PlateEdge up = edge, down = edge;
    up.row += d_row;
    down.row -= d_row;
    pool.by_plate_edge =
        central(length_with(blur, up, log_level), length_with(blur, down, log_level), 2 * d_row);
  }
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
  const auto onset_with = [&](double log_signal, double variance,
                              const PlateEdge& e) -> std::optional<SharpEdge> {
    auto there =
        fit_edge(stack, dark, with_variance(blur, variance), e, log_signal, true, seed, &m.law);
    if (there && there->misfit > worst_misfit) there.reset();
    return there;
  };
  const auto onset = onset_with(m.log_signal, m.variance, edge);
  if (!onset) return false;
  pool.onset = onset->position;
  pool.u_onset = onset->u;
  const auto sides_with = [&](double log_signal, double variance) -> std::optional<SharpEdge> {
    const Blur b = with_variance(blur, variance);
    const auto high = fit_side(stack, dark, b, edge, log_signal, 1, seed, &m.law);
    const auto low = fit_side(stack, dark, b, edge, log_signal, -1, seed, &m.law);
    if (!high || !low || high->misfit > worst_misfit || low->misfit > worst_misfit)
      return std::nullopt;
    return SharpEdge{high->position - low->position, std::hypot(high->u, low->u), 0};
  };
  // In a side view one of the sides is the plate's border.
  const auto sides = edge.present ? std::nullopt : sides_with(m.log_signal, m.variance);
  if (sides) {
    pool.sides_fitted = true;
    pool.depth = sides->position;
    pool.u_sides = sides->u;
  }
  constexpr double d_variance = 0.05, d_row = 0.05;
  const auto slope = [&](const auto& at, double by_log, double by_variance) {
    const auto up = at(m.log_signal + by_log, m.variance + by_variance);
    const auto down = at(m.log_signal - by_log, m.variance - by_variance);
    return up && down ? central(up->position, down->position, 2 * (by_log + by_variance)) : 0;
  };
  const auto on_edge = [&](double l, double v) { return onset_with(l, v, edge); };
  pool.by_log_level = slope(on_edge, d_log, 0);
  const double by_variance = slope(on_edge, 0, d_variance);
  pool.by_blur = by_variance * 2 * blur.along;
  double depth_by_variance = 0;
  if (sides) {
    pool.depth_by_log_level = slope(sides_with, d_log, 0);
    depth_by_variance = slope(sides_with, 0, d_variance);
  }
  if (edge.present) {
    PlateEdge up = edge, down = edge;
    up.row += d_row;
    down.row -= d_row;
    const auto above = onset_with(m.log_signal, m.variance, up);
    const auto below = onset_with(m.log_signal, m.variance, down);
    if (above && below) pool.by_plate_edge = central(above->position, below->position, 2 * d_row);
  }
  for (const TailDraw& d : m.draws) {
    const double log_signal = d.log_signal - m.log_signal, variance = d.variance - m.variance;
    pool.draws.push_back(
        {pool.by_log_level * log_signal + by_variance * variance - (d.front - m.front),
         pool.depth_by_log_level * log_signal + depth_by_variance * variance});
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
