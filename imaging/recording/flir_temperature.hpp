// SPDX-License-Identifier: GPL-3.0-or-later
// The conversion of FLIR's radiometric counts to temperature.
#pragma once

namespace meltproof::imaging {

/// The constants that FLIR cameras store with each frame. Temperatures in K.
struct FlirConstants {
  double planck_r1 = 0, planck_b = 0, planck_f = 1, planck_o = 0, planck_r2 = 0;
  double emissivity = 1;
  double distance = 0;  ///< m
  double reflected_temperature = 293.15, atmospheric_temperature = 293.15,
         window_temperature = 293.15;
  double window_transmission = 1;
  double relative_humidity = 0;  ///< 0 to 1
  double alpha_1 = 0.006569, alpha_2 = 0.01262, beta_1 = -0.002276, beta_2 = -0.00667, x = 1.9;
};

/// Transmission of an air path of half the object's distance (camera to window, window to object),
///   tau = X exp(-sqrt(d/2) (a1 + b1 sqrt(w))) + (1 - X) exp(-sqrt(d/2) (a2 + b2 sqrt(w))),
/// with w the water in the air in g/m3 from relative humidity and the air's temperature t in
/// Celsius,
///   w = rh exp(1.5587 + 0.06939 t - 0.00027816 t^2 + 6.8455e-7 t^3).
double flir_air_transmission(const FlirConstants& constants);

/// Counts of a black body: S(T) = R1 / (R2 (exp(B / T) - F)) - O.
double flir_counts(const FlirConstants& constants, double temperature);

/// Signal to temperature, with everything that does not depend on the pixel computed once:
///   S_object = (S - S_stray) / (eps tau_air tau_window tau_air),  T = B / ln(R1 / (R2 (S_object +
///   O)) + F),
/// where S_stray adds up the reflected surroundings, both air paths and the window.
class FlirTemperature {
 public:
  explicit FlirTemperature(const FlirConstants& constants);
  /// K; NaN where the formula has no answer (a signal below all surroundings).
  double operator()(double counts) const;

 private:
  FlirConstants constants_;
  double scale_ = 1, stray_ = 0;
};

}  // namespace meltproof::imaging
