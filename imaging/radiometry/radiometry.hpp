// SPDX-License-Identifier: GPL-3.0-or-later
// From temperature to camera signal and back: Planck's law over the camera's band, windows,
// emissivity.
#pragma once

#include <memory>
#include <vector>

#include "imaging/radiometry/spectrum.hpp"

namespace meltproof::imaging {

/// Radiance of a black body within a wavelength band with flat response,
///   L(T) = integral from lower to upper of 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1) d
///   lambda,
/// by adaptive quadrature to a relative 1e-12.
/// @param lower,upper band limits, m, 0 < lower < upper; @param temperature K; zero or less gives
/// 0.
/// @return W m-2 sr-1. @throws InputError if the band is empty or negative.
double band_radiance(double lower, double upper, double temperature);

/// The temperature at which band_radiance() is `radiance`, to 1e-6 K (Newton in ln L against 1/T,
/// which is almost a straight line). @return K; NaN where no temperature has it (radiance <= 0 or
/// not finite).
double band_temperature(double lower, double upper, double radiance);

/// Everything between a surface and its counts, for one camera behind windows.
///   S = gain t_int [ tau (eps L(T) + (1 - eps) L(T_amb)) + window emission ] + dark
/// The response within the band is flat unless a measured spectrum is given, which then replaces
/// the band; `transmission` multiplies whatever of the windows the spectrum does not hold.
struct Radiometry {
  double band_lower = 3e-6;        ///< m
  double band_upper = 5e-6;        ///< m
  double transmission = 1;         ///< tau of all windows together, 1
  double emissivity = 1;           ///< eps of the surface, 1
  double gain = 1;                 ///< counts per (W m-2 sr-1 s)
  double dark = 0;                 ///< counts without light
  double ambient_temperature = 0;  ///< K, of what the surface reflects; 0: reflects nothing
  double window_temperature = 0;   ///< K; used with window_emission only
  double integration_time = 1;     ///< s
  bool window_emission = false;    ///< adds (1 - tau) L(T_window): windows that absorb also radiate
  /// Response of the detector, times the windows' transmission where that is known by wavelength;
  /// null: flat within the band.
  std::shared_ptr<const Spectrum> spectrum = nullptr;
};

/// Signal of a surface at `temperature` (K) with the emissivity of `r`, counts.
double signal(const Radiometry& r, double temperature);
/// The same for another emissivity.
double signal(const Radiometry& r, double temperature, double emissivity);

/// The surface temperature, K, that gives `signal` (counts) with the emissivity of `r`: the inverse
/// of signal() to 1e-6 K. NaN if what is left after dark, window and reflection is not positive,
/// which is what an under-range pixel looks like. @throws InputError if gain, integration time,
/// transmission or emissivity is not positive.
double temperature(const Radiometry& r, double signal);

/// L(T) of one band as a table of ln L against 1/T, built once (tens of milliseconds), for images.
/// Cubic Hermite with exact slopes in both directions; agrees with band_radiance() to a relative
/// 1e-9 and with band_temperature() to 1e-6 K. Outside [minimum, maximum] the quadrature itself
/// answers.
class BandTable {
 public:
  /// @param lower,upper m; @param minimum,maximum K, 0 < minimum < maximum.
  BandTable(double lower, double upper, double minimum = 150, double maximum = 8000);
  /// W m-2 sr-1; 0 for a temperature of zero or less.
  double radiance(double temperature) const;
  /// K; NaN where no temperature has this radiance.
  double temperature(double radiance) const;
  double lower() const { return lower_; }
  double upper() const { return upper_; }

 private:
  /// A function known by value and slope at equidistant nodes.
  struct Hermite {
    double first = 0, step = 1;
    std::vector<double> value, slope;
    bool covers(double x) const;
    double operator()(double x) const;
  };
  double lower_, upper_;
  Hermite log_radiance_;         // ln L over 1/T
  Hermite inverse_temperature_;  // 1/T over ln L
};

/// signal() and temperature() by a table, which must be of the band of `r`.
double signal(const Radiometry& r, const BandTable& band, double temperature, double emissivity);
double temperature(const Radiometry& r, const BandTable& band, double signal);

}  // namespace meltproof::imaging
