// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

/// The level that a reference signal amounts to.
Level level_of(const ReferenceSignal& found, double dark, double reference_temperature) {
  Level level;
  level.kind = LevelKind::recording;
  level.reference_temperature = reference_temperature;
  level.interpolation = {.logarithmic = true, .dark = dark};
  if (found.signature == Signature::emissivity && found.solid_signal > found.signal) {
    level.step = EmissivityStep{dark, found.signal, found.solid_signal};
    level.value = level.step->level();
    level.how = fmt::format(
        "the solidification front was found in the recording, where the signal steps from {:.6g} "
        "to {:.6g} behind it (S* = {:.6g}); levels are crossed more than once there, and the "
        "outermost, the step itself, is the front; independent of emissivity and transmission",
        found.signal, found.solid_signal, found.signal);
  } else {
    level.value = found.blurred_signal;
    level.how = fmt::format(
        "the solidification front was found in the recording by the shoulder that latent heat "
        "makes in the tail (S* = {:.6g}, {:.6g} as the blurred recording shows it); independent "
        "of emissivity and transmission",
        found.signal, found.blurred_signal);
  }
  return level;
}

/// d ln S / d ln T of metal: what is taken for it where a recording tells nothing of its band
/// covers 3 to 5 um from 1300 to 2000 K, and what the radiometry tells is as good as its band's
/// limits.
constexpr double u_steepness_assumed = 0.4, u_steepness_of_band = 0.05;

/// The same at the reference temperature, from the recording's radiometry.
double steepness_of(const Radiometry& r, double reference_temperature) {
  const double step = 1e-3;  // relative
  const auto above_dark = [&](double t) { return signal(r, t) - r.dark; };
  return std::log(above_dark(reference_temperature * (1 + step)) /
                  above_dark(reference_temperature * (1 - step))) /
         (2 * step);
}

/// Half of the length's 95 % interval over the length.
double half_width(const Budget& budget) {
  return 0.5 * (budget.length.high - budget.length.low) / budget.length.value;
}

/// Why a length by the reference signal is not given, or an empty text.
std::string too_uncertain(const Measurement& m, const ReferenceRules& rules) {
  if (!m.budget) return {};
  const double half = half_width(*m.budget);
  if (half <= rules.uncertainty) return {};
  return fmt::format(
      "the recording shows a front, but places it only so that the length is uncertain by {:.1f} % "
      "(95 %), where {:.1f} % are allowed ([reference] uncertainty): more frames, less noise, a "
      "calibrated point spread or the alloy's freezing_heat would narrow it",
      100 * half, 100 * rules.uncertainty);
}

/// A level at a quarter of the recording's own brightness: what registers the frames must scale
/// with the scene, or the reference signal would not.
Level registration_level(const Level& level, const Analysis& analysis) {
  const double dark = level.interpolation.dark;
  double highest = dark;
  for (const auto& f : analysis.frames) highest = std::max(highest, f.values.high);
  std::vector<double> bright;
  for (const auto& f : analysis.frames)
    if (f.values.high - dark >= 0.5 * (highest - dark)) bright.push_back(f.values.high);
  Level own = level;
  own.step.reset();
  own.value = dark + 0.25 * (median(bright) - dark);
  return own;
}

}  // namespace

ReferenceSearch parse_reference_search(const std::string& text) {
  if (text == "auto") return ReferenceSearch::automatic;
  if (text == "find") return ReferenceSearch::required;
  if (text == "off") return ReferenceSearch::off;
  throw InputError(
      fmt::format("The reference signal is \"{}\"; expected auto, find or off.", text));
}

Measurement measure_recording(const Recording& recording, const MeasurementRequest& request) {
  const auto& h = recording.header();
  Measurement m;
  Analysis told_level;  // without the reference signal
  Level level = find_level(recording, request.level);
  if (request.dark && !h.radiometry && h.quantity == SignalQuantity::counts)
    level.interpolation = {.logarithmic = true, .dark = *request.dark};
  const bool logarithmic = level.interpolation.logarithmic;
  const double dark = level.interpolation.dark;
  m.analysis = analyse_at(recording, level, request.direction, request.pixel);
  if (!m.analysis.found) return m;
  StackResult stack = stack_frames(recording, m.analysis, request.direction);
  const bool search = request.search != ReferenceSearch::off && logarithmic &&
                      h.quantity != SignalQuantity::temperature;
  if (search) {
    StackResult own = stack_frames(recording,
                                   analyse_at(recording, registration_level(level, m.analysis),
                                              request.direction, request.pixel),
                                   request.direction);
    if (own.stack || !stack.stack) stack = std::move(own);
  }

  if (request.search == ReferenceSearch::off) {
    m.reference.reason = "it was not looked for (reference_signal = \"off\")";
  } else if (!logarithmic) {
    m.reference.reason =
        "the recording does not say what its signal is without light; give it with --dark";
  } else if (h.quantity == SignalQuantity::temperature) {
    m.reference.reason = "the recording holds temperatures that its maker's software has computed";
  } else if (!stack.stack) {
    m.reference.reason = stack.reason;
  } else {
    const double shift = stack.stack->speed * h.integration_time * h.frame_rate;
    const Blur blur = total_blur(request.budget.point_spread, shift);
    const double at = *registration_level(level, m.analysis).value;
    const PlateEdge edge = refined_plate_edge(*stack.stack, dark, at, blur,
                                              find_plate_edge(*stack.stack, dark, at, blur));
    const double temperature =
        request.level.reference_temperature.value_or(default_reference_temperature);
    m.reference = find_reference_signal(
        *stack.stack, dark, blur, edge, request.budget.u_point_spread, request.rules,
        request.budget.seed,
        h.radiometry ? steepness_of(*h.radiometry, temperature) : steepness_of_steel,
        h.radiometry ? u_steepness_of_band : u_steepness_assumed);
    if (m.reference.signature != Signature::none && h.radiometry) {
      Radiometry r = *h.radiometry;
      if (request.level.transmission) r.transmission = *request.level.transmission;
      m.emissivity = implied_emissivity(m.reference, r, temperature);
      if (!m.emissivity->believable()) {
        m.reference.signature = Signature::none;
        m.reference.reason = fmt::format(
            "a front was found at S* = {:.6g}, but it would mean an emissivity of {:.3g} of the "
            "liquid{} at {:.6g} K, outside {} to {}: it is refused",
            m.reference.signal, m.emissivity->liquid,
            m.emissivity->solid ? fmt::format(" and {:.3g} of the solid", *m.emissivity->solid)
                                : std::string(),
            temperature, ImpliedEmissivity::least, ImpliedEmissivity::most);
      }
    }
    const bool told =
        request.level.level || request.level.emissivity || request.level.emissivity_liquid;
    if (m.reference.signature != Signature::none &&
        (!told || request.search == ReferenceSearch::required)) {
      m.reference_used = true;
      told_level = std::move(m.analysis);
      m.analysis = analyse_at(recording, level_of(m.reference, dark, temperature),
                              request.direction, request.pixel);
    }
  }
  const auto with_budget = [&] {
    if (m.analysis.found)
      m.budget = uncertainty_budget(recording, m.analysis, request.pixel,
                                    stack.stack ? &*stack.stack : nullptr, stack.reason,
                                    m.reference_used ? &m.reference : nullptr, request.budget);
  };
  with_budget();
  if (m.reference_used) {
    m.vague = too_uncertain(m, request.rules);
    if (!m.vague.empty()) {
      Measurement by_front = std::move(m);
      m = {};
      m.reference = by_front.reference;
      m.reference.signature = Signature::none;
      m.reference.reason = by_front.vague;
      m.emissivity = by_front.emissivity;
      m.analysis = std::move(told_level);
      if (request.search == ReferenceSearch::automatic) {
        with_budget();
        // A front that is placed vaguely still is the front: it gives way only to what is known
        // better. What a mere contrast outlines is not the pool, so its interval counts for
        // nothing.
        if (!m.budget || m.analysis.level.kind == LevelKind::contrast ||
            half_width(*m.budget) > half_width(*by_front.budget))
          m = std::move(by_front);
      }
    }
  }
  if (request.search == ReferenceSearch::required && !m.reference_used) {
    m.analysis.found = false;
    m.budget.reset();
    m.analysis.reason =
        "The reference signal was not found in the recording: " + m.reference.reason + ".";
    return m;
  }
  return m;
}

}  // namespace meltproof::imaging
