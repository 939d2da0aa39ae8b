// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/sfmov_include.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace meltproof::imaging {
namespace {

constexpr double celsius_zero = 273.15;

/// The number of a key with or without the suffix of preset 0, if it is there and finite.
std::optional<double> number(const std::map<std::string, std::string>& keys,
                             const std::string& name) {
  for (const auto& key : {name + "_0", name}) {
    const auto found = keys.find(key);
    if (found == keys.end()) continue;
    double value = 0;
    const char* begin = found->second.data();
    const auto result = std::from_chars(begin, begin + found->second.size(), value);
    if (result.ec == std::errc() && std::isfinite(value)) return value;
  }
  return std::nullopt;
}

std::array<double, 7> coefficients(const std::map<std::string, std::string>& keys,
                                   const std::string& name) {
  std::array<double, 7> c{};
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] = number(keys, name + std::to_string(i)).value_or(0);
  return c;
}

/// Whether a polynomial depends on its argument at all.
bool is_there(const std::array<double, 7>& c) {
  return std::any_of(c.begin() + 1, c.end(), [](double x) { return x != 0; });
}

double polynomial(const std::array<double, 7>& c, double x) {
  double sum = 0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

}  // namespace

std::map<std::string, std::string> sfmov_keys(std::string_view text) {
  std::map<std::string, std::string> keys;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    auto line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.starts_with("DATA") || line.starts_with("saf_padding")) break;
    const auto gap = line.find_first_of(" \t");
    if (gap == 0 || gap == std::string_view::npos) continue;
    const auto value = line.find_first_not_of(" \t", gap);
    if (value == std::string_view::npos) continue;
    auto content = line.substr(value);
    content = content.substr(0, content.find_last_not_of(" \t") + 1);
    keys.emplace(line.substr(0, gap), content);
  }
  return keys;
}

double SfmovCalibration::temperature(double counts) const {
  if (highest_count) counts = std::min(counts, *highest_count);
  if (lowest_count) counts = std::max(counts, *lowest_count);
  const double l = polynomial(radiance, counts);
  if (is_there(celsius)) return polynomial(celsius, l) + celsius_zero;
  const double argument = planck_r / l + planck_f;
  return l > 0 && argument > 1 ? planck_b / std::log(argument)
                               : std::numeric_limits<double>::quiet_NaN();
}

SfmovInclude parse_sfmov_include(std::string_view text) {
  const auto keys = sfmov_keys(text);
  SfmovInclude include;
  include.frame_rate = std::max(0.0, number(keys, "FRate").value_or(0));
  include.integration_time = std::max(0.0, number(keys, "ITime").value_or(0)) / 1000;
  include.more_presets = keys.contains("FRate_1") || keys.contains("ITime_1");
  for (const auto& [key, name] : {std::pair{"nfcBandpassLow", "band_lower_um"},
                                  {"nfcBandpassHigh", "band_upper_um"},
                                  {"nfcMinTemp", "calibrated_from_C"},
                                  {"nfcMaxTemp", "calibrated_to_C"},
                                  {"nfcMinCounts", "calibrated_from_count"},
                                  {"nfcMaxCounts", "calibrated_to_count"}})
    if (const auto value = number(keys, key)) include.constants[name] = *value;

  SfmovCalibration c;
  c.radiance = coefficients(keys, "nfcC");
  c.celsius = coefficients(keys, "nfcTempC");
  c.planck_r = number(keys, "nfcR").value_or(0);
  c.planck_b = number(keys, "nfcB").value_or(0);
  c.planck_f = number(keys, "nfcF").value_or(1);
  c.lowest_count = number(keys, "nfcMinCounts");
  c.highest_count = number(keys, "nfcMaxCounts");
  const bool planck = c.planck_r > 0 && c.planck_b > 0;
  const bool range = !c.lowest_count || !c.highest_count || *c.lowest_count < *c.highest_count;
  if (!is_there(c.radiance) || !(is_there(c.celsius) || planck) || !range) return include;
  const double low = c.temperature(c.lowest_count.value_or(0));
  const double high = c.temperature(c.highest_count.value_or(65535));
  if (!c.highest_count || high > low) include.calibration = c;
  return include;
}

}  // namespace meltproof::imaging
