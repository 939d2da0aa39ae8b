// SPDX-License-Identifier: GPL-3.0-or-later
// From element fractions to the concentration of AlSi10Mg in 316L.
#pragma once

#include <map>
#include <string>

namespace meltproof::validation {

/// Fractions by element symbol ("Al", "Fe"); of mass or of atoms, as the name says, not in percent.
using ElementFractions = std::map<std::string, double>;

/// Mass fractions of the elements in AlSi10Mg: 89.65 % Al, 10 % Si, 0.35 % Mg (nominal).
const ElementFractions& alsi10mg_composition();

/// Mass fractions of the elements in 316L: the middle of the ranges of UNS S31603 in ASTM A240 (Cr
/// 16 to 18, Ni 10 to 14, Mo 2 to 3, Mn up to 2, Si up to 0.75 %), the rest iron. A measured
/// composition of the plate is better.
const ElementFractions& steel_316l_composition();

/// a_i = (w_i / A_i) / sum (w_k / A_k); the masses need not add to 1. @throws InputError for an
/// unknown element, or if nothing is there.
ElementFractions atom_from_mass(const ElementFractions& mass);
/// w_i = a_i A_i / sum a_k A_k.
ElementFractions mass_from_atom(const ElementFractions& atom);

/// Mass fraction of AlSi10Mg from the mass fraction of aluminium, of which 316L holds none:
/// w_Al / 0.8965. Not clipped: what noise carries beyond 0 and 1 stays visible.
double concentration_from_aluminium(double aluminium);
/// The same from silicon, an independent estimate: (w_Si - w_base) / (0.10 - w_base), with the mass
/// fraction of silicon in the steel, which must be known. @throws InputError if that is 10 % or
/// more.
double concentration_from_silicon(double silicon, double silicon_of_base);

}  // namespace meltproof::validation
