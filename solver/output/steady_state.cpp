// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/steady_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include "solver/output/saturation_fit.hpp"

namespace meltproof::solver {
namespace {

constexpr std::size_t least_count = 8;  // values, below which nothing is estimated

/// The part of a series that is judged.
struct Window {
  std::vector<double> time, value;
};

double mean_of(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

double sum_of_squares(const std::vector<double>& v) {
  return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
}

std::vector<double> without(const std::vector<double>& v, double mean) {
  std::vector<double> r(v.size());
  std::transform(v.begin(), v.end(), r.begin(), [&](double x) { return x - mean; });
  return r;
}

Window after(const std::vector<double>& time, const std::vector<double>& value, std::size_t first) {
  const auto cut = static_cast<std::ptrdiff_t>(first);
  return {{time.begin() + cut, time.end()}, {value.begin() + cut, value.end()}};
}

/// The cut that makes the standard error of the mean of the rest least (White 1997), at most half
/// of the series and never so much that less than `least` seconds remain.
std::size_t mser_cut(const Window& w, double least) {
  const std::size_t n = w.value.size();
  std::size_t best = 0;
  double best_error = 0;
  for (std::size_t cut = 0; cut <= n / 2; ++cut) {
    const Window rest = after(w.time, w.value, cut);
    if (rest.value.size() < least_count ||
        (cut > 0 && rest.time.back() - rest.time.front() < least * (1 - 1e-9))) {
      break;
    }
    const auto m = static_cast<double>(rest.value.size());
    const double error = sum_of_squares(without(rest.value, mean_of(rest.value))) / (m * m);
    if (cut == 0 || error < best_error) {
      best = cut;
      best_error = error;
    }
  }
  return best;
}

/// Slope and its standard uncertainty with correlated residuals: that of independent ones with the
/// effective number in place of the number of values (Santer et al. 2000). Residuals are taken from
/// a parabola: on equidistant times it leaves the slope as it is, and a bend is no noise.
struct Line {
  double slope = 0, u = 0, freedom = 0;
};

Line fit_line(const Window& w) {
  const std::vector<double> t = without(w.time, mean_of(w.time)),
                            y = without(w.value, mean_of(w.value));
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  Line line;
  const double tt = sum_of_squares(t);
  line.slope = product(t, y) / tt;
  std::vector<double> bend(t.size());
  std::transform(t.begin(), t.end(), bend.begin(), [](double x) { return x * x; });
  bend = without(bend, mean_of(bend));
  const double skew = product(bend, t) / tt;
  for (std::size_t i = 0; i < t.size(); ++i) {
    bend[i] -= skew * t[i];
  }
  const double curvature = product(bend, y) / sum_of_squares(bend);
  std::vector<double> residual(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    residual[i] = y[i] - line.slope * t[i] - curvature * bend[i];
  }
  double effective = effective_size(residual, 3).size;
  const double squares = sum_of_squares(residual);
  if (is_smooth(std::sqrt(squares / static_cast<double>(residual.size())), mean_of(w.value))) {
    effective = std::max(effective, least_independent);
  }
  line.freedom = effective - 3;
  line.u = line.freedom > 0 ? std::sqrt(squares / line.freedom / tt) : 0;
  return line;
}

void add_limit(SteadyState& s, const Window& all) {
  const SaturationFit fit = fit_saturation(all.time, all.value);
  if (fit.found && fit.tau <= all.time.back() && fit.u_limit < 0.25 * fit.limit) {
    s.has_limit = true;
    s.limit = fit.limit;
    s.u_limit = fit.u_limit;
    s.tau = fit.tau;
    s.u_tau = fit.u_tau;
    s.fit_residual = fit.residual;
  }
}

}  // namespace

bool is_smooth(double residual_deviation, double quantity) {
  return residual_deviation <= 0.0025 * std::abs(quantity);
}

EffectiveSize effective_size(const std::vector<double>& residuals, int fitted) {
  const std::size_t n = residuals.size();
  const auto count = static_cast<double>(n);
  const double variance = sum_of_squares(residuals);
  EffectiveSize e{count, 0};
  if (n < least_count || !(variance > 0)) {
    return e;
  }
  const auto correlation = [&](std::size_t k) {
    return std::inner_product(residuals.begin() + static_cast<std::ptrdiff_t>(k), residuals.end(),
                              residuals.begin(), 0.0) /
           variance;
  };
  e.lag_1 = std::min(0.999, (count * correlation(1) + fitted) / (count - 4));
  const double autoregressive = count * (1 - e.lag_1) / (1 + e.lag_1);
  double sum = 1;
  for (std::size_t k = 1; k + 1 < n / 2; k += 2) {
    const double pair = correlation(k) + correlation(k + 1);
    if (!(pair > 0)) {
      break;
    }
    sum += 2 * pair;
  }
  e.size = std::clamp(std::min(autoregressive, count / sum), 1.0, count);
  return e;
}

SteadyState judge_steadiness(const std::vector<double>& time, const std::vector<double>& value,
                             const SteadySettings& settings) {
  if (time.size() != value.size()) {
    throw std::invalid_argument("a series has as many times as values");
  }
  SteadyState s;
  const auto begin = static_cast<std::size_t>(
      std::lower_bound(time.begin(), time.end(), settings.start_up * (1 - 1e-12)) - time.begin());
  const Window all = after(time, value, begin);
  if (!all.time.empty()) {
    s.from = all.time.front();
    s.to = all.time.back();
    s.count = all.time.size();
    s.mean = mean_of(all.value);
  }
  if (s.count > 1) {
    s.deviation =
        std::sqrt(sum_of_squares(without(all.value, s.mean)) / static_cast<double>(s.count - 1));
  }
  if (s.count < least_count || s.to - s.from < settings.least_window * (1 - 1e-9)) {
    return s;
  }
  const Window w = after(all.time, all.value, mser_cut(all, settings.least_window));
  s.from = w.time.front();
  s.count = w.time.size();
  s.mean = mean_of(w.value);
  const std::vector<double> scatter = without(w.value, s.mean);
  s.deviation = std::sqrt(sum_of_squares(scatter) / static_cast<double>(s.count - 1));
  s.effective = effective_size(scatter, 1).size;
  // A window that still grows is as wrong as its scatter, which then counts as one value.
  s.u_mean = s.deviation / std::sqrt(std::max(1.0, s.effective - 1));
  const Line line = fit_line(w);
  s.growth = line.slope;
  s.u_growth = line.u;
  if (line.freedom + 3 < least_independent) {
    return s;
  }
  s.coverage = gsl_cdf_tdist_Pinv(0.5 + settings.confidence / 2, line.freedom);
  const double change = std::abs(s.change()), reach = s.coverage * s.u_change(),
               mean = std::abs(s.mean);
  const bool seen = change > reach && change + reach > settings.negligible * mean;
  if (seen) {
    s.verdict = s.growth > 0 ? "growing" : "shrinking";
  } else {
    s.verdict = change + reach <= settings.tolerance * mean ? "steady" : "undecided";
  }
  if (s.verdict == "growing" || (s.verdict == "undecided" && s.change() > s.u_change())) {
    add_limit(s, all);
  }
  return s;
}

std::string SteadyState::sentence(const std::string& name, double scale,
                                  const std::string& unit) const {
  const std::string window = fmt::format("{:.0f} to {:.0f} us", 1e6 * from, 1e6 * to);
  if (count == 0) {
    return fmt::format("{}: no values after the start-up, nothing can be said", name);
  }
  if (verdict == "too short") {
    const std::string judged =
        effective > 0 ? fmt::format(", worth {:.0f} independent", effective) : "";
    return fmt::format(
        "{}: too short to say whether it is steady; {} values over {}{}, mean {:.4g} {} (standard "
        "deviation {:.2g})",
        name, count, window, judged, scale * mean, unit, scale * deviation);
  }
  std::string text = fmt::format(
      "{}: {}; mean {:.4g} {} (u {:.2g}, {:.0f} independent values) over {}, in which it changes "
      "by "
      "{:+.2g} +- {:.2g} {} (95 %)",
      name, verdict, scale * mean, unit, scale * u_mean, effective, window, scale * change(),
      scale * coverage * u_change(), unit);
  if (has_limit) {
    text += fmt::format("; tends to {:.4g} {} (u {:.2g}) with a time constant of {:.0f} us",
                        scale * limit, unit, scale * u_limit, 1e6 * tau);
  } else if (verdict == "growing") {
    text += "; what it tends to cannot be told from a series this short";
  }
  return text;
}

nlohmann::json SteadyState::json(const std::string& name, double scale,
                                 const std::string& unit) const {
  nlohmann::json j = {{"verdict", verdict},
                      {"steady", steady()},
                      {"mean_" + unit, scale * mean},
                      {"u_mean_" + unit, scale * u_mean},
                      {"sd_" + unit, scale * deviation},
                      {"growth_" + unit + "_per_ms", 1e-3 * scale * growth},
                      {"u_growth_" + unit + "_per_ms", 1e-3 * scale * u_growth},
                      {"change_over_window_" + unit, scale * change()},
                      {"u_change_over_window_" + unit, scale * u_change()},
                      {"coverage_factor_95", coverage},
                      {"window_from_us", 1e6 * from},
                      {"window_to_us", 1e6 * to},
                      {"values", count},
                      {"independent_values", effective},
                      {"sentence", sentence(name, scale, unit)}};
  if (has_limit) {
    j["limit_" + unit] = scale * limit;
    j["u_limit_" + unit] = scale * u_limit;
    j["time_constant_us"] = 1e6 * tau;
    j["u_time_constant_us"] = 1e6 * u_tau;
    j["fit_residual_" + unit] = scale * fit_residual;
  }
  return j;
}

}  // namespace meltproof::solver
