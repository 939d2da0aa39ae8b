// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a stack is fitted, and where the fitted field falls to a level.
#include <algorithm>
#include <cmath>

#include "imaging/meltpool/blurred_fit.hpp"

namespace meltproof::imaging::blurred_fit {
namespace {

/// Margins from which the blur carries light into what is compared.
int margin(double sigma, int samples) {
  return static_cast<int>(std::ceil(4 * sigma * samples)) + samples;
}

/// The samples of the patch, those above `least` with a weight, and the model's grid around them.
/// @return how many there are.
std::size_t fill(Patch& patch, const Stack& stack, const std::vector<float>& smooth, double dark,
                 const Blur& blur, const PlateEdge& edge, double start, double least) {
  patch.blur = blur;
  patch.brightest = start;
  patch.margin_columns = margin(blur.along, Stack::samples);
  patch.margin_rows = margin(blur.across, fine);
  for (int row = 0; row < patch.height(); ++row)
    patch.mask.push_back(
        edge.present ? std::clamp((patch.row(row) - edge.row) * fine + 0.5, 0.0, 1.0) : 1.0);
  const double per_column = static_cast<double>(stack.frames) / Stack::samples;
  std::size_t used = 0;
  for (int l = 0; l < patch.lines; ++l)
    for (int c = 0; c < patch.columns; ++c) {
      const std::size_t i = (patch.line + static_cast<std::size_t>(l)) * stack.columns +
                            patch.column + static_cast<std::size_t>(c);
      const double s = static_cast<double>(stack.signal[i]) - dark;
      const double u2 = 0.5 * std::pow(static_cast<double>(stack.deviation[i]), 2) +
                        0.5 * stack.noise * stack.noise / per_column + std::pow(0.003 * s, 2);
      const bool known = std::isfinite(s) && s > least * std::exp(start);
      patch.value.push_back(known ? s : 0);
      patch.weight.push_back(known ? 1 / u2 : 0);
      patch.smooth.push_back(
          std::max(static_cast<double>(smooth[i]) - dark, 1e-3 * std::exp(start)));
      patch.brightest = std::max(patch.brightest, std::log(patch.smooth.back()));
      used += known ? 1 : 0;
    }
  return used;
}

}  // namespace

Blur with_columns(const Blur& blur) {
  const double column = 1.0 / (12 * Stack::samples * Stack::samples);
  return {std::sqrt(blur.along * blur.along + column), blur.across};
}

std::optional<Patch> make_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start, End end) {
  const std::vector<float> smooth = smoothed(stack, 0.5, 0);
  const double level = dark + std::exp(start);
  const auto columns = static_cast<std::ptrdiff_t>(stack.columns);
  std::vector<std::ptrdiff_t> crossing(stack.lines, -1);
  std::ptrdiff_t lowest = columns, tip = -1, tail = 0, beam = 0, crossed = 0;
  for (std::size_t l = 0; l < stack.lines; ++l) {
    if (edge.present && static_cast<double>(l) < edge.row) continue;
    const float* const v = smooth.data() + l * stack.columns;
    const auto peak = std::max_element(v, v + columns) - v;
    if (static_cast<double>(v[peak]) < level) continue;
    std::ptrdiff_t i = peak;
    while (i > 0 && static_cast<double>(v[i - 1]) >= level) --i;
    crossing[l] = i;
    ++crossed;
    if (i >= lowest) continue;
    lowest = i;
    tip = static_cast<std::ptrdiff_t>(l);
    // The hottest part, under the beam, is no tail: it may be flat, saturated or boiling.
    tail = beam = peak;
    while (tail > 0 &&
           static_cast<double>(v[tail]) - dark > 0.8 * (static_cast<double>(v[peak]) - dark))
      --tail;
  }
  if (tip < 0) return std::nullopt;
  const double pixels = end == End::tail ? reach : edge_reach;
  const auto r = static_cast<std::ptrdiff_t>(pixels * Stack::samples);
  std::ptrdiff_t first_line = tip, last_line = tip;
  // Neighbouring lines as long as their front lies within reach of the tip's.
  const auto belongs = [&](std::ptrdiff_t l) {
    return l >= 0 && l < static_cast<std::ptrdiff_t>(stack.lines) &&
           crossing[static_cast<std::size_t>(l)] >= 0 &&
           crossing[static_cast<std::size_t>(l)] - lowest <= r;
  };
  while (belongs(first_line - 1) && tip - first_line < 5) --first_line;
  while (belongs(last_line + 1) && last_line - tip < 5) ++last_line;
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(lowest - r, 0),
                       to = std::min(lowest + r, end == End::tail ? tail : columns);
  const auto samples = static_cast<std::ptrdiff_t>(Stack::samples);
  if (end == End::tail && (to - from < 8 * samples || to - lowest < 2 * samples))
    return std::nullopt;
  Patch patch;
  patch.scale = end == End::tail ? 6 : 2.5;
  patch.column = static_cast<std::size_t>(from);
  patch.columns = static_cast<int>(to - from);
  patch.line = static_cast<std::size_t>(first_line);
  patch.lines = static_cast<int>(last_line - first_line + 1);
  patch.centre_column = static_cast<double>(lowest);
  patch.to_beam = static_cast<double>(beam - lowest) / Stack::samples;
  patch.half_width = (edge.present ? 1.0 : 0.5) * static_cast<double>(crossed);
  patch.even = edge.present;
  patch.centre_line = edge.present ? edge.row : static_cast<double>(tip);
  for (std::ptrdiff_t l = first_line; l <= last_line; ++l)
    patch.crossing.push_back(static_cast<int>(crossing[static_cast<std::size_t>(l)] - from));
  const std::size_t used =
      fill(patch, stack, smooth, dark, blur, edge, start, end == End::tail ? 0.15 : 0.03);
  if (used < static_cast<std::size_t>((end == End::tail ? 4 : 2) * terms)) return std::nullopt;
  return patch;
}

void know_smoothness(Patch& tail) {
  for (int k = 0; k < terms; ++k) {
    const int i = k / (across_order + 1), j = k % (across_order + 1);
    if (i + j < 2) continue;
    tail.prior.know(k, 0,
                    std::pow(tail.scale / std::max(tail.to_beam, 1.0), i) *
                        std::pow(tail.scale / std::max(tail.half_width, 1.0), j));
  }
}

std::optional<Patch> make_side_patch(const Stack& stack, double dark, const Blur& blur,
                                     const PlateEdge& edge, double start, int side) {
  const std::vector<float> smooth = smoothed(stack, 0.5, 0);
  const auto columns = static_cast<std::ptrdiff_t>(stack.columns);
  const auto lines = static_cast<std::ptrdiff_t>(stack.lines);
  const auto log_at = [&](std::ptrdiff_t l, std::ptrdiff_t c) {
    return std::log(std::max(
        static_cast<double>(smooth[static_cast<std::size_t>(l * columns + c)]) - dark, 1e-12));
  };
  double farthest = -1e9;  // counted outwards
  std::ptrdiff_t at = -1, top = 0;
  for (std::ptrdiff_t c = 0; c < columns; ++c) {
    std::ptrdiff_t peak = 0;
    for (std::ptrdiff_t l = 1; l < lines; ++l)
      if (log_at(l, c) > log_at(peak, c)) peak = l;
    if (log_at(peak, c) < start) continue;
    std::ptrdiff_t l = peak;
    while (l + side >= 0 && l + side < lines && log_at(l + side, c) >= start) l += side;
    if (l + side < 0 || l + side >= lines) continue;
    const double t = (log_at(l, c) - start) / (log_at(l, c) - log_at(l + side, c));
    const double place = static_cast<double>(side * l) + t;
    if (place > farthest) farthest = place, at = c, top = peak;
  }
  if (at < 0) return std::nullopt;
  const auto edge_line = static_cast<std::ptrdiff_t>(std::lround(farthest)) * side;
  const auto r = static_cast<std::ptrdiff_t>(edge_reach * Stack::samples);
  const auto n = static_cast<std::ptrdiff_t>(edge_reach);
  std::ptrdiff_t inner = edge_line - side * n, outer = edge_line + side * n;
  // Not over the ridge, nor out of the picture.
  if (side * (inner - top) < 1) inner = top + side;
  outer = std::clamp<std::ptrdiff_t>(outer, 0, lines - 1);
  if (side * (edge_line - inner) < 1 || side * (outer - edge_line) < 2) return std::nullopt;
  Patch patch;
  patch.scale = 3;
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(at - r, 0),
                       to = std::min(at + r + 1, columns);
  patch.column = static_cast<std::size_t>(from);
  patch.columns = static_cast<int>(to - from);
  patch.line = static_cast<std::size_t>(std::min(inner, outer));
  patch.lines = static_cast<int>(std::abs(outer - inner) + 1);
  patch.centre_column = static_cast<double>(at);
  patch.centre_line = static_cast<double>(edge_line);
  if (fill(patch, stack, smooth, dark, blur, edge, start, 0.03) < 2 * terms) return std::nullopt;
  return patch;
}

namespace {

/// From `inner`, at or above the level, in steps to where `theta` is below it, then by halving.
template <class Theta>
std::optional<double> crossing_of(const Theta& theta, double level, double inner, double last,
                                  double step) {
  if (theta(inner) < level) return std::nullopt;
  double outer = inner;
  while ((last - outer) * step > 0 && theta(outer) >= level) outer += step;
  if ((last - outer) * step <= 0) return std::nullopt;
  inner = outer - step;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (inner + outer);
    (theta(middle) >= level ? inner : outer) = middle;
  }
  return inner;
}

}  // namespace

std::optional<Place> outermost(const Patch& patch, const Vector& p, const PlateEdge& edge,
                               double level) {
  std::optional<Place> place;
  for (int r = patch.margin_rows; r < patch.height() - patch.margin_rows; ++r) {
    if (edge.present && patch.row(r) < edge.row - 0.17) continue;
    const double y = patch.y(patch.row(r));
    const auto x = crossing_of([&](double at) { return field_at(patch, p, at, y).theta; }, level,
                               patch.x(patch.width() - patch.margin_columns - 1),
                               patch.x(patch.margin_columns), -0.25 / patch.scale);
    if (x && (!place || *x < place->x)) place = Place{*x, patch.row(r)};
  }
  return place;
}

std::optional<Place> widest_place(const Patch& patch, const Vector& p, double level, int side) {
  const int first = patch.margin_rows, last = patch.height() - patch.margin_rows - 1;
  const double inner = patch.y(patch.row(side > 0 ? first : last));
  const double outer = patch.y(patch.row(side > 0 ? last : first));
  std::optional<Place> place;
  for (int c = patch.margin_columns; c < patch.width() - patch.margin_columns; ++c) {
    const double x = patch.x(c);
    const auto y = crossing_of([&](double at) { return field_at(patch, p, x, at).theta; }, level,
                               inner, outer, side * 0.25 / patch.scale);
    if (!y) continue;
    const double row = patch.centre_line + *y * patch.scale;
    if (!place || side * (row - place->row) > 0) place = Place{x, row};
  }
  return place;
}

double along_line(const Patch& patch, const Place& place) {
  return (place.x * patch.scale * Stack::samples + patch.centre_column) / Stack::samples;
}

}  // namespace meltproof::imaging::blurred_fit
