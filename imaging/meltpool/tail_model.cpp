// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gsl/gsl_randist.h>
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

/// Parameters after one step of Gauss and Newton with the lines drawn with replacement, and with
/// another draw of what is known of the blur, 200 times.
template <class Use>
void bootstrap(const Patch& patch, const Linearised& at, const Vector& best, Freedom free,
               std::uint64_t seed, const Use& use) {
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 &gsl_rng_free);
  gsl_rng_set(random.get(), static_cast<unsigned long>(seed));
  if (best(interval) <= narrowest || best(interval) >= widest) free.interval = false;
  const auto lines = static_cast<unsigned long>(at.normal.size());
  for (int draw = 0; draw < 200; ++draw) {
    Matrix normal = 1e-3 * sum(at.normal);  // a draw may lack the lines that fix a term
    Vector gradient = 1e-3 * sum(at.gradient);
    for (unsigned long l = 0; l < lines; ++l) {
      const auto i = static_cast<std::size_t>(gsl_rng_uniform_int(random.get(), lines));
      normal += at.normal[i];
      gradient += at.gradient[i];
    }
    const double prior = patch.u_variance * gsl_ran_gaussian_ziggurat(random.get(), 1);
    use(bounded(patch, best + solve(patch, normal, gradient, best, 1e-6, free, prior), free));
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
                                  const TailPriors& priors, int steps) {
  auto patch = make_patch(stack, dark, with_columns(blur), edge, start, End::tail);
  if (!patch) return std::nullopt;
  patch->u_variance = priors.u_variance;
  patch->steepness = priors.steepness;
  const Vector smooth = minimise(*patch, first_guess(*patch, {}), {.variance = true}, 25);
  const Linearised without = linearise(*patch, smooth, false);
  // A step and a shoulder; the likelier one is kept.
  constexpr Freedom abrupt{.theta_star = true, .ratio = true, .variance = true};
  constexpr Freedom gradual{.theta_star = true, .ratio = true, .interval = true, .variance = true};
  Vector best = smooth;
  Freedom free;
  double chi = 1e300;
  std::size_t used = 0;
  for (const double w : patch->weight) used += w > 0 ? 1 : 0;
  const double degrees = static_cast<double>(used) - parameters;
  for (const TailLaw& law : {TailLaw{.ratio = 0.4}, TailLaw{.ratio = 0.05, .interval = 0.55}}) {
    const Freedom freedom = law.interval > 0 ? gradual : abrupt;
    const Vector p = minimise(*patch, first_guess(*patch, law), freedom, steps);
    const double trial = linearise(*patch, p, false).total();
    // A shoulder has one parameter more, and must explain three standard deviations more with it.
    // Heat released over less than any steel has is none: the shortest interval would fit an abrupt
    // front and a point spread further off than is likely, with a front a pixel too far in.
    const double noise = std::max(1.0, chi / degrees);
    if (law.interval > 0 && (chi - trial < 9 * noise || p(interval) <= narrowest * 1.001)) continue;
    if (trial < chi) chi = trial, best = p, free = freedom;
  }
  const auto place = outermost(*patch, best, edge, best(theta_star));
  if (!place) return std::nullopt;
  const Linearised at = linearise(*patch, best, true);

  TailModel model;
  model.law = law_of(*patch, best);
  model.log_signal = best(theta_star);
  model.rise = model.law.rise();
  model.interval = best(interval);
  model.variance = best(variance);
  model.front = along_line(*patch, *place);
  model.slope = -field_at(*patch, best, place->x, patch->y(place->row)).by_x / patch->scale;
  model.blurred = blurred_log_signal(*patch, best, place->x, place->row);
  model.misfit = std::max(1.0, chi / degrees);
  model.explained = (without.total() - chi) / model.misfit;
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
    const double theta = field_at(*patch, best, patch->x(k + patch->margin_columns),
                                  patch->y(static_cast<double>(patch->line) + line))
                             .theta;
    model.profile.push_back(
        {(static_cast<double>(patch->column) + k) / Stack::samples, std::log(patch->value[i]),
         1 / (std::sqrt(patch->weight[i]) * patch->value[i]),
         std::log(std::max(at.blurred[i], 1e-12)), tail_law(model.law, theta, 0).log_signal});
  }
  std::vector<double> signals, rises, fronts, variances;
  bootstrap(*patch, at, best, free, seed, [&](const Vector& p) {
    const auto drawn = outermost(*patch, p, edge, p(theta_star));
    if (!drawn) return;
    model.draws.push_back({along_line(*patch, *drawn), p(theta_star), p(variance)});
    signals.push_back(p(theta_star));
    rises.push_back(law_of(*patch, p).rise());
    fronts.push_back(model.draws.back().front);
    variances.push_back(p(variance));
  });
  model.u_log_signal = spread(signals);
  model.u_rise = spread(rises);
  model.u_front = spread(fronts);
  model.u_variance = spread(variances);
  return model;
}

namespace {

/// The field of an end of the pool; the law is known.
Vector fit_field(const Patch& patch, double log_level, const TailLaw* law) {
  const auto with_law = [&](Vector p) {
    p(theta_star) = log_level;
    p(ratio) = law != nullptr ? law->ratio : 0;
    p(interval) = law != nullptr ? law->interval : 0;
    return p;
  };
  const Vector guess = with_law(first_guess(patch, {}));
  Vector best = minimise(patch, guess, {}, 60);
  const double chi = linearise(patch, best, false).total();
  if (chi > 4 * static_cast<double>(patch.weight.size())) {
    // In noise the polynomial through ln S may begin far from where the signal's own fit ends.
    Vector plain = guess;
    for (int k = 0; k < terms; ++k)
      if (k / (across_order + 1) + k % (across_order + 1) > 2) plain(k) = 0;
    plain = minimise(patch, plain, {}, 60);
    if (linearise(patch, plain, false).total() < chi) best = plain;
  }
  return best;
}

/// Position, uncertainty and misfit of a fitted end. @param place of p: a number, or nothing.
template <class Where>
std::optional<SharpEdge> sharp_edge(const Patch& patch, const Vector& best, std::uint64_t seed,
                                    const Where& place) {
  const std::optional<double> position = place(best);
  if (!position) return std::nullopt;
  const Linearised at = linearise(patch, best, true);
  const auto used =
      std::count_if(patch.weight.begin(), patch.weight.end(), [](double w) { return w > 0; });
  std::vector<double> places;
  bootstrap(patch, at, best, {}, seed, [&](const Vector& p) {
    if (const std::optional<double> drawn = place(p)) places.push_back(*drawn);
  });
  return SharpEdge{*position, spread(places),
                   at.total() / std::max(1.0, static_cast<double>(used - terms))};
}

}  // namespace

std::optional<SharpEdge> fit_edge(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, bool leading,
                                  std::uint64_t seed, const TailLaw* law) {
  const End end = leading ? End::leading : End::tail;
  auto patch =
      make_patch(leading ? reversed(stack) : stack, dark, with_columns(blur), edge, log_level, end);
  if (!patch) return std::nullopt;
  if (law != nullptr) patch->steepness = law->steepness;
  const Vector best = fit_field(*patch, log_level, law);
  auto sharp = sharp_edge(*patch, best, seed, [&](const Vector& p) -> std::optional<double> {
    const auto place = outermost(*patch, p, edge, log_level);
    if (!place) return std::nullopt;
    return along_line(*patch, *place);
  });
  if (sharp && leading)
    sharp->position = static_cast<double>(stack.columns - 1) / Stack::samples - sharp->position;
  return sharp;
}

std::optional<SharpEdge> fit_side(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double log_level, int side,
                                  std::uint64_t seed, const TailLaw* law) {
  auto patch = make_side_patch(stack, dark, with_columns(blur), edge, log_level, side);
  if (!patch) return std::nullopt;
  if (law != nullptr) patch->steepness = law->steepness;
  const Vector best = fit_field(*patch, log_level, law);
  return sharp_edge(*patch, best, seed, [&](const Vector& p) -> std::optional<double> {
    const auto place = widest_place(*patch, p, log_level, side);
    if (!place) return std::nullopt;
    return place->row;
  });
}

}  // namespace meltproof::imaging
