// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

/// The simulated profile as a function; NaN outside it and beside gaps.
struct Interpolation {
  std::vector<double> x, y;
  double operator()(double at) const {
    const double end = 1e-9 * (x.back() - x.front());
    if (at < x.front() - end || at > x.back() + end) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const auto above = std::upper_bound(x.begin(), x.end(), at);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - x.begin(), 1, std::ssize(x) - 1));
    const double part = std::clamp((at - x[i - 1]) / (x[i] - x[i - 1]), 0.0, 1.0);
    return part == 0 ? y[i - 1] : part == 1 ? y[i] : y[i - 1] + part * (y[i] - y[i - 1]);
  }
};

Interpolation turned(const Interpolation& profile) {
  Interpolation result;
  for (std::size_t i = profile.x.size(); i-- > 0;) {
    result.x.push_back(profile.x.front() + profile.x.back() - profile.x[i]);
    result.y.push_back(profile.y[i]);
  }
  return result;
}

struct Points {
  std::vector<double> position, measured, uncertainty;
  std::vector<std::size_t> index;
};

bool usable(const Interpolation& profile, double at, double shift) {
  if (std::isnan(profile(at - shift)) || std::isnan(profile(at + shift))) {
    return false;
  }
  for (std::size_t i = 0; i < profile.x.size(); ++i) {
    if (std::abs(profile.x[i] - at) <= shift && std::isnan(profile.y[i])) {
      return false;
    }
  }
  return true;
}

CurveMetrics metrics(const Interpolation& profile, const Points& points, double shift,
                     std::size_t fitted) {
  std::vector<double> simulated;
  for (const double at : points.position) {
    simulated.push_back(profile(at + shift));
  }
  return curve_metrics(simulated, points.measured, points.uncertainty, fitted);
}

/// The shift of the smallest RMSE: a scan that finds the right valley, then golden section in it.
double best_shift(const Interpolation& profile, const Points& points, double bound) {
  const auto cost = [&](double shift) {
    return metrics(profile, points, shift, 0).root_mean_square;
  };
  const int steps = 100;
  const double width = bound / steps;
  double best = 0;
  for (int i = -steps; i <= steps; ++i) {
    best = cost(i * width) < cost(best) ? i * width : best;
  }
  double low = std::max(-bound, best - width), high = std::min(bound, best + width);
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (int i = 0; i < 40; ++i) {
    const double left = high - golden * (high - low), right = low + golden * (high - low);
    (cost(left) < cost(right) ? high : low) = cost(left) < cost(right) ? right : left;
  }
  const double refined = 0.5 * (low + high);
  return cost(refined) < cost(best) ? refined : best;
}

/// Halfway between the smallest and the largest value.
double middle_level(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return 0.5 * (*low + *high);
}

/// The place where a profile crosses the level most steeply.
double steepest_crossing(const std::vector<double>& x, const std::vector<double>& y, double level,
                         const char* which) {
  double steepest = 0, place = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double rise = y[i] - y[i - 1], slope = std::abs(rise / (x[i] - x[i - 1]));
    if ((y[i - 1] - level) * (y[i] - level) <= 0 && slope > steepest) {
      steepest = slope;
      place = x[i - 1] + (level - y[i - 1]) / rise * (x[i] - x[i - 1]);
    }
  }
  if (!(steepest > 0)) {
    throw InputError(fmt::format(
        "--landmark: the {} profile does not cross {:.4g}, halfway between the measured extremes: "
        "name the places instead, \"SIMULATED, MEASURED\".",
        which, level));
  }
  return place;
}

/// The shift that brings the landmarks together on the profile as given or turned.
double landmark_shift(const Interpolation& profile, const Interpolation& forward,
                      const Landmark& landmark, const Points& points, double bound) {
  double simulated = landmark.simulated, measured = landmark.measured;
  if (landmark.half_height) {
    const double level = middle_level(points.measured);
    simulated = steepest_crossing(profile.x, profile.y, level, "simulated");
    measured = steepest_crossing(points.position, points.measured, level, "measured");
  } else if (&profile != &forward) {
    simulated = forward.x.front() + forward.x.back() - simulated;
  }
  const double shift = simulated - measured;
  if (std::abs(shift) > bound * (1 + 1e-9)) {
    throw InputError(fmt::format(
        "--landmark: the landmarks lie {:.4g} um apart and the shift may be {:.4g} um: allow more "
        "with --shift, or name other landmarks.",
        1e6 * shift, 1e6 * bound));
  }
  return shift;
}

}  // namespace

Registration register_profiles(std::span<const double> simulated_position,
                               std::span<const double> simulated,
                               std::span<const double> measured_position,
                               std::span<const double> measured,
                               std::span<const double> uncertainty,
                               std::span<const std::size_t> leave_out,
                               const RegistrationBounds& bounds) {
  const Interpolation forward{{simulated_position.begin(), simulated_position.end()},
                              {simulated.begin(), simulated.end()}};
  const Interpolation backward = turned(forward);
  Points points;
  for (std::size_t i = 0; i < measured_position.size(); ++i) {
    const double at = measured_position[i];
    if (std::find(leave_out.begin(), leave_out.end(), i) == leave_out.end() &&
        usable(forward, at, bounds.shift) &&
        (!bounds.reversible || usable(backward, at, bounds.shift))) {
      points.position.push_back(at);
      points.measured.push_back(measured[i]);
      points.index.push_back(i);
      if (!uncertainty.empty()) {
        points.uncertainty.push_back(uncertainty[i]);
      }
    }
  }
  if (points.position.size() < 3) {
    throw InputError(fmt::format(
        "{} of {} measured points lie on material of the simulated line for every shift up to {} "
        "um: at least 3 are needed. Lengthen the line or allow less shift.",
        points.position.size(), measured_position.size(), 1e6 * bounds.shift));
  }
  Registration result;
  result.fitted = (bounds.shift > 0 ? 1 : 0) + (bounds.reversible ? 1 : 0);
  result.before = metrics(forward, points, 0, 0);
  result.by_landmark = bounds.landmark.has_value();
  const auto shift_of = [&](const Interpolation& profile) {
    return bounds.landmark
               ? landmark_shift(profile, forward, *bounds.landmark, points, bounds.shift)
           : bounds.shift > 0 ? best_shift(profile, points, bounds.shift)
                              : 0;
  };
  result.shift = shift_of(forward);
  const Interpolation* chosen = &forward;
  if (bounds.reversible) {
    const double other = shift_of(backward);
    if (metrics(backward, points, other, 0).root_mean_square <
        metrics(forward, points, result.shift, 0).root_mean_square) {
      result.shift = other;
      result.reversed = true;
      chosen = &backward;
    }
  }
  result.after = metrics(*chosen, points, result.shift, result.fitted);
  result.position = points.position;
  result.measured = points.measured;
  result.index = points.index;
  for (const double at : points.position) {
    result.simulated.push_back((*chosen)(at + result.shift));
    result.simulated_before.push_back(forward(at));
    const double place = at + result.shift;
    result.place.push_back(result.reversed ? forward.x.front() + forward.x.back() - place : place);
  }
  return result;
}

}  // namespace meltproof::validation
