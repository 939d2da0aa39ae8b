// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/report_budget.hpp"

#include <fmt/format.h>

namespace meltproof::imaging {

using nlohmann::json;

namespace {

double scale_of(const Analysis& a) { return a.unit == "m" ? 1e6 : 1; }
std::string unit_of(const Analysis& a) {
  return a.unit == "m" ? std::string("um") : std::string("px");
}

json estimate_json(const Estimate& e, double scale) {
  return {{"value", e.value * scale},
          {"u", e.u * scale},
          {"interval_95", {e.low * scale, e.high * scale}}};
}

}  // namespace

std::string would_narrow(const Measurement& m) {
  if (m.reference_used || !m.budget) return {};
  const std::string known =
      "an emissivity that was measured, with its own uncertainty ([budget] u_emissivity)";
  if (m.analysis.level.kind == LevelKind::temperature)
    return "Most of the interval is the emissivity that the camera's software has used: it would "
           "be "
           "narrower with a recording exported as counts, in which the phase boundary can be "
           "looked for, or with " +
           known + ".";
  if (m.analysis.level.kind != LevelKind::radiometry) return {};
  return "Most of the interval is what is not known of the emissivity. It would be narrower where "
         "the recording itself shows the phase boundary, for which the alloy's freezing heat "
         "(--freezing-heat; MATERIAL) and a calibrated point spread (--calibration; CALIBRATION) "
         "help, with a signal at the boundary that is known (--level; LEVEL), or with " +
         known + ".";
}

std::string caution(const Measurement& m) {
  if (m.vague.empty()) return {};
  return "Caution: " + m.vague +
         ". It is used all the same, because without it the length would be "
         "known even less.\n";
}

json reference_json(const Measurement& m, const RecordingHeader& h) {
  const ReferenceSignal& r = m.reference;
  json j = {{"found", r.signature != Signature::none},
            {"used", m.reference_used},
            {"signature", signature_name(r.signature)},
            {"reason", m.reference_used ? json(nullptr) : json(r.reason)},
            {"vague", m.vague.empty() ? json(nullptr) : json(m.vague)},
            {"emissivity_independent", m.emissivity_independent()}};
  const std::string advice = would_narrow(m);
  j["would_narrow"] = advice.empty() ? json(nullptr) : json(advice);
  if (r.signature != Signature::none) {
    j["signal"] = r.signal;
    j["unit"] = h.unit;
    j["u_relative"] = r.relative_u;
    j["solid_signal"] = r.solid_signal > 0 ? json(r.solid_signal) : json(nullptr);
    j["blurred_signal"] = r.blurred_signal;
    j["prominence"] = r.model.rise;
    j["u_prominence"] = r.model.u_rise;
    j["lines"] = r.model.lines_with_front;
    j["lines_examined"] = r.model.lines;
    if (!m.reference_used)
      j["reason"] = "a level or an emissivity was given, which is used instead";
  }
  if (m.emissivity)
    j["implied_emissivity"] = {
        {"liquid", m.emissivity->liquid},
        {"solid", m.emissivity->solid ? json(*m.emissivity->solid) : json(nullptr)},
        {"believable", m.emissivity->believable()}};
  return j;
}

json budget_json(const Budget& b, const Analysis& a) {
  const double s = scale_of(a);
  const std::string u = unit_of(a);
  json rows = json::array();
  for (const auto& row : b.rows)
    rows.push_back({{"input", row.name},
                    {"type", row.type},
                    {"u_length_" + u, row.u_length * s},
                    {"u_depth_" + u, row.u_depth * s},
                    {"correction_length_" + u, row.correction_length * s},
                    {"correction_depth_" + u, row.correction_depth * s},
                    {"how", row.how}});
  json j = {{"length_" + u, estimate_json(b.length, s)},
            {"depth_" + u, estimate_json(b.depth, s)},
            {"blur_and_noise_corrected", b.corrected},
            {"not_corrected_because", b.corrected ? json(nullptr) : json(b.reason)},
            {"inputs", rows}};
  if (b.corrected) j["blur_px"] = {{"along", b.blur_along}, {"across", b.blur_across}};
  if (b.plate_edge) j["plate_border_px"] = b.plate_row;
  return j;
}

std::string budget_text(const Budget& b, const Analysis& a) {
  const double s = scale_of(a);
  const std::string u = unit_of(a);
  std::string text;
  if (b.corrected)
    text += fmt::format(
        "Without blur and noise: length {:.4g} {} ({:.4g} to {:.4g}, 95 %), {} {:.4g} {} ({:.4g} "
        "to "
        "{:.4g}, 95 %).\n",
        b.length.value * s, u, b.length.low * s, b.length.high * s,
        a.along_x ? "depth" : "extent across", b.depth.value * s, u, b.depth.low * s,
        b.depth.high * s);
  else
    text += fmt::format(
        "Blur and noise are not corrected, because {}; length {:.4g} to {:.4g} {} (95 %) without "
        "them.\n",
        b.reason, b.length.low * s, b.length.high * s, u);
  text += fmt::format("  {:<38} {:>4} {:>12} {:>12}\n", "standard uncertainty, " + u, "type",
                      "length", "depth");
  for (const auto& row : b.rows)
    text += fmt::format("  {:<38} {:>4} {:>12.3g} {:>12.3g}\n", row.name, row.type,
                        row.u_length * s, row.u_depth * s);
  return text;
}

}  // namespace meltproof::imaging
