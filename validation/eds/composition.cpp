// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/composition.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/eds/elements.hpp"

namespace meltproof::validation {
namespace {

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

const ElementFractions& steel_316l_composition() {
  static const ElementFractions composition = {{"Fe", 0.67125}, {"Cr", 0.17}, {"Ni", 0.12},
                                               {"Mo", 0.025},   {"Mn", 0.01}, {"Si", 0.00375}};
  return composition;
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
