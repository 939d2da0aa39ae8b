// SPDX-License-Identifier: GPL-3.0-or-later
// Temperature- and composition-dependent material properties. Enthalpy is the only source of
// specific heat; temperature follows from it by an exact inverse.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof {

/// A continuous, piecewise linear function of temperature.
/// Outside its knots it continues with the slope of its first and last piece.
struct PiecewiseLinear {
  std::vector<double> knots;   ///< K, strictly increasing, at least two
  std::vector<double> values;  ///< one per knot
  double operator()(double temperature) const;
  double slope(double temperature) const;  ///< to the right of a knot at the knot
};

/// One term a + b T + c (1 - exp(-d / T)) valid from a temperature on: enough for every printed
/// law.
struct PropertyPiece {
  double from = 0, to = 0;  ///< K
  double constant = 0;      ///< a
  double linear = 0;        ///< b, 1/K
  double exponential = 0;   ///< c, evaluated as -c expm1(-d/T), which loses no digits
  double activation = 0;    ///< d, K
};

/// A property as a function of temperature, held constant outside [first.from, last.to].
struct Property {
  std::string unit, source, note;
  std::vector<PropertyPiece> pieces;  ///< contiguous: each begins where the last one ends
  double floor = 0;                   ///< smallest value returned
  double operator()(double temperature) const;
};

/// One material. All SI.
struct Material {
  std::string name, source, checksum;
  double solidus = 0, liquidus = 0, boiling = 0;  ///< K
  double density = 0;                             ///< kg m-3
  double molar_mass = 0;                          ///< kg mol-1
  double absorptivity = 0;                        ///< 1, at the laser's wavelength
  double emissivity = 0;                          ///< 1, total hemispherical, for radiation loss
  double latent_heat_vaporisation = 0;            ///< J kg-1
  double sticking = 0.82;                         ///< 1, share of the evaporated flux that leaves
  PiecewiseLinear enthalpy;                       ///< J kg-1, zero at 298.15 K
  Property conductivity;                          ///< W m-1 K-1
  Property viscosity;                             ///< Pa s, real (without any stabilising factor)
  Property surface_tension;                       ///< N m-1
};

/// Reads data/materials/<name>.toml. With `as_printed` the forms that the source prints are used
/// where they can be evaluated (see the file's [as_printed] notes); enthalpy then is the printed,
/// discontinuous one and may not be inverted. @throws InputError naming file, line and key.
Material read_material(const std::filesystem::path& path);

/// How an inverted enthalpy is reported.
struct ThermalState {
  double temperature = 0;      ///< K
  double liquid_fraction = 0;  ///< 1
};

/// Base powder and additive mixed by mass fraction of the additive. Both enthalpies are zero at the
/// same temperature, so mixing needs no correction.
class Mixture {
 public:
  Mixture(Material base, Material additive);

  /// h(T, C) = (1 - C) h_base(T) + C h_additive(T), J kg-1; strictly increasing in T.
  double enthalpy(double temperature, double concentration) const;
  /// The exact inverse of enthalpy() in T: no iteration.
  double temperature(double enthalpy, double concentration) const;
  double specific_heat(double temperature, double concentration) const;
  /// Mass-weighted solidus and liquidus, K.
  double solidus(double concentration) const;
  double liquidus(double concentration) const;
  /// 0 at and below the solidus of the mixture, 1 at and above its liquidus, linear in enthalpy
  /// between.
  double liquid_fraction(double enthalpy, double concentration) const;
  double conductivity(double temperature, double concentration) const;
  double viscosity(double temperature, double concentration) const;
  double surface_tension(double temperature, double concentration) const;
  double density(double concentration) const;
  double absorptivity(double concentration) const;
  double emissivity(double concentration) const;
  double molar_mass(double concentration) const;
  double boiling(double concentration) const;
  double latent_heat_vaporisation(double concentration) const;
  double sticking(double concentration) const;

  const Material& base() const { return base_; }
  const Material& additive() const { return additive_; }

 private:
  Material base_, additive_;
  // The two enthalpies on the union of their knots, so that the inverse is one search and one
  // division.
  std::vector<double> knots_, base_enthalpy_, additive_enthalpy_;
};

}  // namespace meltproof
