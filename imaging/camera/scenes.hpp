// SPDX-License-Identifier: GPL-3.0-or-later
// Random passages of known truth, for tests of how often an interval holds it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <random>

#include "imaging/camera/round_trip.hpp"

namespace meltproof::imaging {

/// Passages of the paper's camera over an analytic pool, seen from above, one after the other.
class Scenes {
 public:
  /// @param u_point_spread px, by what a scene's point spread differs from what the budget is told.
  explicit Scenes(std::uint64_t seed, double u_point_spread = BudgetSettings{}.u_point_spread)
      : engine_(seed), u_point_spread_(u_point_spread) {}
  /// Evenly distributed between two numbers.
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Of mean 0 and standard deviation 1.
  double normal() {
    return std::sqrt(-2 * std::log(uniform(1e-12, 1))) *
           std::cos(2 * std::numbers::pi * uniform(0, 1));
  }
  /// The paper's camera with an emissivity, integration time, place and point spread of its own.
  PassageSettings next(int number) {
    PassageSettings s;
    const BudgetSettings known;
    s.source.view = "top";
    s.source.frames = 56;
    s.camera.surface_row = uniform(18, 21);
    s.start = uniform(-12, -8);
    s.source.absorbed_power = uniform(48, 72);
    s.camera.emissivity_liquid = s.camera.emissivity_solid = uniform(0.2, 0.5);
    s.camera.integration_time = uniform(5e-6, 40e-6);
    s.camera.point_spread = known.point_spread + u_point_spread_ * std::clamp(normal(), -3.0, 3.0);
    s.non_uniformity = known.non_uniformity;
    s.seed = static_cast<std::uint64_t>(number) + 1;
    signal_to_noise = number % 2 == 0 ? 100 : 20;
    return s;
  }
  double signal_to_noise = 100;  ///< of the scene that next() has given

 private:
  std::mt19937_64 engine_;
  double u_point_spread_;
};

/// How far measurements are from the truth, and how often their intervals hold it.
struct Tally {
  int n = 0, close = 0, depth_close = 0, covered = 0, depth_covered = 0, none = 0;
  double sum = 0, squares = 0, worst = 0;
  void add(const Measurement& m, const FilmedPassage& film) {
    const Budget& b = *m.budget;
    const double error = b.length.value / film.length - 1;
    ++n;
    close += std::abs(error) <= 0.02 ? 1 : 0;
    depth_close += std::abs(b.depth.value - film.depth) <= 17.6e-6 ? 1 : 0;
    covered += b.length.low <= film.length && film.length <= b.length.high ? 1 : 0;
    depth_covered += b.depth.low <= film.depth && film.depth <= b.depth.high ? 1 : 0;
    sum += error;
    squares += error * error;
    worst = std::max(worst, std::abs(error));
  }
  void say(const char* what) const {
    if (n == 0) {
      std::cout << what << ": none measured, " << none << " refused\n";
      return;
    }
    std::cout << what << ": " << n << " scenes measured, " << none
              << " refused; length within 2 % in " << 100.0 * close / n << " %, mean error "
              << 100 * sum / n << " %, rms " << 100 * std::sqrt(squares / n) << " %, worst "
              << 100 * worst << " %; depth within a pixel in " << 100.0 * depth_close / n
              << " %; intervals cover the length in " << 100.0 * covered / n
              << " % and the depth in " << 100.0 * depth_covered / n << " %\n";
  }
};

/// The pixel and the reference temperature of a passage, which a user knows.
inline MeasurementRequest request_for(const PassageSettings& s) {
  MeasurementRequest r;
  r.pixel = {s.camera.pixel_size, s.camera.pixel_size, 0, 0};
  r.level.reference_temperature = s.source.reference_temperature;
  return r;
}

/// A passage as a recording whose header holds an emissivity that somebody assumed, 1, instead of
/// the scene's own.
inline Recording with_assumed_emissivity(const FilmedPassage& film, const PassageSettings& s,
                                         double assumed) {
  Recording recording = recording_of(film, s);
  recording.header().radiometry->emissivity = assumed;
  return recording;
}

}  // namespace meltproof::imaging
