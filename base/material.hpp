// SPDX-License-Identifier: GPL-3.0-or-later
// Temperature- and composition-dependent material properties. Enthalpy is the only source of
// specific heat; temperature follows from it by an exact inverse.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace meltproof {

/// A continuous, piecewise linear function of temperature.
/// Outside its knots it continues with the slope of its first and last piece.
struct PiecewiseLinear {
  std::vector<double> knots;   ///< K, strictly increasing, at least two
  std::vector<double> values;  ///< one per knot
  double operator()(double temperature) const;
  double slope(double temperature) const;  ///< to the right of a knot at the knot
};

/// One term a + b T + c (1 - exp(-d / T)) on a range: enough for every printed law.
struct PropertyPiece {
  double from = 0, to = 0;  ///< K
  double constant = 0;      ///< a
  double linear = 0;        ///< b, 1/K
  double exponential = 0;   ///< c, evaluated as -c expm1(-d/T), which loses no digits
  double activation = 0;    ///< d, K
  double operator()(double temperature) const;
};

/// A property as a function of temperature, held constant outside [first.from, last.to].
struct Property {
  std::string unit, source, note;
  std::vector<PropertyPiece> pieces;  ///< contiguous: each begins where the last one ends
  double floor = 0;                   ///< smallest value returned
  double operator()(double temperature) const;
};

/// The forms that the source prints, kept beside the repaired ones: they may jump, and enthalpy may
/// not be inverted. Viscosity here includes the source's factor 20. `note` says what is wrong with
/// each.
struct PrintedForms {
  Property enthalpy;         ///< J kg-1, zero where the printed line happens to cross
  Property specific_heat;    ///< J kg-1 K-1
  Property conductivity;     ///< W m-1 K-1
  Property viscosity;        ///< Pa s
  Property surface_tension;  ///< N m-1
  double molar_mass = 0;     ///< kg mol-1
};

/// Which forms of a material are read.
enum class Form {
  repaired,   ///< continuous, invertible, real viscosity
  as_printed  ///< the printed conductivity, viscosity (with its factor 20), surface tension, molar
              ///< mass
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
  double real_density = 0;  ///< kg m-3, of the cold solid; `density` unless the file gives another
  /// Standard uncertainties in the unit of the quantity, by its key, where the file states one.
  std::map<std::string, double> uncertainty;
  PrintedForms printed;  ///< empty if the file holds none
};

/// Reads data/materials/<name>.toml. With Form::as_printed the printed forms replace the repaired
/// ones where the engine can use them; enthalpy stays the repaired one, because the printed one
/// cannot be inverted. @throws InputError naming file and key, also for pieces that leave gaps or
/// jump, and for printed forms that the file does not hold.
Material read_material(const std::filesystem::path& path, Form form = Form::repaired);

/// D = prefactor exp(-activation_temperature / T), the diffusivity of the additive in the base
/// (Eq. 6).
struct Diffusivity {
  std::string name, source, note;
  double prefactor = 0;               ///< m2 s-1
  double activation_temperature = 0;  ///< K
  double from = 0, to = 0;            ///< K, where it was measured; extrapolated elsewhere
  double operator()(double temperature) const;
};

/// Reads one law of data/materials/diffusivity.toml; an empty name is the file's default.
/// @throws InputError naming file, key and the laws that there are.
Diffusivity read_diffusivity(const std::filesystem::path& path, const std::string& law = "");

/// How an inverted enthalpy is reported.
struct ThermalState {
  double temperature = 0;      ///< K
  double liquid_fraction = 0;  ///< 1
};

/// Base powder and additive mixed by mass fraction of the additive: every property is weighted by
/// mass, as the paper does (Section 2), except density, where volumes add. Both enthalpies are zero
/// at the same temperature, so mixing needs no correction.
class Mixture {
 public:
  /// @throws InputError if an enthalpy does not rise everywhere or the two are zero at different
  /// temperatures.
  Mixture(Material base, Material additive);

  /// h(T, C) = (1 - C) h_base(T) + C h_additive(T), J kg-1; strictly increasing in T.
  double enthalpy(double temperature, double concentration) const;
  /// The exact inverse of enthalpy() in T: no iteration.
  double temperature(double enthalpy, double concentration) const;
  double specific_heat(double temperature, double concentration) const;
  /// The smallest specific heat on the linear piece of the enthalpy that holds the temperature and
  /// on the pieces next to it, J kg-1 K-1. A melting particle may leave its range within one step,
  /// so a stable step goes by this one and not by the large apparent specific heat of melting.
  double smallest_specific_heat_near(double temperature, double concentration) const;
  /// The smallest specific heat between `temperature` - `reach` and `temperature` + `reach`, J kg-1
  /// K-1: for steps that change no temperature by more than that (K).
  double smallest_specific_heat_within(double reach, double temperature,
                                       double concentration) const;
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
  double smallest_specific_heat(std::size_t first, std::size_t last, double concentration) const;

  Material base_, additive_;
  // The two enthalpies on the union of their knots, so that the inverse is one search and one
  // division.
  std::vector<double> knots_, base_enthalpy_, additive_enthalpy_;
};

}  // namespace meltproof
