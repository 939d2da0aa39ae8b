// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gsl/gsl_rng.h>

#include "imaging/meltpool/blurred_fit.hpp"

namespace meltproof::imaging {

using namespace blurred_fit;

namespace {

/// The blur with what a stack's columns add by their width.
Blur with_columns(const Blur& blur) {
  const double column = 1.0 / (12 * Stack::samples * Stack::samples);
  return {std::sqrt(blur.along * blur.along + column), blur.across};
}

/// Half the width of the middle 68 % of the values: robust, since one linear step may leave the
/// range where it is one.
double spread(std::vector<double> v) {
  if (v.size() < 20) return 1e9;
  std::sort(v.begin(), v.end());
  const auto part = [&](double q) {
    return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
  };
  return 0.5 * (part(0.8413) - part(0.1587));
}

/// Parameters after one step of Gauss and Newton with the lines drawn with replacement, 200 times.
template <class Use>
void bootstrap(const Linearised& at, const Vector& best, bool with_front, std::uint64_t seed,
               const Use& use) {
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 &gsl_rng_free);
  gsl_rng_set(random.get(), static_cast<unsigned long>(seed));
  const bool at_bound = best(interval) < 1.5 * narrowest || best(interval) >= widest;
  const auto lines = static_cast<unsigned long>(at.normal.size());
  for (int draw = 0; draw < 200; ++draw) {
    Matrix normal = 1e-3 * sum(at.normal);  // a draw may lack the lines that fix a term
    Vector gradient = 1e-3 * sum(at.gradient);
    for (unsigned long l = 0; l < lines; ++l) {
      const auto i = static_cast<std::size_t>(gsl_rng_uniform_int(random.get(), lines));
      normal += at.normal[i];
      gradient += at.gradient[i];
    }
    use(bounded(best + solve(normal, gradient, 1e-6, with_front, at_bound), with_front));
  }
}

Stack reversed(Stack stack) {
  for (std::size_t l = 0; l < stack.lines; ++l) {
    const auto first = static_cast<std::ptrdiff_t>(l * stack.columns);
    const auto last = first + static_cast<std::ptrdiff_t>(stack.columns);
    std::reverse(stack.signal.begin() + first, stack.signal.begin() + last);
    std::reverse(stack.deviation.begin() + first, stack.deviation.begin() + last);
  }
  return stack;
}

}  // namespace

Blur total_blur(double point_spread, double shift) {
  const double across = point_spread * point_spread + 1.0 / 12;
  return {std::sqrt(across + shift * shift / 12), std::sqrt(across)};
}

std::optional<TailModel> fit_tail(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double start, std::uint64_t seed,
                                  int steps) {
  const auto patch = make_patch(stack, dark, with_columns(blur), edge, start, End::tail);
  if (!patch) return std::nullopt;
  const Vector smooth = minimise(*patch, first_guess(*patch, 0, 0.1), false, 25);
  const double chi_smooth = linearise(*patch, smooth, false).total();
  // A step and a shoulder, both as a fit may start; the better one is kept.
  Vector best = smooth;
  double chi = 1e300;
  for (const auto& [height, width] : {std::pair{0.4, 0.08}, {0.5, 0.55}, {0.8, 0.5}}) {
    Vector p = first_guess(*patch, height, width);
    p = minimise(*patch, p, true, steps);
    const double trial = linearise(*patch, p, false).total();
    if (trial < chi) chi = trial, best = p;
  }
  const auto place = outermost(*patch, best, edge, best(theta_star));
  if (!place) return std::nullopt;
  const Linearised at = linearise(*patch, best, true);
  const Linearised without = linearise(*patch, smooth, false);
  std::size_t used = 0;
  for (const double w : patch->weight) used += w > 0 ? 1 : 0;

  TailModel model;
  model.log_signal = best(theta_star);
  model.rise = best(rise);
  model.interval = best(interval);
  model.front = along_line(*patch, *place);
  const double y = (place->row - patch->centre_line) / patch->scale;
  model.slope = (theta_at(*patch, best, place->x, y) -
                 theta_at(*patch, best, place->x + 0.1 / patch->scale, y)) /
                0.1;
  const int c =
      static_cast<int>(std::lround(place->x * patch->scale * Stack::samples + patch->centre_column -
                                   static_cast<double>(patch->column))) +
      patch->margin_columns;
  const int r = static_cast<int>(std::lround(
                    (place->row - static_cast<double>(patch->line)) * fine + 0.5 * (fine - 1))) +
                patch->margin_rows;
  model.blurred = std::log(std::max(at.blurred.at<double>(r, c), 1e-12));
  model.misfit = std::max(1.0, chi / static_cast<double>(used - parameters));
  model.explained = (chi_smooth - chi) / model.misfit;
  for (int l = 0; l < patch->lines; ++l) {
    const auto i = static_cast<std::size_t>(l);
    model.lines += 1;
    if ((without.chi_squared[i] - at.chi_squared[i]) / model.misfit >= 25)
      model.lines_with_front += 1;
  }
  const int line =
      std::clamp(static_cast<int>(std::lround(place->row - static_cast<double>(patch->line))), 0,
                 patch->lines - 1);
  for (int k = 0; k < patch->columns; ++k) {
    const auto i = static_cast<std::size_t>(line * patch->columns + k);
    if (!(patch->weight[i] > 0) || !(patch->value[i] > 0)) continue;
    const double row = patch->margin_rows + line * fine + fine / 2;
    const double theta = theta_at(*patch, best, patch->x(k + patch->margin_columns),
                                  patch->y(static_cast<int>(row)));
    const double depth = std::clamp((best(theta_star) - theta) / best(interval), 0.0, 1.0);
    model.profile.push_back(
        {(static_cast<double>(patch->column) + k) / Stack::samples, std::log(patch->value[i]),
         1 / (std::sqrt(patch->weight[i]) * patch->value[i]),
         std::log(std::max(at.blurred.at<double>(static_cast<int>(row), k + patch->margin_columns),
                           1e-12)),
         theta + best(rise) * depth});
  }
  std::vector<double> signals, rises, fronts;
  bootstrap(at, best, true, seed, [&](const Vector& p) {
    const auto drawn = outermost(*patch, p, edge, p(theta_star));
    if (!drawn) return;
    signals.push_back(p(theta_star));
    rises.push_back(p(rise));
    fronts.push_back(along_line(*patch, *drawn));
  });
  model.u_log_signal = spread(signals);
  model.u_rise = spread(rises);
  model.u_front = spread(fronts);
  return model;
}

std::optional<SharpEdge> fit_edge(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, bool leading,
                                  std::uint64_t seed) {
  const End end = leading ? End::leading : End::tail;
  const auto patch =
      make_patch(leading ? reversed(stack) : stack, dark, with_columns(blur), edge, log_level, end);
  if (!patch) return std::nullopt;
  Vector best = minimise(*patch, first_guess(*patch, 0, 0.1), false, 60);
  const double chi = linearise(*patch, best, false).total();
  if (chi > 4 * static_cast<double>(patch->weight.size())) {
    // In noise the polynomial through ln S may begin far from where the signal's own fit ends.
    Vector plain = first_guess(*patch, 0, 0.1);
    for (int k = 0; k < terms; ++k)
      if (k / (across_order + 1) + k % (across_order + 1) > 2) plain(k) = 0;
    plain = minimise(*patch, plain, false, 60);
    const double other = linearise(*patch, plain, false).total();
    if (other < chi) best = plain;
  }
  const auto place = outermost(*patch, best, edge, log_level);
  if (!place) return std::nullopt;
  const Linearised at = linearise(*patch, best, true);
  const auto used =
      std::count_if(patch->weight.begin(), patch->weight.end(), [](double w) { return w > 0; });
  std::vector<double> places;
  bootstrap(at, best, false, seed, [&](const Vector& p) {
    if (const auto drawn = outermost(*patch, p, edge, log_level))
      places.push_back(along_line(*patch, *drawn));
  });
  SharpEdge sharp;
  sharp.position = along_line(*patch, *place);
  if (leading)
    sharp.position = static_cast<double>(stack.columns - 1) / Stack::samples - sharp.position;
  sharp.u = spread(places);
  sharp.misfit = at.total() / std::max(1.0, static_cast<double>(used - terms));
  return sharp;
}

}  // namespace meltproof::imaging
