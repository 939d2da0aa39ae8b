// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/report_parameters.hpp"

#include <cmath>
#include <optional>
#include <tuple>

#include <fmt/format.h>

namespace meltproof::imaging {

using nlohmann::json;

namespace {

/// The first of the two that is there.
json row(const char* name, const char* unit, const std::optional<double>& given,
         const std::optional<double>& of_file) {
  const auto& value = given ? given : of_file;
  return {{"name", name},
          {"value", value ? json(*value) : json(nullptr)},
          {"unit", unit},
          {"source", given     ? "given"
                     : of_file ? "file"
                               : "unknown"}};
}

}  // namespace

json parameters_json(const RecordingHeader& h, const Settings& s, const PixelSize& pixel,
                     const PointSpread& spread) {
  const auto& r = h.radiometry;
  const auto positive = [](double v) { return v > 0 ? std::optional(v) : std::nullopt; };
  const auto of = [&](double Radiometry::*member) {
    return r ? std::optional((*r).*member) : std::nullopt;
  };
  json rows = json::array();
  const std::optional<double> none;
  auto reference = row("reference temperature", "K", s.reference_temperature, none);
  if (!s.reference_temperature && (r || h.quantity == SignalQuantity::temperature) && !s.level) {
    reference["value"] = default_reference_temperature;
    reference["source"] = "default";
  }
  rows.push_back(reference);
  rows.push_back(row("freezing heat", "1", s.rules.freezing_heat, none));
  if (s.rules.freezing_heat) rows.back()["u"] = *s.rules.freezing_heat * s.rules.u_freezing_heat;
  rows.push_back(row("level", h.unit.c_str(), s.level, none));
  rows.push_back(row("emissivity of solid metal", "1", s.emissivity, of(&Radiometry::emissivity)));
  rows.push_back(row("emissivity of liquid metal", "1", s.emissivity_liquid, h.emissivity_liquid));
  rows.push_back(
      row("transmission of the windows", "1", s.transmission, of(&Radiometry::transmission)));
  rows.push_back(row("band, lower limit", "m", none, of(&Radiometry::band_lower)));
  rows.push_back(row("band, upper limit", "m", none, of(&Radiometry::band_upper)));
  if (!s.spectral_response.empty())
    rows.push_back({{"name", "spectral response"},
                    {"value", s.spectral_response.filename().string()},
                    {"unit", "table"},
                    {"source", "given"}});
  if (!s.window_spectrum.empty())
    rows.push_back({{"name", "window spectrum"},
                    {"value", s.window_spectrum.filename().string()},
                    {"unit", "table"},
                    {"source", "given"}});
  rows.push_back(row("gain", "m2 sr W-1 s-1", none, of(&Radiometry::gain)));
  rows.push_back(row("signal without light", "count", s.dark, of(&Radiometry::dark)));
  rows.push_back(row("ambient temperature", "K", none, of(&Radiometry::ambient_temperature)));
  rows.push_back(row("window temperature", "K", none,
                     r && r->window_emission ? positive(r->window_temperature) : std::nullopt));
  rows.push_back(row("frame rate", "Hz", s.frame_rate, positive(h.frame_rate)));
  if (s.frame_rate && h.frame_rate > 0) rows.back()["source"] = "given";
  rows.push_back(row("integration time", "s", none, positive(h.integration_time)));
  rows.push_back(row("temperature of one count", "K", s.kelvin_per_count, none));
  rows.push_back(row("scan speed", "m s-1", s.scan_speed, none));
  rows.push_back({{"name", "point spread, sigma"},
                  {"value", spread.sigma},
                  {"u", spread.u},
                  {"unit", "px"},
                  {"source", spread.source}});
  for (const auto& [name, size, u] : {std::tuple{"pixel size along x", pixel.x, pixel.u_x},
                                      {"pixel size along y", pixel.y, pixel.u_y}})
    rows.push_back({{"name", name},
                    {"value", pixel.known() ? json(size * 1e6) : json(nullptr)},
                    {"u", pixel.known() ? json(u * 1e6) : json(nullptr)},
                    {"unit", "um"},
                    {"source", !pixel.known()          ? "unknown"
                               : s.calibration.empty() ? "file"
                                                       : "calibration"}});
  return rows;
}

std::string tail_table(const Measurement& m, const PixelSize& pixel) {
  const auto& model = m.reference.model;
  if (model.profile.empty()) return {};
  const bool metric = pixel.known();
  const double scale = metric ? (m.analysis.along_x ? pixel.x : pixel.y) * 1e6 : 1;
  std::string table = fmt::format(
      "distance from the front [{}],ln S seen [1],u [1],ln S model with blur [1],ln S model [1]\n",
      metric ? "um" : "px");
  for (const auto& t : model.profile)
    table += fmt::format("{:.6g},{:.6g},{:.4g},{:.6g},{:.6g}\n", (t.position - model.front) * scale,
                         t.seen, t.u, t.blurred, t.sharp);
  return table;
}

}  // namespace meltproof::imaging
