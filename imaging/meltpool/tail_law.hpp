// SPDX-License-Identifier: GPL-3.0-or-later
// What solidification does to the signal: ln(S - dark) of metal as a function of a smooth field.
#pragma once

namespace meltproof::imaging {

/// Relative change of the radiance for a relative change of the temperature, d ln L / d ln T, of
/// steel at its liquidus between 3 and 5 um; used where a recording says nothing of its band.
inline constexpr double steepness_of_steel = 2.5;

/// A relative change of the radiance for one of the temperature, d ln L / d ln T at the liquidus,
/// together with the wavelength at which Planck's law has it: x = c2 / (lambda T_liquidus), where
/// x / (1 - exp(-x)) is that number. A number like any other otherwise. Below 1, which no
/// wavelength has, as 1.02.
class Steepness {
 public:
  Steepness(double by_log_temperature);  // NOLINT: it is that number
  operator double() const { return value_; }
  double x() const { return x_; }
  double exp_x_less_1() const { return exp_x_less_1_; }

 private:
  double value_, x_, exp_x_less_1_;
};

/// Freezing metal as a camera sees it. theta is ln(S - dark) that liquid metal of the same enthalpy
/// would have, continued below the liquidus. Planck's law at one wavelength makes of it a
/// temperature in units of the liquidus, tau = x / ln(1 + (exp(x) - 1) exp(theta* - theta)), which
/// falls as evenly as the enthalpy. (Wien's form of it, tau = 1 / (1 - (theta - theta*) / B), is
/// 0.045 off in ln S a fifth below the liquidus at 3 to 5 um, where this is 0.01 off; with it
/// lengths beside a shoulder came out 0.02 px shorter.) Below tau = 1 the metal freezes over a part
/// w / B of that fall: the solid fraction f rises from 0 to 1, released heat gives back L f with L
/// = (1 - m) w / B, and the emissivity goes from that of liquid to that of solid metal in
/// proportion to f:
///   ln(S - dark) = theta* + ln((exp(x) - 1) / (exp(x / (tau + L f)) - 1))
///                  + ln(1 + f (exp(e) - 1)).
/// w = 0 is an abrupt front, w = e = 0 none.
struct TailLaw {
  double log_signal = 0;  ///< theta*, ln(S - dark) of liquid metal at the front
  double ratio = 0;       ///< e, ln of the emissivity of solid over that of liquid metal
  double interval = 0;    ///< w, of theta
  Steepness steepness = steepness_of_steel;  ///< B, d ln S / d ln T at the liquidus, and x

  /// m, the part of the enthalpy between liquidus and solidus that cools the metal. 316L freezes
  /// over 50 K and gives off 274.7 kJ/kg there (Table A1 of the source paper): with its heat
  /// capacities of 714 and 847 J/(kg K) that is 0.13 to 0.15; 0.12 are 50 K beside the 370 K of the
  /// latent heat with which the virtual camera's tails are made. A recording does not tell it apart
  /// from a change of the emissivity.
  static constexpr double sensible = 0.12;

  /// Height of the feature in ln S: by how much the signal falls less than that of liquid metal.
  double rise() const { return ratio + (1 - sensible) * interval; }
};

/// ln(S - dark) and its derivatives.
struct TailLawValue {
  double log_signal = 0, by_theta = 1, by_theta_star = 0, by_ratio = 0, by_interval = 0;
};

/// The law at a point of a grid, f being its mean over the point's cell, so that an abrupt front
/// moves smoothly between points. @param cell range of theta across a cell.
TailLawValue tail_law(const TailLaw& law, double theta, double cell);

}  // namespace meltproof::imaging
