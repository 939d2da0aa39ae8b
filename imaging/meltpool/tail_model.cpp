// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/tail_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "imaging/meltpool/tail_draws.hpp"

namespace meltproof::imaging {

using namespace blurred_fit;

namespace {

using Random = std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)>;

Random generator(std::uint64_t seed) {
  Random random(gsl_rng_alloc(gsl_rng_mt19937), &gsl_rng_free);
  gsl_rng_set(random.get(), static_cast<unsigned long>(seed));
  return random;
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

}  // namespace

Blur total_blur(double point_spread, double shift) {
  const double across = point_spread * point_spread + 1.0 / 12;
  return {std::sqrt(across + shift * shift / 12), std::sqrt(across)};
}

namespace {

/// The part of the tail around a signal, with what is known beforehand.
std::optional<Patch> tail_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start, const TailPriors& priors) {
  auto patch = make_patch(stack, dark, with_columns(blur), edge, start, End::tail);
  if (!patch) return patch;
  patch->steepness = priors.steepness;
  patch->u_steepness = priors.u_steepness;
  if (priors.u_variance > 0) patch->prior.know(variance, 0, priors.u_variance);
  know_smoothness(*patch);
  // Heat of freezing over specific heat times liquidus: steels, nickel and titanium alloys have
  // 0.18 to 0.35.
  patch->narrowest = 0.16 * patch->steepness;
  patch->widest = 0.48 * patch->steepness;
  if (priors.interval) {
    patch->prior.know(interval, priors.interval->first, priors.interval->second);
    patch->narrowest = std::max(0.1, priors.interval->first - 3 * priors.interval->second);
    patch->widest = priors.interval->first + 3 * priors.interval->second;
  }
  return patch;
}

/// Fits without a front, with an abrupt one and with a shoulder.
struct TailFits {
  Vector smooth, abrupt, shoulder;
  double chi_abrupt = 0, chi_shoulder = 0, degrees = 1;
  const Vector& better() const { return chi_shoulder < chi_abrupt ? shoulder : abrupt; }
};
TailFits fit_kinds(const Patch& patch, int steps) {
  TailFits f;
  constexpr Freedom as_step{.theta_star = true, .ratio = true, .variance = true};
  constexpr Freedom gradual{.theta_star = true, .ratio = true, .interval = true, .variance = true};
  f.smooth = minimise(patch, first_guess(patch, {}), {.variance = true}, 25);
  f.abrupt = minimise(patch, first_guess(patch, {.ratio = 0.4}), as_step, steps);
  f.shoulder =
      minimise(patch, first_guess(patch, {.ratio = 0.05, .interval = 0.22 * patch.steepness}),
               gradual, steps);
  f.chi_abrupt = linearise(patch, f.abrupt, false).total();
  f.chi_shoulder = linearise(patch, f.shoulder, false).total();
  std::size_t used = 0;
  for (const double w : patch.weight) used += w > 0 ? 1 : 0;
  f.degrees = std::max(1.0, static_cast<double>(used) - parameters);
  return f;
}

/// What there is to say of a fit, without uncertainties.
std::optional<TailModel> described(const Patch& patch, const PlateEdge& edge, const Vector& best,
                                   const Vector& smooth, double degrees) {
  const auto place = outermost(patch, best, edge, best(theta_star));
  if (!place) return std::nullopt;
  const Linearised at = linearise(patch, best, false), without = linearise(patch, smooth, false);
  TailModel model;
  model.law = law_of(patch, best);
  model.log_signal = best(theta_star);
  model.rise = model.law.rise();
  model.interval = best(interval);
  model.variance = best(variance);
  model.front = along_line(patch, *place);
  model.slope = -field_at(patch, best, place->x, patch.y(place->row)).by_x / patch.scale;
  model.blurred = blurred_log_signal(patch, best, place->x, place->row);
  model.misfit = std::max(1.0, at.total() / degrees);
  model.explained = (without.total() - at.total()) / model.misfit;
  for (int l = 0; l < patch.lines; ++l) {
    const auto i = static_cast<std::size_t>(l);
    model.lines += 1;
    if ((without.chi_squared[i] - at.chi_squared[i]) / model.misfit >= 25)
      model.lines_with_front += 1;
  }
  const int line =
      std::clamp(static_cast<int>(std::lround(place->row - static_cast<double>(patch.line))), 0,
                 patch.lines - 1);
  for (int k = 0; k < patch.columns; ++k) {
    const auto i = static_cast<std::size_t>(line * patch.columns + k);
    if (!(patch.weight[i] > 0) || !(patch.value[i] > 0)) continue;
    const double theta = field_at(patch, best, patch.x(k + patch.margin_columns),
                                  patch.y(static_cast<double>(patch.line) + line))
                             .theta;
    model.profile.push_back(
        {(static_cast<double>(patch.column) + k) / Stack::samples, std::log(patch.value[i]),
         1 / (std::sqrt(patch.weight[i]) * patch.value[i]),
         std::log(std::max(at.blurred[i], 1e-12)), tail_law(model.law, theta, 0).log_signal});
  }
  return model;
}

}  // namespace

std::optional<TailModel> fit_tail(const Stack& stack, double dark, const Blur& blur,
                                  const PlateEdge& edge, double start, const TailPriors& priors,
                                  int steps) {
  const auto patch = tail_patch(stack, dark, blur, edge, start, priors);
  if (!patch) return std::nullopt;
  const TailFits fits = fit_kinds(*patch, steps);
  return described(*patch, edge, fits.better(), fits.smooth, fits.degrees);
}

std::optional<TailModel> infer_tail(const Stack& stack, double dark, const Blur& blur,
                                    const PlateEdge& edge, double start, std::uint64_t seed,
                                    const TailPriors& priors) {
  auto patch = tail_patch(stack, dark, blur, edge, start, priors);
  if (!patch) return std::nullopt;
  TailFits fits = fit_kinds(*patch, 60);
  // What a clipped mean says of its noise is too little: it is as large as the better fit leaves
  // it.
  const double noise = std::min(fits.chi_abrupt, fits.chi_shoulder) / fits.degrees;
  if (noise > 1)
    for (double& w : patch->weight) w /= noise;
  const Posterior p = posterior(*patch, fits.abrupt, fits.shoulder);
  auto model = described(*patch, edge, p.likeliest().best, fits.smooth, fits.degrees);
  if (!model) return model;
  model->misfit = std::max(1.0, noise);
  model->abrupt = p.abrupt;
  const Random random = generator(seed);
  std::vector<double> signals, rises, fronts, variances;
  TailDraw mean;
  double same = 0;
  for (int i = 0; i < 400; ++i) {
    const Vector drawn = draw(*patch, p, random.get());
    const auto place = outermost(*patch, drawn, edge, drawn(theta_star));
    if (!place) continue;
    const TailDraw d{along_line(*patch, *place), drawn(theta_star), drawn(variance), drawn(ratio),
                     drawn(interval)};
    model->draws.push_back(d);
    signals.push_back(d.log_signal);
    rises.push_back(law_of(*patch, drawn).rise());
    fronts.push_back(d.front);
    variances.push_back(d.variance);
    if ((d.interval == 0) != (model->interval == 0)) continue;
    same += 1;
    mean.front += d.front, mean.log_signal += d.log_signal, mean.variance += d.variance;
    mean.ratio += d.ratio, mean.interval += d.interval;
  }
  if (same > 0) {
    model->front = mean.front / same;
    model->log_signal = model->law.log_signal = mean.log_signal / same;
    model->variance = mean.variance / same;
    model->law.ratio = mean.ratio / same;
    model->interval = model->law.interval = mean.interval / same;
    model->rise = model->law.rise();
  }
  model->u_log_signal = spread(signals);
  model->u_rise = spread(rises);
  model->u_front = spread(fronts);
  model->u_variance = spread(variances);
  return model;
}

}  // namespace meltproof::imaging
