// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/level.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace meltproof::imaging {
namespace {

/// The middle of `v`, which is reordered.
float median(std::vector<float>& v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

struct Threshold {
  double level = 0, bright_mean = 0;
};

/// Otsu's threshold over 256 classes between `low` and `high`; what is beyond counts to the last
/// class.
Threshold otsu(const std::vector<float>& v, double low, double high) {
  constexpr std::size_t classes = 256;
  std::array<double, classes> count{}, sum{};
  const double scale = static_cast<double>(classes) / (high - low);
  for (const float value : v) {
    const double clipped = std::clamp(static_cast<double>(value), low, high);
    const auto i = std::min(static_cast<std::size_t>((clipped - low) * scale), classes - 1);
    count[i] += 1;
    sum[i] += clipped;
  }
  double all = 0, total = 0, dark_count = 0, dark_sum = 0, best = 0, first = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    all += count[i];
    total += sum[i];
  }
  Threshold result;
  for (std::size_t i = 0; i + 1 < classes; ++i) {
    dark_count += count[i];
    dark_sum += sum[i];
    const double bright_count = all - dark_count;
    if (dark_count == 0 || bright_count == 0) continue;
    const double difference = dark_sum / dark_count - (total - dark_sum) / bright_count;
    const double between = dark_count * bright_count * difference * difference;
    const double threshold = low + static_cast<double>(i + 1) / scale;
    if (between > best * (1 + 1e-12)) {
      best = between;
      first = threshold;
      result.bright_mean = (total - dark_sum) / bright_count;
    }
    // Empty classes between bright and dark make a plateau, whose middle is meant.
    if (between >= best * (1 - 1e-12)) result.level = 0.5 * (first + threshold);
  }
  return result;
}

Level at_reference_temperature(const RecordingHeader& header, const LevelRequest& request) {
  Level level;
  level.reference_temperature =
      request.reference_temperature.value_or(default_reference_temperature);
  const char* const origin = request.reference_temperature
                                 ? "given"
                                 : "the liquidus of 316L, taken because none was given";
  if (header.quantity == SignalQuantity::temperature) {
    if (request.emissivity || request.emissivity_liquid || request.transmission)
      throw InputError(
          fmt::format("{}: an emissivity or a transmission was given, but the file holds "
                      "temperatures, in which the "
                      "camera's software has used its own; leave them out or export counts.",
                      header.path.string()));
    level.kind = LevelKind::temperature;
    level.value = level.reference_temperature;
    level.how =
        fmt::format("the reference temperature {:.6g} K ({})", level.reference_temperature, origin);
    level.interpolation = {.logarithmic = true};
    return level;
  }
  Radiometry r = *header.radiometry;
  if (request.emissivity) r.emissivity = *request.emissivity;
  if (request.transmission) r.transmission = *request.transmission;
  const double liquid =
      request.emissivity_liquid.value_or(header.emissivity_liquid.value_or(r.emissivity));
  level.kind = LevelKind::radiometry;
  level.emissivity = std::min(liquid, r.emissivity);
  level.value = signal(r, level.reference_temperature);
  level.interpolation = {.logarithmic = true, .dark = signal(r, 0)};
  level.how = fmt::format(
      "the signal of a surface at {:.6g} K ({}) with emissivity {:.3g} behind a transmission of "
      "{:.4g} "
      "between {:.3g} and {:.3g} um; it is not independent of the emissivity",
      level.reference_temperature, origin, r.emissivity, r.transmission, r.band_lower * 1e6,
      r.band_upper * 1e6);
  if (liquid < r.emissivity) {
    level.step = EmissivityStep{level.interpolation.dark,
                                signal(r, level.reference_temperature, liquid), *level.value};
    level.value = level.step->level();
    level.how = fmt::format(
        "the solidification front is where the signal steps from that of liquid to that of solid "
        "metal at {:.6g} K ({}), "
        "emissivities {:.3g} and {:.3g}, transmission {:.4g}, {:.3g} to {:.3g} um; where no step "
        "is resolved, the signal "
        "halfway between; it is not independent of the emissivity",
        level.reference_temperature, origin, liquid, r.emissivity, r.transmission,
        r.band_lower * 1e6, r.band_upper * 1e6);
  }
  if (*level.value >= header.saturation) {
    level.reason = fmt::format(
        "The signal at {:.6g} K would be {:.6g} {}, which is beyond saturation ({:.6g}): the "
        "edge of a melt pool cannot be seen in this recording.",
        level.reference_temperature, *level.value, header.unit, header.saturation);
    level.value.reset();
  }
  return level;
}

Level by_contrast(const Recording& recording) {
  const auto& header = recording.header();
  RegionFinder finder(header.width, header.height, {});
  std::vector<float> levels;
  Contrast closest;
  std::size_t closest_frame = 0;
  Frame frame;
  Progress progress("search", static_cast<double>(header.frames));
  for (std::size_t i = 0; i < header.frames; ++i) {
    recording.read(i, frame);
    const auto c = contrast(frame, finder);
    if (c.passed) levels.push_back(static_cast<float>(c.level));
    if (i == 0 || c.prominence > closest.prominence) {
      closest = c;
      closest_frame = i;
    }
    progress.update(static_cast<double>(i + 1));
  }
  Level level;
  level.kind = LevelKind::contrast;
  if (levels.empty()) {
    level.reason = fmt::format(
        "No frame of the recording shows a melt pool: in frame {}, which comes closest, {}.",
        closest_frame, closest.reason);
    return level;
  }
  const std::size_t passed = levels.size();
  level.value = static_cast<double>(median(levels));
  level.how = fmt::format(
      "Otsu's threshold between a bright region and its background, the median of {} frame{}: a "
      "contour of "
      "brightness, not of a phase boundary, because the recording has no calibration and no level "
      "was given",
      passed, passed == 1 ? "" : "s");
  return level;
}

}  // namespace

std::string level_kind_name(LevelKind kind) {
  switch (kind) {
    case LevelKind::given:
      return "given";
    case LevelKind::temperature:
      return "reference temperature";
    case LevelKind::recording:
      return "reference signal of the recording";
    case LevelKind::radiometry:
      return "reference temperature by radiometry";
    case LevelKind::contrast:
      return "contrast";
  }
  return "";
}

Contrast contrast(const Frame& frame, RegionFinder& finder, const ContrastRule& rule) {
  Contrast c;
  std::vector<float> good;
  good.reserve(frame.values.size());
  for (std::size_t i = 0; i < frame.values.size(); ++i)
    if (frame.status[i] != PixelStatus::dead) good.push_back(frame.values[i]);
  if (good.size() < 4 * smallest_pool) {
    c.reason = fmt::format("only {} pixels are alive", good.size());
    return c;
  }
  c.background = static_cast<double>(median(good));
  std::vector<float> deviation(good.size());
  std::transform(good.begin(), good.end(), deviation.begin(),
                 [b = static_cast<float>(c.background)](float v) { return std::abs(v - b); });
  c.noise = std::max(1.4826 * static_cast<double>(median(deviation)), 0.5);
  // The few hottest pixels may be defects: as many as are too few for a pool do not stretch the
  // scale.
  const auto top = good.end() - static_cast<std::ptrdiff_t>(smallest_pool);
  std::nth_element(good.begin(), top, good.end());
  const double high = static_cast<double>(*top);
  const double low = static_cast<double>(*std::min_element(good.begin(), top + 1));
  if (!(high > low)) {
    c.reason = fmt::format("all pixels have the same value, {:.6g}", low);
    return c;
  }
  const auto threshold = otsu(good, low, high);
  c.level = threshold.level;
  c.prominence = (c.level - c.background) / c.noise;
  c.contrast = threshold.bright_mean / std::max(c.background, 0.5);
  if (c.prominence < rule.prominence) {
    c.reason = fmt::format(
        "the threshold that best parts bright from dark pixels, {:.6g}, lies {:.1f} standard "
        "deviations of the "
        "background ({:.3g}) from its median ({:.6g}), where a melt pool stands out by at least "
        "{:.0f}",
        c.level, c.prominence, c.noise, c.background, rule.prominence);
    return c;
  }
  if (c.contrast < rule.contrast) {
    c.reason = fmt::format(
        "the bright pixels have {:.3g} times the signal of the background, where molten metal has "
        "at least {:.0f} times",
        c.contrast, rule.contrast);
    return c;
  }
  const auto region = finder.largest(frame.values, c.level);
  if (!region || region->pixels < smallest_pool) {
    c.reason = fmt::format("the largest bright region has {} pixels, where at least {} are needed",
                           region ? region->pixels : 0, smallest_pool);
    return c;
  }
  if (region->compactness() < rule.compactness) {
    c.reason = fmt::format(
        "the bright region is ragged (compactness {:.2f}, where an ellipse has 1 and at least {} "
        "is needed)",
        region->compactness(), rule.compactness);
    return c;
  }
  c.passed = true;
  return c;
}

Level find_level(const Recording& recording, const LevelRequest& request) {
  const auto& header = recording.header();
  if (request.level) {
    if (request.reference_temperature || header.quantity == SignalQuantity::temperature)
      throw InputError(fmt::format(
          "{}: a level of {:.6g} was given {}; give a reference temperature alone instead.",
          header.path.string(), *request.level,
          request.reference_temperature ? "together with a reference temperature"
                                        : "in counts, but the recording holds temperatures"));
    Level level;
    level.kind = LevelKind::given;
    level.value = request.level;
    level.how = fmt::format("given, {:.6g} {}", *request.level, header.unit);
    if (header.radiometry)
      level.interpolation = {.logarithmic = true, .dark = signal(*header.radiometry, 0)};
    return level;
  }
  if (header.quantity == SignalQuantity::temperature || header.radiometry)
    return at_reference_temperature(header, request);
  if (request.reference_temperature || request.emissivity || request.emissivity_liquid ||
      request.transmission)
    throw InputError(
        fmt::format("{}: a temperature, emissivity or transmission was given, but the file holds "
                    "counts without the camera's band "
                    "and gain, so a temperature has no signal; give the level in counts, or a "
                    "scale of kelvin per count.",
                    header.path.string()));
  return by_contrast(recording);
}

Level raised(Level level, double shift) {
  const double dark = level.interpolation.dark, factor = std::exp(shift);
  level.value = dark + factor * (*level.value - dark);
  if (level.step) {
    level.step->liquid = level.step->dark + factor * (level.step->liquid - level.step->dark);
    level.step->solid = level.step->dark + factor * (level.step->solid - level.step->dark);
  }
  return level;
}

std::string below_level_reason(const RecordingHeader& header, const Level& level, double highest,
                               std::size_t frame) {
  if (header.quantity == SignalQuantity::temperature)
    return fmt::format(
        "The hottest pixel of the recording is at {:.1f} degC ({:.1f} K, frame {}), {:.0f} K below "
        "the "
        "reference temperature of {:.6g} K: nothing in it is molten.",
        highest - 273.15, highest, frame, *level.value - highest, *level.value);
  return fmt::format(
      "The brightest pixel of the recording has {:.6g} {} (frame {}), below the level of {:.6g} "
      "({}).",
      highest, header.unit, frame, *level.value, level.how);
}

}  // namespace meltproof::imaging
