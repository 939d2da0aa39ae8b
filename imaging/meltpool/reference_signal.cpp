// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/reference_signal.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meltproof::imaging {
namespace {

/// ln(S - dark) of the brightest place of the stack that is not a single hot sample.
double brightest(const Stack& stack, double dark) {
  std::vector<float> values = smoothed(stack, 0.5, 0);
  const auto top = values.end() - static_cast<std::ptrdiff_t>(
                                      std::min<std::size_t>(4 * Stack::samples, values.size()));
  std::nth_element(values.begin(), top, values.end());
  return std::log(std::max(static_cast<double>(*top) - dark, 1e-12));
}

/// The first rule that a fit breaks, or an empty text.
std::string broken_rule(const TailModel& m, const ReferenceRules& rules) {
  if (m.misfit > rules.misfit)
    return fmt::format(
        "the tail follows no smooth course with a front (chi-squared {:.1f} a "
        "degree of freedom, at most {:.0f} is allowed)",
        m.misfit, rules.misfit);
  if (m.rise < rules.prominence)
    return fmt::format(
        "the most prominent feature of ln S has a height of {:.2f}, where a front "
        "has at least {:.2f}",
        m.rise, rules.prominence);
  if (m.rise < rules.significance * m.u_rise)
    return fmt::format(
        "the most prominent feature of ln S has a height of {:.2f} with a standard "
        "uncertainty of {:.2f}, where {:.0f} times that are needed",
        m.rise, m.u_rise, rules.significance);
  if (m.rise < rules.flattening * m.interval)
    return fmt::format(
        "within the most prominent feature the signal loses {:.0f} % of its slope, "
        "where a front takes at least {:.0f} %",
        100 * m.rise / m.interval, 100 * rules.flattening);
  const double widest = rules.widest * m.law.steepness;
  if (m.interval >= widest)
    return fmt::format("the most prominent feature is wider than an interval of {:.2f} in ln S",
                       widest);
  const double enough = rules.share * static_cast<double>(m.lines);
  if (m.lines_with_front < rules.fewest_lines || static_cast<double>(m.lines_with_front) < enough)
    return fmt::format(
        "{} of {} lines of pixels show the most prominent feature, where at least "
        "{} and {:.0f} % of them must",
        m.lines_with_front, m.lines, rules.fewest_lines, 100 * rules.share);
  if (m.u_front > rules.u_front)
    return fmt::format(
        "the place of the most prominent feature is uncertain by {:.1f} px, where "
        "{:.2f} px are allowed",
        m.u_front, rules.u_front);
  return {};
}

}  // namespace

std::string signature_name(Signature signature) {
  switch (signature) {
    case Signature::none:
      return "none";
    case Signature::latent_heat:
      return "latent heat";
    case Signature::emissivity:
      return "emissivity";
  }
  return "";
}

ReferenceSignal find_reference_signal(const Stack& stack, double dark, const Blur& blur,
                                      const PlateEdge& edge, double u_point_spread,
                                      const ReferenceRules& rules, std::uint64_t seed,
                                      double steepness, double u_steepness) {
  ReferenceSignal result;
  // The variance of the optics' part of the blur across the scan changes by 2 sigma a px of sigma.
  const double point_spread = std::sqrt(std::max(blur.across * blur.across - 1.0 / 12, 0.0));
  TailPriors priors{2 * point_spread * u_point_spread, steepness, u_steepness, {}};
  if (rules.freezing_heat) {
    const double interval = steepness * *rules.freezing_heat;
    priors.interval = {interval, rules.u_freezing_heat * interval};
  }
  const double top = brightest(stack, dark);
  // A few steps from many signals, then as many as it takes from the most promising ones.
  std::vector<std::pair<double, double>> starts;  // minus what a front explains so far; where
  for (double start = top - 0.3; start > top - 2.8; start -= 0.2)
    if (const auto m = fit_tail(stack, dark, blur, edge, start, priors, 8))
      if (m->rise >= 0.5 * rules.flattening * m->interval && m->rise > 0.5 * rules.prominence)
        starts.emplace_back(-m->explained / m->misfit, start);
  std::sort(starts.begin(), starts.end());
  starts.resize(std::min<std::size_t>(starts.size(), 4));
  std::optional<TailModel> best;
  const auto try_from = [&](double start) {
    const auto m = fit_tail(stack, dark, blur, edge, start, priors);
    if (!m) return;
    const bool good = broken_rule(*m, rules).empty();
    const bool was_good = best && broken_rule(*best, rules).empty();
    if (!best || (good != was_good ? good : m->misfit < best->misfit)) best = m;
  };
  for (const auto& [misfit, start] : starts) try_from(start);
  if (!best) {
    result.reason =
        "nothing marks the solidification front: the tail of the mean pool is too short or too "
        "faint to look for it";
    return result;
  }
  try_from(best->blurred);  // around the front itself
  if (const auto inferred = infer_tail(stack, dark, blur, edge, best->blurred, seed, priors))
    best = inferred;
  const std::string broken = broken_rule(*best, rules);
  result.model = *best;
  if (!broken.empty()) {
    result.reason = "nothing marks the solidification front: " + broken;
    return result;
  }
  result.signature = best->rise > best->interval ? Signature::emissivity : Signature::latent_heat;
  result.signal = dark + std::exp(best->log_signal);
  result.relative_u = best->u_log_signal;
  if (result.signature == Signature::emissivity)
    result.solid_signal = dark + std::exp(best->log_signal + best->rise - best->interval);
  result.blurred_signal = dark + std::exp(best->blurred);
  result.front = best->front;
  result.u_front = best->u_front;
  return result;
}

ImpliedEmissivity implied_emissivity(const ReferenceSignal& found, const Radiometry& radiometry,
                                     double reference_temperature) {
  // The signal is linear in the emissivity.
  const double none = signal(radiometry, reference_temperature, 0);
  const double black = signal(radiometry, reference_temperature, 1);
  const auto of = [&](double s) { return (s - none) / (black - none); };
  ImpliedEmissivity e;
  e.liquid = of(found.signal);
  if (found.solid_signal > 0) e.solid = of(found.solid_signal);
  return e;
}

}  // namespace meltproof::imaging
