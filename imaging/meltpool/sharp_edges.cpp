// SPDX-License-Identifier: GPL-3.0-or-later
// The ends of the mean pool at a signal, without the blur.
#include <algorithm>
#include <cmath>

#include "imaging/meltpool/blurred_fit.hpp"

namespace meltproof::imaging {

using namespace blurred_fit;

namespace {

Stack reversed(Stack stack) {
  for (std::size_t l = 0; l < stack.lines; ++l) {
    const auto first = static_cast<std::ptrdiff_t>(l * stack.columns);
    const auto last = first + static_cast<std::ptrdiff_t>(stack.columns);
    std::reverse(stack.signal.begin() + first, stack.signal.begin() + last);
    std::reverse(stack.deviation.begin() + first, stack.deviation.begin() + last);
  }
  return stack;
}

constexpr Freedom as_edge{.cap = true};

/// What is known of an end's field. The highest signal lies somewhat above the brightest that the
/// blur leaves; where the field never comes near it nothing else would fix it. Ahead of the beam
/// and beside it theta falls by some 10 within the patch, and no coefficient is much larger: of
/// those that the samples do not tell, any change would seem to fit as well.
void know_end(Patch& patch, bool tail) {
  patch.prior.know(cap, patch.brightest + 0.2, 0.5);
  if (tail) return know_smoothness(patch);
  for (int k = 1; k < terms; ++k) patch.prior.know(k, 0, 10);
}

/// The field of an end of the pool; the law is known.
Vector fit_field(const Patch& patch, double log_level, const TailLaw* law) {
  const auto with_law = [&](Vector p) {
    p(theta_star) = log_level;
    p(cap) = patch.brightest + 0.2;
    p(ratio) = law != nullptr ? law->ratio : 0;
    p(interval) = law != nullptr ? law->interval : 0;
    return p;
  };
  const Vector guess = with_law(first_guess(patch, {}));
  Vector best = minimise(patch, guess, as_edge, 60);
  const double chi = linearise(patch, best, false).total();
  if (chi > 4 * static_cast<double>(patch.weight.size())) {
    // In noise the polynomial through ln S may begin far from where the signal's own fit ends.
    Vector plain = guess;
    for (int k = 0; k < terms; ++k)
      if (k / (across_order + 1) + k % (across_order + 1) > 2) plain(k) = 0;
    plain = minimise(patch, plain, as_edge, 60);
    if (linearise(patch, plain, false).total() < chi) best = plain;
  }
  return best;
}

/// Uncertainty, misfit and changes of a fitted end, to first order in the field's parameters: an
/// outermost place moves by what theta changes there over its slope.
/// @param slope of theta there, along the axis of the position, a px.
SharpEdge sharp_edge(const Patch& patch, const Vector& best, const Place& place, double slope) {
  const Linearised at = linearise(patch, best, true);
  const auto used =
      std::count_if(patch.weight.begin(), patch.weight.end(), [](double w) { return w > 0; });
  const Vector theta = terms_at(patch, place.x, patch.y(place.row));
  SharpEdge edge;
  edge.misfit = at.total() / std::max(1.0, static_cast<double>(used - terms));
  const double variance_of_theta = theta.dot(covariance(patch, at, as_edge) * theta);
  edge.u = std::sqrt(edge.misfit * std::max(0.0, variance_of_theta)) / std::abs(slope);
  const auto change = [&](int parameter) {
    const double level = parameter == theta_star ? 1 : 0;
    return (level - theta.dot(response(patch, at, as_edge, parameter))) / slope;
  };
  edge.by_log_level = change(theta_star);
  edge.by_ratio = change(ratio);
  edge.by_interval = change(interval);
  edge.by_variance = change(variance);
  return edge;
}

}  // namespace

std::optional<SharpEdge> fit_edge(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, bool leading,
                                  const TailLaw* law) {
  const End end = leading ? End::leading : End::tail;
  auto patch =
      make_patch(leading ? reversed(stack) : stack, dark, with_columns(blur), edge, log_level, end);
  if (!patch) return std::nullopt;
  if (law != nullptr) patch->steepness = law->steepness;
  know_end(*patch, !leading);
  const Vector best = fit_field(*patch, log_level, law);
  const auto place = outermost(*patch, best, edge, log_level);
  if (!place) return std::nullopt;
  const Field there = field_at(*patch, best, place->x, patch->y(place->row));
  SharpEdge sharp = sharp_edge(*patch, best, *place, there.by_x / patch->scale);
  sharp.position = along_line(*patch, *place);
  if (leading) {
    sharp.position = static_cast<double>(stack.columns - 1) / Stack::samples - sharp.position;
    for (double* by :
         {&sharp.by_log_level, &sharp.by_ratio, &sharp.by_interval, &sharp.by_variance})
      *by = -*by;
  }
  return sharp;
}

std::optional<SharpEdge> fit_side(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, int side,
                                  const TailLaw* law) {
  auto patch = make_side_patch(stack, dark, with_columns(blur), edge, log_level, side);
  if (!patch) return std::nullopt;
  if (law != nullptr) patch->steepness = law->steepness;
  know_end(*patch, false);
  const Vector best = fit_field(*patch, log_level, law);
  const auto place = widest_place(*patch, best, log_level, side);
  if (!place) return std::nullopt;
  const Field there = field_at(*patch, best, place->x, patch->y(place->row));
  SharpEdge sharp = sharp_edge(*patch, best, *place, there.by_y / patch->scale);
  sharp.position = place->row;
  return sharp;
}

}  // namespace meltproof::imaging
