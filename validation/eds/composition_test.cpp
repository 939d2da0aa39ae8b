// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/composition.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

TEST(Composition, HalfIronHalfAluminiumByMass) {
  const auto atoms = atom_from_mass({{"Fe", 0.5}, {"Al", 0.5}});
  EXPECT_NEAR(100 * atoms.at("Fe"), 32.58, 0.005);
  EXPECT_NEAR(100 * atoms.at("Al"), 67.42, 0.005);
  const auto mass = mass_from_atom(atoms);
  EXPECT_NEAR(mass.at("Fe"), 0.5, 1e-12);
}

// CuFeS2 as quantified by a vendor's program (samples/README.md): mass fractions that add to 0.950.
TEST(Composition, AgreesWithAVendorsQuantification) {
  const auto atoms = atom_from_mass({{"S", 0.2637949}, {"Fe", 0.3066824}, {"Cu", 0.3799997}});
  EXPECT_NEAR(atoms.at("S"), 0.4176372, 5e-5);
  EXPECT_NEAR(atoms.at("Fe"), 0.2787832, 5e-5);
  EXPECT_NEAR(atoms.at("Cu"), 0.3035796, 5e-5);
}

TEST(Composition, ConcentrationFromBothElementsOfTheAlloy) {
  double sum = 0;
  for (const auto& [symbol, value] : alsi10mg_composition()) {
    sum += value;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  // A quarter of AlSi10Mg in a steel with 0.5 % Si (a made-up steel).
  EXPECT_NEAR(concentration_from_aluminium(0.25 * 0.8965), 0.25, 1e-12);
  EXPECT_NEAR(concentration_from_silicon(0.25 * 0.10 + 0.75 * 0.005, 0.005), 0.25, 1e-12);
  EXPECT_LT(concentration_from_aluminium(-0.001), 0);
}

TEST(Composition, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(atom_from_mass({{"Xx", 1}}), InputError);
  EXPECT_THROW(atom_from_mass({}), InputError);
  EXPECT_THROW(concentration_from_silicon(0.01, 0.2), InputError);
}

}  // namespace
}  // namespace meltproof::validation
