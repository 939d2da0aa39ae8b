// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/material.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"

namespace meltproof {
namespace {

/// The piece of `knots` that holds x; the first or last one for x outside.
std::size_t piece_of(const std::vector<double>& knots, double x) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
  return static_cast<std::size_t>(above - knots.begin()) - 1;
}

double weighted(double base, double additive, double concentration) {
  return (1 - concentration) * base + concentration * additive;
}

}  // namespace

double PiecewiseLinear::operator()(double temperature) const {
  const std::size_t i = piece_of(knots, temperature);
  return values[i] +
         (temperature - knots[i]) * ((values[i + 1] - values[i]) / (knots[i + 1] - knots[i]));
}

double PiecewiseLinear::slope(double temperature) const {
  const std::size_t i = piece_of(knots, temperature);
  return (values[i + 1] - values[i]) / (knots[i + 1] - knots[i]);
}

double PropertyPiece::operator()(double temperature) const {
  const double line = constant + linear * temperature;
  return exponential == 0 ? line : line - exponential * std::expm1(-activation / temperature);
}

double Property::operator()(double temperature) const {
  const double t = std::clamp(temperature, pieces.front().from, pieces.back().to);
  const auto piece = std::find_if(pieces.begin(), pieces.end() - 1,
                                  [t](const PropertyPiece& p) { return t < p.to; });
  return std::max(floor, (*piece)(t));
}

double Diffusivity::operator()(double temperature) const {
  return prefactor * std::exp(-activation_temperature / temperature);
}

Mixture::Mixture(Material base, Material additive)
    : base_(std::move(base)), additive_(std::move(additive)) {
  const PiecewiseLinear &b = base_.enthalpy, &a = additive_.enthalpy;
  std::set_union(b.knots.begin(), b.knots.end(), a.knots.begin(), a.knots.end(),
                 std::back_inserter(knots_));
  for (const double knot : knots_) {
    base_enthalpy_.push_back(b(knot));
    additive_enthalpy_.push_back(a(knot));
  }
  if (b.knots.front() != a.knots.front()) {
    throw InputError(fmt::format(
        "{} and {} cannot be mixed: their enthalpies are zero at {} K and {} K: expected one "
        "temperature",
        base_.name, additive_.name, shortest(b.knots.front()), shortest(a.knots.front())));
  }
  for (const auto* values : {&base_enthalpy_, &additive_enthalpy_}) {
    if (!std::is_sorted(values->begin(), values->end(), std::less_equal<>())) {
      throw InputError(
          fmt::format("{} and {} cannot be mixed: an enthalpy does not rise everywhere", base_.name,
                      additive_.name));
    }
  }
}

double Mixture::enthalpy(double temperature, double concentration) const {
  const std::size_t i = piece_of(knots_, temperature);
  const double low = weighted(base_enthalpy_[i], additive_enthalpy_[i], concentration);
  const double high = weighted(base_enthalpy_[i + 1], additive_enthalpy_[i + 1], concentration);
  return low + (temperature - knots_[i]) * ((high - low) / (knots_[i + 1] - knots_[i]));
}

double Mixture::temperature(double enthalpy, double concentration) const {
  // A handful of knots: counting those below needs no branch that can be mispredicted.
  std::size_t i = 0;
  for (std::size_t k = 1; k + 1 < knots_.size(); ++k) {
    i += weighted(base_enthalpy_[k], additive_enthalpy_[k], concentration) <= enthalpy ? 1 : 0;
  }
  const double low = weighted(base_enthalpy_[i], additive_enthalpy_[i], concentration);
  const double high = weighted(base_enthalpy_[i + 1], additive_enthalpy_[i + 1], concentration);
  return knots_[i] + (enthalpy - low) * (knots_[i + 1] - knots_[i]) / (high - low);
}

double Mixture::specific_heat(double temperature, double concentration) const {
  const std::size_t i = piece_of(knots_, temperature);
  const double rise = weighted(base_enthalpy_[i + 1] - base_enthalpy_[i],
                               additive_enthalpy_[i + 1] - additive_enthalpy_[i], concentration);
  return rise / (knots_[i + 1] - knots_[i]);
}

double Mixture::smallest_specific_heat_near(double temperature, double concentration) const {
  const std::size_t here = piece_of(knots_, temperature);
  return smallest_specific_heat(here > 0 ? here - 1 : 0, std::min(here + 1, knots_.size() - 2),
                                concentration);
}

double Mixture::smallest_specific_heat_within(double reach, double temperature,
                                              double concentration) const {
  return smallest_specific_heat(piece_of(knots_, temperature - reach),
                                piece_of(knots_, temperature + reach), concentration);
}

/// On the linear pieces of the enthalpy from `first` to `last`.
double Mixture::smallest_specific_heat(std::size_t first, std::size_t last,
                                       double concentration) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i <= last; ++i) {
    const double rise = weighted(base_enthalpy_[i + 1] - base_enthalpy_[i],
                                 additive_enthalpy_[i + 1] - additive_enthalpy_[i], concentration);
    smallest = std::min(smallest, rise / (knots_[i + 1] - knots_[i]));
  }
  return smallest;
}

double Mixture::solidus(double concentration) const {
  return weighted(base_.solidus, additive_.solidus, concentration);
}
double Mixture::liquidus(double concentration) const {
  return weighted(base_.liquidus, additive_.liquidus, concentration);
}

double Mixture::liquid_fraction(double enthalpy_now, double concentration) const {
  const double solid = enthalpy(solidus(concentration), concentration);
  const double liquid = enthalpy(liquidus(concentration), concentration);
  return std::clamp((enthalpy_now - solid) / (liquid - solid), 0.0, 1.0);
}

double Mixture::conductivity(double temperature, double concentration) const {
  return weighted(base_.conductivity(temperature), additive_.conductivity(temperature),
                  concentration);
}
double Mixture::viscosity(double temperature, double concentration) const {
  return weighted(base_.viscosity(temperature), additive_.viscosity(temperature), concentration);
}
double Mixture::surface_tension(double temperature, double concentration) const {
  return weighted(base_.surface_tension(temperature), additive_.surface_tension(temperature),
                  concentration);
}
double Mixture::density(double concentration) const {
  return 1 / weighted(1 / base_.density, 1 / additive_.density, concentration);
}
double Mixture::absorptivity(double concentration) const {
  return weighted(base_.absorptivity, additive_.absorptivity, concentration);
}
double Mixture::emissivity(double concentration) const {
  return weighted(base_.emissivity, additive_.emissivity, concentration);
}
double Mixture::molar_mass(double concentration) const {
  return weighted(base_.molar_mass, additive_.molar_mass, concentration);
}
double Mixture::boiling(double concentration) const {
  return weighted(base_.boiling, additive_.boiling, concentration);
}
double Mixture::latent_heat_vaporisation(double concentration) const {
  return weighted(base_.latent_heat_vaporisation, additive_.latent_heat_vaporisation,
                  concentration);
}
double Mixture::sticking(double concentration) const {
  return weighted(base_.sticking, additive_.sticking, concentration);
}

}  // namespace meltproof
