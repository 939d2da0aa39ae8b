// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/units.hpp"
#include "imaging/meltpool/report_budget.hpp"

namespace meltproof::imaging {
namespace {

using nlohmann::json;

/// Standard deviation of the length from where the edge falls between pixels, px: what Rosenthal's
/// pool shows at random places of the grid (contour_test.cpp: 0.3 % of 14.9 px, with a bias of up
/// to 0.5 %).
constexpr double u_contour = 0.1;

json or_null(double value) {
  return value > 0 && std::isfinite(value) ? json(value) : json(nullptr);
}

double scale_of(const Analysis& a) { return a.unit == "m" ? 1e6 : 1; }
std::string unit_of(const Analysis& a) {
  return a.unit == "m" ? std::string("um") : std::string("px");
}

/// Mean, spread and standard uncertainty of a length, with what it is made of.
json length_budget(const Series& s, const Analysis& a, double pixel, double u_pixel) {
  const double scale = scale_of(a), one = a.unit == "m" ? pixel * 1e6 : 1;
  const double scatter = s.uncertainty_of_mean() * scale, contour = u_contour * one;
  const double calibration = pixel > 0 ? s.mean * scale * u_pixel / pixel : 0;
  return {{"mean", s.mean * scale},
          {"sd", s.deviation * scale},
          {"n", s.n},
          {"n_effective", s.effective},
          {"u_mean", std::sqrt(scatter * scatter + contour * contour + calibration * calibration)},
          {"u_parts",
           {{"scatter between frames", scatter},
            {"edge between pixels", contour},
            {"pixel size", calibration}}}};
}

std::string status_of(const FrameResult& f) {
  if (!f.found) return "no pool";
  if (f.disturbance == Disturbance::displaced) return "not with the beam";
  if (f.disturbance == Disturbance::enlarged) return "disturbed";
  if (f.region.at_border()) return "at the border";
  return f.complete ? "complete" : "front not seen";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : std::string();
}

}  // namespace

json summary(const Recording& recording, const Measurement& m, const PixelSize& pixel,
             const Settings& settings, const Provenance& provenance) {
  const auto& h = recording.header();
  const Analysis& a = m.analysis;
  json j = {{"recording", h.path.filename().string()},
            {"format", h.format},
            {"sha256", h.sha256},
            {"frames", h.frames},
            {"frames_lost", h.frames_lost},
            {"width", h.width},
            {"height", h.height},
            {"frame_rate", or_null(h.frame_rate)},
            {"integration_time_s", or_null(h.integration_time)},
            {"quantity", quantity_name(h.quantity)},
            {"unit", h.unit},
            {"synthetic", h.synthetic.empty() ? json(nullptr) : json(h.synthetic)},
            {"calibration_of_file", h.calibration},
            {"notes", h.notes},
            {"melt_pool_found", a.found},
            {"reason", a.found ? json(nullptr) : json(a.reason)},
            {"scan_direction", settings.scan_direction}};
  if (!std::isfinite(h.saturation))
    j["saturation"] = nullptr;
  else
    j["saturation"] = h.saturation;
  j["level"] = {{"value", a.level.value ? json(*a.level.value) : json(nullptr)},
                {"unit", h.unit},
                {"kind", level_kind_name(a.level.kind)},
                {"how", a.level.how},
                {"reference_temperature_K", or_null(a.level.reference_temperature)},
                {"interpolation",
                 a.level.interpolation.logarithmic ? "logarithm of signal above dark" : "linear"}};
  if (pixel.known())
    j["pixel_size_um"] = {{"x", pixel.x * 1e6},
                          {"y", pixel.y * 1e6},
                          {"u_x", pixel.u_x * 1e6},
                          {"u_y", pixel.u_y * 1e6}};
  j["reference_signal"] = reference_json(m, h);
  if (!a.found) {
    j["provenance"] = provenance.json();
    return j;
  }
  const auto disturbed = [&](Disturbance d) {
    return std::count_if(a.frames.begin(), a.frames.end(),
                         [d](const FrameResult& f) { return f.disturbance == d; });
  };
  const std::string unit = unit_of(a);
  const double along = a.along_x ? pixel.x : pixel.y, across = a.along_x ? pixel.y : pixel.x;
  const double u_along = a.along_x ? pixel.u_x : pixel.u_y,
               u_across = a.along_x ? pixel.u_y : pixel.u_x;
  j["length_" + unit] = length_budget(a.length, a, along, u_along);
  j["depth_" + unit] = length_budget(a.depth, a, across, u_across);
  j["area_" + unit + "2"] = {{"mean", a.area.mean * scale_of(a) * scale_of(a)},
                             {"sd", a.area.deviation * scale_of(a) * scale_of(a)},
                             {"n", a.area.n}};
  j["tracking"] = {{"passages", a.passages},
                   {"frames_not_with_the_beam", disturbed(Disturbance::displaced)},
                   {"frames_disturbed", disturbed(Disturbance::enlarged)},
                   {"frames_with_another_region", a.replaced}};
  j["frames_used"] = a.only_incomplete
                         ? "all with a pool: in none is it whole (see status in frames.csv), "
                           "so lengths are lower bounds"
                         : "those whose pool is whole (status complete in frames.csv)";
  constexpr std::size_t enough_for_a_trend = 4;
  if (a.length.n >= enough_for_a_trend)
    j["steady"] = {
        {"mann_kendall_z", a.length.trend},
        {"steady", a.length.steady()},
        {"meaning", "the length neither rises nor falls over the frames used, at the 5 % level"}};
  j["uncertainty_leaves_out"] =
      "the level itself, point spread, motion during the integration time, non-uniformity of the "
      "pixels, and pixels that the edge of the plate cuts";
  if (a.speed && h.frame_rate > 0) {
    j[a.unit == "m" ? "speed_m_s" : "speed_px_s"] = *a.speed;
    if (settings.scan_speed && a.unit == "m")
      j["speed_relative_error"] = *a.speed / *settings.scan_speed - 1;
  }
  if (m.budget) j["budget"] = budget_json(*m.budget, a);
  j["shown_frame"] = a.shown;
  j["provenance"] = provenance.json();
  return j;
}

std::string frames_table(const Recording& recording, const Analysis& a) {
  const auto& h = recording.header();
  const std::string u = unit_of(a);
  const double s = scale_of(a);
  const bool counts = !a.frames.empty() && a.frames[0].counts;
  std::string table = fmt::format("frame [1],time [s],min [{0}],max [{0}],mean [{0}],", h.unit);
  if (counts) table += "stored min [count],stored max [count],stored mean [count],";
  table += fmt::format(
      "saturated [px],under range [px],dead [px],found [1],onset [{0}],end [{0}],length "
      "[{0}],depth [{0}],area "
      "[{0}^2],"
      "centroid x [px],centroid y [px],orientation [deg],pixels [px],status [text],speed check "
      "[px]\n",
      u);
  for (const auto& f : a.frames) {
    table += fmt::format(
        "{},{},{},{},{},", f.index,
        h.frame_rate > 0 || f.time > 0 ? shortest(std::round(f.time * 1e9) / 1e9) : "",
        number(f.values.low), number(f.values.high), fmt::format("{:.9g}", f.values.mean));
    if (counts)
      table += fmt::format("{},{},{:.10g},", f.counts->low, f.counts->high, f.counts->mean);
    table += fmt::format("{},{},{},{},", f.saturated, f.under_range, f.dead, f.found ? 1 : 0);
    if (f.found)
      table += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.5f},{:.5f},{:.3f},{},{},{}\n",
                           f.onset * s, f.end * s, f.length * s, f.depth * s, f.area * s * s,
                           f.region.centroid.x, f.region.centroid.y,
                           f.orientation * 180 / std::numbers::pi, f.region.pixels, status_of(f),
                           f.speed_check ? fmt::format("{:.3f}", *f.speed_check) : "");
    else
      table += ",,,,,,,,,no pool,\n";
  }
  return table;
}

std::string spoken(const Recording& recording, const Measurement& m) {
  const Analysis& a = m.analysis;
  const auto& h = recording.header();
  std::string text =
      fmt::format("{}: {}, {} frame{} of {} x {} px, {}", h.path.filename().string(), h.format,
                  h.frames, h.frames == 1 ? "" : "s", h.width, h.height, quantity_name(h.quantity));
  if (h.frame_rate > 0) text += fmt::format(", {:.6g} Hz", h.frame_rate);
  if (h.integration_time > 0)
    text += fmt::format(", integration {:.4g} us", h.integration_time * 1e6);
  text += h.synthetic.empty() ? ".\n" : ". SYNTHETIC: " + h.synthetic + "\n";
  if (h.frames_lost > 0)
    text += fmt::format(
        "The file ends early: at least {} frame{} lost, results are for the {} whole one{}.\n",
        h.frames_lost, h.frames_lost == 1 ? " is" : "s are", h.frames, h.frames == 1 ? "" : "s");
  for (const auto& note : h.notes) text += "Note: " + note + "\n";
  if (!a.found) return text + "No melt pool: " + a.reason + "\n";
  const std::string u = unit_of(a);
  const double s = scale_of(a);
  text += fmt::format("Melt pool: length {:.4g} {}, {} {:.4g} {}, area {:.4g} {}^2",
                      a.length.mean * s, u, a.along_x ? "depth" : "extent across", a.depth.mean * s,
                      u, a.area.mean * s * s, u);
  if (a.length.n > 1)
    text += fmt::format(" (mean of {} frames, standard deviation of the length {:.3g} {})",
                        a.length.n, a.length.deviation * s, u);
  text += fmt::format(".\nLevel {:.6g} {}: {}.\n", *a.level.value, h.unit, a.level.how);
  text += m.reference_used
              ? "This level is independent of emissivity and transmission.\n" + caution(m)
              : "Reference signal in the recording itself: none used, because " +
                    m.reference.reason + ".\nThis level is not independent of the emissivity.\n";
  if (m.emissivity && m.reference_used)
    text += fmt::format(
        "Implied emissivity: {:.3g} liquid{}.\n", m.emissivity->liquid,
        m.emissivity->solid ? fmt::format(", {:.3g} solid", *m.emissivity->solid) : std::string());
  if (m.budget) text += budget_text(*m.budget, a);
  const std::string advice = would_narrow(m);
  if (!advice.empty()) text += advice + "\n";
  if (a.only_incomplete)
    text +=
        "In no frame is the pool whole: it touches the border of the image or its front was not "
        "seen, so the length is a lower bound.\n";
  if (a.unit == "px") text += "Lengths are in pixels: give --calibration for micrometres.\n";
  return text;
}

}  // namespace meltproof::imaging
