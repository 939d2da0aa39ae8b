// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/composition.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

const std::map<std::string, double>& atomic_weights() {
  static const std::map<std::string, double> weights = {
      {"H", 1.008},   {"B", 10.81},   {"C", 12.011},  {"N", 14.007},  {"O", 15.999},
      {"F", 18.998},  {"Na", 22.990}, {"Mg", 24.305}, {"Al", 26.982}, {"Si", 28.085},
      {"P", 30.974},  {"S", 32.06},   {"Cl", 35.45},  {"K", 39.098},  {"Ca", 40.078},
      {"Ti", 47.867}, {"V", 50.942},  {"Cr", 51.996}, {"Mn", 54.938}, {"Fe", 55.845},
      {"Co", 58.933}, {"Ni", 58.693}, {"Cu", 63.546}, {"Zn", 65.38},  {"Zr", 91.224},
      {"Nb", 92.906}, {"Mo", 95.95},  {"Sn", 118.71}, {"Ta", 180.95}, {"W", 183.84},
  };
  return weights;
}

/// Every fraction times `factor(symbol)`, scaled to a sum of 1.
template <class Factor>
ElementFractions rescaled(const ElementFractions& fractions, Factor factor) {
  ElementFractions result;
  double sum = 0;
  for (const auto& [symbol, value] : fractions) {
    result[symbol] = value * factor(symbol);
    sum += result[symbol];
  }
  if (!(sum > 0)) {
    throw InputError("a composition whose fractions add to nothing cannot be converted.");
  }
  for (auto& [symbol, value] : result) {
    value /= sum;
  }
  return result;
}

}  // namespace

const ElementFractions& alsi10mg_composition() {
  static const ElementFractions composition = {{"Al", 0.8965}, {"Si", 0.10}, {"Mg", 0.0035}};
  return composition;
}

bool is_element(const std::string& symbol) { return atomic_weights().contains(symbol); }

double atomic_weight(const std::string& symbol) {
  const auto at = atomic_weights().find(symbol);
  if (at == atomic_weights().end()) {
    throw InputError(fmt::format(
        "\"{}\" is no element whose atomic weight is known here: expected a symbol such as Al.",
        symbol));
  }
  return at->second;
}

ElementFractions atom_from_mass(const ElementFractions& mass) {
  return rescaled(mass, [](const std::string& symbol) { return 1 / atomic_weight(symbol); });
}

ElementFractions mass_from_atom(const ElementFractions& atom) {
  return rescaled(atom, [](const std::string& symbol) { return atomic_weight(symbol); });
}

double concentration_from_aluminium(double aluminium) {
  return aluminium / alsi10mg_composition().at("Al");
}

double concentration_from_silicon(double silicon, double silicon_of_base) {
  const double alloy = alsi10mg_composition().at("Si");
  if (!(silicon_of_base >= 0 && silicon_of_base < alloy)) {
    throw InputError(fmt::format(
        "a silicon content of the base of {} tells nothing of the additive: expected 0 to {}.",
        silicon_of_base, alloy));
  }
  return (silicon - silicon_of_base) / (alloy - silicon_of_base);
}

}  // namespace meltproof::validation
