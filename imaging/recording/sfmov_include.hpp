// SPDX-License-Identifier: GPL-3.0-or-later
// The text file beside an SFMOV: camera settings and the calibration to radiance and temperature.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace meltproof::imaging {

/// Lines "key value" up to a line DATA or saf_padding, by key. Of a key that comes twice the first
/// counts.
std::map<std::string, std::string> sfmov_keys(std::string_view text);

/// The calibration of a camera preset. Counts to radiance, W cm-2 sr-1, and radiance to apparent
/// temperature, Celsius, are polynomials; the second one may instead be
///   T = B / ln(R / L + F), K.
struct SfmovCalibration {
  std::array<double, 7> radiance{};                   ///< nfcC0 to nfcC6
  std::array<double, 7> celsius{};                    ///< nfcTempC0 to nfcTempC6; all 0: not there
  double planck_r = 0, planck_b = 0, planck_f = 1;    ///< nfcR, nfcB, nfcF; 0: not there
  std::optional<double> lowest_count, highest_count;  ///< between which it holds

  /// K of a black body that gives `counts`; NaN where the formula has no answer. Counts outside the
  /// limits take the limit's temperature, because a polynomial means nothing there.
  double temperature(double counts) const;
};

/// What an .inc file says about preset 0.
struct SfmovInclude {
  double frame_rate = 0;                        ///< Hz; 0: not there
  double integration_time = 0;                  ///< s; 0: not there
  std::optional<SfmovCalibration> calibration;  ///< if there is one that grows with the counts
  std::map<std::string, double> constants;      ///< band limits and such, by name with unit
  bool more_presets = false;                    ///< whether presets other than 0 are in it
};

/// Reads the text of an .inc file. Values that are no numbers count as missing.
SfmovInclude parse_sfmov_include(std::string_view text);

}  // namespace meltproof::imaging
