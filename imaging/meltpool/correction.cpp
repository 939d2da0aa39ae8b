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

std::optional<CorrectedPool> corrected_pool(const Stack& stack, const Level& level, double dark,
                                            const Blur& blur, const PlateEdge& edge,
                                            const ReferenceSignal* found) {
  const bool front = found != nullptr && found->signature != Signature::none;
  Level contour = level;
  contour.step.reset();
  if (front) contour.value = found->blurred_signal;
  const double log_level = std::log(*contour.value - dark);
  const auto plain = measure_stack(stack, contour);
  if (!plain) return std::nullopt;
  const auto leading = fit_edge(stack, dark, blur, edge, log_level, true, seed);
  if (!leading || leading->misfit > worst_misfit) return std::nullopt;

  CorrectedPool pool;
  pool.blurred_length = plain->length;
  pool.blurred_depth = plain->depth;
  pool.onset = leading->position;
  pool.u_onset = leading->u;
  pool.front_found = front;
  const auto length_with = [&](const Blur& b, const PlateEdge& e, double l) {
    if (!front) {
      const auto ends = fit_ends(stack, dark, b, e, l);
      return ends ? ends->length() : std::nan("");
    }
    const auto edge_there = fit_edge(stack, dark, b, e, l, true, seed);
    return edge_there ? edge_there->position - found->front : std::nan("");
  };
  if (front) {
    pool.end = found->front;
    pool.u_end = found->u_front;
  } else {
    const auto tail = fit_edge(stack, dark, blur, edge, log_level, false, seed);
    if (!tail || tail->misfit > worst_misfit) return std::nullopt;
    pool.end = tail->position;
    pool.u_end = tail->u;
  }
  const auto derivative = [](double up, double down, double twice_step) {
    const double d = (up - down) / twice_step;
    return std::isfinite(d) ? d : 0;
  };
  constexpr double d_log = 0.02, d_blur = 0.05, d_row = 0.05;
  pool.by_log_level = derivative(length_with(blur, edge, log_level + d_log),
                                 length_with(blur, edge, log_level - d_log), 2 * d_log);
  const auto widened = [&](double d) { return Blur{blur.along + d, blur.across + d}; };
  pool.by_blur = derivative(length_with(widened(d_blur), edge, log_level),
                            length_with(widened(-d_blur), edge, log_level), 2 * d_blur);
  if (edge.present) {
    PlateEdge up = edge, down = edge;
    up.row += d_row;
    down.row -= d_row;
    pool.by_plate_edge =
        derivative(length_with(blur, up, log_level), length_with(blur, down, log_level), 2 * d_row);
  }

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
  if (!depth || !deeper || !shallower) return std::nullopt;
  pool.depth = depth->first;
  pool.doubt_depth = depth->second;
  pool.depth_by_log_level = (shallower->first - deeper->first) / (2 * d_log);
  return pool;
}

}  // namespace meltproof::imaging
