// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/material.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof {
namespace {

const Material& steel() {
  static const Material material = read_material("data/materials/316L.toml");
  return material;
}
const Material& aluminium() {
  static const Material material = read_material("data/materials/AlSi10Mg.toml");
  return material;
}
const Mixture& mixture() {
  static const Mixture both(steel(), aluminium());
  return both;
}

double jump(const Property& printed, std::size_t piece) {
  const double at = printed.pieces[piece].from;
  return printed.pieces[piece](at) - printed.pieces[piece - 1](at);
}

// The errata of the source's tables, computed from the printed coefficients.

TEST(PrintedTable, EnthalpyOf316LJumpsAsTheErrataSay) {
  const Property& h = steel().printed.enthalpy;
  EXPECT_NEAR(jump(h, 1), 53.5e3, 50);
  EXPECT_NEAR(jump(h, 2), -1.0e3, 50);
  EXPECT_NEAR(jump(h, 3), 24.1e3, 50);
  const auto &first = h.pieces[0], &second = h.pieces[1];
  EXPECT_NEAR((first.constant - second.constant) / (second.linear - first.linear), 922.4, 0.05);
  EXPECT_NEAR(-first.constant / first.linear, 302, 0.5);
}

TEST(PrintedTable, EnthalpyOfAlSi10MgJumpsAtTheLiquidusAndIsZeroElsewhere) {
  const Property& h = aluminium().printed.enthalpy;
  EXPECT_NEAR(jump(h, 1), 0, 5);
  EXPECT_NEAR(jump(h, 2), 7.0e3, 50);
  EXPECT_NEAR(-h.pieces[0].constant / h.pieces[0].linear, 253, 0.5);
}

TEST(PrintedTable, ConductivityOf316LJumpsAtBothEndsOfTheMushyRange) {
  EXPECT_NEAR(jump(steel().printed.conductivity, 1), 1.8, 0.05);
  EXPECT_NEAR(jump(steel().printed.conductivity, 2), 2.5, 0.05);
}

TEST(PrintedTable, SpecificHeatContradictsTheEnthalpyOfTheSameTable) {
  EXPECT_EQ(steel().printed.specific_heat(1000), 492);
  EXPECT_NEAR(steel().printed.enthalpy.pieces[1].linear, 714.3, 0.05);
}

TEST(PrintedTable, ViscosityTurnsNegativeAt4405KAndIncludesTheFactor20) {
  const Property& printed = steel().printed.viscosity;
  EXPECT_GT(printed(4404), 0);
  EXPECT_LT(printed(4406), 0);
  EXPECT_NEAR(printed(2000) / steel().viscosity(2000), 20, 1e-9);
}

TEST(PrintedTable, SumOfAtomsAsMolarMassMultipliesTheRecoilPressureAHundredThousandTimes) {
  // Clausius-Clapeyron at 3000 K with the material's own latent heat and boiling temperature.
  const Material& m = aluminium();
  const auto pressure_ratio = [&m](double molar_mass) {
    return std::exp(m.latent_heat_vaporisation * molar_mass / 8.314462618 *
                    (1 / m.boiling - 1 / 3000.));
  };
  EXPECT_EQ(m.printed.molar_mass, 0.33214);
  const double ratio = pressure_ratio(m.printed.molar_mass) / pressure_ratio(m.molar_mass);
  EXPECT_GT(ratio, 1e5);
}

TEST(AsPrinted, ReplacesWhatTheEngineCanUseAndKeepsTheInvertibleEnthalpy) {
  const Material printed = read_material("data/materials/316L.toml", Form::as_printed);
  EXPECT_NEAR(printed.viscosity(2000), 20 * steel().viscosity(2000), 1e-9);
  EXPECT_NEAR(printed.conductivity(1650), 355.93 - 0.1969 * 1650, 1e-9);
  EXPECT_EQ(printed.enthalpy(1650), steel().enthalpy(1650));
  EXPECT_EQ(read_material("data/materials/AlSi10Mg.toml", Form::as_printed).molar_mass, 0.33214);
}

// Nickel alloys, for benchmark tracks: literature values without printed forms.

TEST(NickelAlloys, HaveNoPrintedFormsToSwitchTo) {
  for (const std::string name : {"IN625", "IN718"}) {
    const std::string path = "data/materials/" + name + ".toml";
    EXPECT_TRUE(read_material(path).printed.enthalpy.pieces.empty());
    try {
      read_material(path, Form::as_printed);
      FAIL() << name;
    } catch (const InputError& refused) {
      EXPECT_NE(std::string(refused.what()).find("as_printed"), std::string::npos);
    }
  }
}

TEST(NickelAlloys, EnthalpyKeepsTheIntegralsOfItsSources) {
  const Material a = read_material("data/materials/IN625.toml");
  const auto heat = [](double from, double to, double c0, double c1, double c2) {
    return c0 * (to - from) + c1 * (to * to - from * from) / 2 +
           c2 * (to * to * to - from * from * from) / 3;
  };
  EXPECT_NEAR(a.enthalpy(1563.15), heat(298.15, 1563.15, 338.39, 0.2441, 0), 10);
  const double solid_625 = 338.39 + 0.2441 * 1563.15;
  EXPECT_NEAR(a.enthalpy(1622) - a.enthalpy(1563.15),
              217.54e3 + (1622 - 1563.15) * (solid_625 + 750.65) / 2, 10);
  const Material b = read_material("data/materials/IN718.toml");
  EXPECT_NEAR(b.enthalpy(1533), heat(298.15, 1533, 360.56, 0.2621, -4e-5), 10);
  const double solid_718 = 360.56 + 0.2621 * 1533 - 4e-5 * 1533 * 1533;
  EXPECT_NEAR(b.enthalpy(1609) - b.enthalpy(1533), 210e3 + 76 * (solid_718 + 720) / 2, 10);
}

TEST(NickelAlloys, AbsorptivityIsBramsonsAtTheLasersWavelength) {
  for (const auto& [name, resistivity] : {std::pair{"IN625", 129e-6}, std::pair{"IN718", 125e-6}}) {
    const double q = resistivity / 1.07e-4;
    EXPECT_NEAR(read_material(std::string("data/materials/") + name + ".toml").absorptivity,
                0.365 * std::sqrt(q) - 0.0667 * q + 0.006 * std::pow(q, 1.5), 0.01)
        << name;
  }
}

TEST(NickelAlloys, ConductivityPassesThroughTheDataSheetAndTheMeasurements) {
  const Material a = read_material("data/materials/IN625.toml");
  EXPECT_NEAR(a.conductivity(116.15), 7.2, 0.05);
  EXPECT_NEAR(a.conductivity(1255.15), 25.2, 0.05);
  EXPECT_NEAR(a.conductivity(294.15), 9.8, 0.3);
  const Material b = read_material("data/materials/IN718.toml");
  EXPECT_NEAR(b.conductivity(600), 5.291 + 0.0152 * 600 + 1.382e-6 * 600 * 600, 1.35);
  EXPECT_NEAR(b.conductivity(1300), 11.75 + 0.011 * 1300 - 9.327e-7 * 1300 * 1300, 1.35);
}

TEST(NickelAlloys, MixWithThemselvesAsABarePlateNeeds) {
  const Material a = read_material("data/materials/IN625.toml");
  const Mixture plate(a, a);
  EXPECT_NEAR(plate.temperature(plate.enthalpy(2000, 0), 0), 2000, 1e-9);
  EXPECT_GT(a.real_density, a.density);
  EXPECT_GT(a.surface_tension(1700), a.surface_tension(2700));
  EXPECT_GT(a.surface_tension(3400), 0.5);
}

// The repaired forms.

TEST(Enthalpy, KeepsThePrintedSlopesAndIsZeroAtRoomTemperature) {
  for (const Material* m : {&steel(), &aluminium()}) {
    EXPECT_EQ(m->enthalpy(298.15), 0);
    const auto& printed = m->printed.enthalpy.pieces;
    for (const double t : {400., 800., 1000., 1500., 1650., 1700., 2900.}) {
      const PropertyPiece* piece = nullptr;
      for (const auto& p : printed) {
        if (p.from <= t && t < p.to) {
          piece = &p;
        }
      }
      if (m == &steel() && t == 1000) {
        piece = &printed[1];  // the second line begins where the lines cross, not at 1132 K
      }
      EXPECT_NEAR(m->enthalpy.slope(t), piece->linear, 1e-6) << m->name << " at " << t << " K";
    }
  }
}

TEST(Enthalpy, KeepsTheHeatOfTheMushyRange) {
  EXPECT_NEAR(steel().enthalpy(1683) - steel().enthalpy(1633), 50 * 5494.51, 1e-6);
  EXPECT_NEAR(aluminium().enthalpy(853) - aluminium().enthalpy(816), 37 * 10729.61, 1e-6);
}

TEST(Enthalpy, OfTheMixtureIsInvertedExactlyAtAnyConcentration) {
  double worst = 0;
  for (int c = 0; c <= 100; ++c) {
    for (double t = 250; t < 6000; t += 7.3) {
      const double back = mixture().temperature(mixture().enthalpy(t, c / 100.), c / 100.);
      worst = std::max(worst, std::abs(back - t) / t);
    }
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(Enthalpy, TheSmallestSpecificHeatIsThatOfThePiecesInReach) {
  const Mixture plate(steel(), steel());
  // 316L: 458.93 up to 922.44 K, 714.29 up to the solidus of 1633 K, 5494.51, 847.46 from 1683 K
  // on.
  EXPECT_NEAR(plate.smallest_specific_heat_near(1500, 0), 458.93, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(100, 1500, 0), 714.29, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(100, 1020, 0), 458.93, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(100, 1025, 0), 714.29, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(10, 1650, 0), 5494.51, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(20, 1670, 0), 847.46, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(100, 1650, 0), 714.29, 0.01);
  EXPECT_NEAR(plate.smallest_specific_heat_within(100, 9000, 0), 847.46, 0.01);
}

TEST(Enthalpy, OfTheMixtureIsTheMassWeightedSum) {
  for (const double t : {200., 500., 830., 922.44, 1200., 1650., 2800., 4000.}) {
    const double expected = 0.7 * steel().enthalpy(t) + 0.3 * aluminium().enthalpy(t);
    EXPECT_NEAR(mixture().enthalpy(t, 0.3), expected, 1e-12 * std::abs(expected)) << t;
  }
}

TEST(Enthalpy, RisesStrictlyWithTemperature) {
  for (const double c : {0., 0.01, 0.05, 0.5, 1.}) {
    double last = mixture().enthalpy(200, c);
    for (double t = 201; t < 6000; ++t) {
      const double now = mixture().enthalpy(t, c);
      EXPECT_GT(now, last);
      EXPECT_GT(mixture().specific_heat(t, c), 400);
      last = now;
    }
  }
}

TEST(LiquidFraction, GoesFromSolidusToLiquidusLinearlyInEnthalpy) {
  const auto fraction = [](double t) {
    return mixture().liquid_fraction(mixture().enthalpy(t, 0), 0);
  };
  EXPECT_EQ(fraction(1600), 0);
  EXPECT_NEAR(fraction(1658), 0.5, 1e-12);
  EXPECT_EQ(fraction(1700), 1);
}

TEST(Conductivity, FollowsThePrintedLinesOutsideTheMushyRangeAndIsContinuous) {
  const Property& k = steel().conductivity;
  EXPECT_NEAR(k(1000), 9.59 + 14.1, 1e-12);
  EXPECT_NEAR(k(2000), 6.60 + 24.28, 1e-12);
  EXPECT_NEAR(k(1658), (9.59 + 0.0141 * 1633 + 6.60 + 0.01214 * 1683) / 2, 1e-9);
  EXPECT_NEAR(aluminium().conductivity(834.5), 137.5, 1e-9);
  for (const double t : {816., 853., 1633., 1683.}) {
    for (const Material* m : {&steel(), &aluminium()}) {
      EXPECT_NEAR(m->conductivity(t - 1e-7), m->conductivity(t + 1e-7), 1e-5);
    }
  }
}

TEST(Viscosity, EqualsThePrintedLawOverTwentyAndStaysPositive) {
  for (double t = 1700; t <= 3000; t += 50) {
    // The printed form loses three digits to cancellation: 1e-13 of 180 is what remains comparable.
    EXPECT_NEAR(20 * steel().viscosity(t), -180.76 * std::exp(-1.95 / t) + 180.68, 2e-13 * 180);
  }
  for (double t = 900; t <= 2700; t += 50) {
    EXPECT_NEAR(20 * aluminium().viscosity(t), -163.16 * std::exp(-1.78 / t) + 163.12, 2e-13 * 163);
  }
  for (double t = 300; t <= 6000; t += 10) {
    EXPECT_GT(steel().viscosity(t), 1e-3);
    EXPECT_GT(aluminium().viscosity(t), 1e-3);
  }
}

TEST(SurfaceTension, OfSteelIsConstantThenFallsContinuouslyAndNeverTurnsNegative) {
  const Property& sigma = steel().surface_tension;
  EXPECT_EQ(sigma(1700), 1.82);
  EXPECT_EQ(sigma(2100), 1.82);
  EXPECT_NEAR(sigma(2166.0001), 1.82, 1e-7);
  EXPECT_NEAR((sigma(3000) - sigma(2500)) / 500, -1.1e-4, 1e-12);
  EXPECT_NEAR(jump(steel().printed.surface_tension, 1), 1.74e-3, 1e-9);
  EXPECT_EQ(sigma(19000), 0);
  EXPECT_EQ(aluminium().surface_tension(1500), 0.88);
}

TEST(Mixing, IsByMassFraction) {
  EXPECT_NEAR(mixture().liquidus(0.05), 0.95 * 1683 + 0.05 * 853, 1e-9);
  EXPECT_NEAR(mixture().absorptivity(0.5), 0.245, 1e-12);
  EXPECT_NEAR(mixture().density(0.3), 7763, 1e-9);
  EXPECT_EQ(mixture().molar_mass(0), 57.96e-3);
  EXPECT_EQ(aluminium().real_density, 2670);
  EXPECT_EQ(steel().real_density, 7763);
}

TEST(MissingValues, CarryAnUncertainty) {
  EXPECT_NEAR(steel().latent_heat_vaporisation, 340e3 / 55.845e-3, 5e3);
  EXPECT_NEAR(aluminium().latent_heat_vaporisation, 294e3 / 26.98e-3, 5e3);
  for (const Material* m : {&steel(), &aluminium()}) {
    EXPECT_GT(m->uncertainty.at("latent_heat_vaporisation"), 0);
    EXPECT_GT(m->uncertainty.at("emissivity"), 0);
    EXPECT_EQ(m->checksum.size(), 64U);
  }
}

TEST(Diffusivity, AsPrintedIsTwoOrdersBelowTheLiquidMetalLaw) {
  const std::string file = "data/materials/diffusivity.toml";
  const Diffusivity printed = read_diffusivity(file);
  EXPECT_EQ(printed.name, "as_printed");
  EXPECT_NEAR(printed(1683), 1.4e-11, 0.05e-11);
  const Diffusivity liquid = read_diffusivity(file, "liquid_metal");
  EXPECT_NEAR(liquid.activation_temperature, 81500 / 8.314462618, 0.5);
  EXPECT_NEAR(liquid(1873), 5.3e-9, 0.05e-9);
  EXPECT_THROW(read_diffusivity(file, "guess"), InputError);
}

// What a reader refuses.

std::string refusal(const std::string& from, const std::string& to) {
  std::string text = read_file("data/materials/316L.toml");
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  text.replace(at, from.size(), to);
  const auto path = std::filesystem::temp_directory_path() / "meltproof_material_test.toml";
  write_file(path, text);
  try {
    read_material(path);
  } catch (const InputError& error) {
    std::filesystem::remove(path);
    return error.what();
  }
  return "";
}

TEST(ReadMaterial, RefusesWithAFileAndAKey) {
  EXPECT_NE(refusal("\"1633 K\"", "\"1633 W\"").find("solidus.value"), std::string::npos);
  EXPECT_NE(refusal("[sticking]", "[stiking]").find("stiking"), std::string::npos);
  EXPECT_NE(
      refusal("constant = \"6.60 W", "constant = \"6.60 K").find("conductivity.piece[2].constant"),
      std::string::npos);
  EXPECT_NE(refusal("slope = \"5494.51", "slope = \"-5494.51").find("enthalpy.piece[2].slope"),
            std::string::npos);
}

TEST(ReadMaterial, RefusesGapsAndJumps) {
  EXPECT_NE(refusal("from = \"922.44 K\"", "from = \"923 K\"").find("enthalpy.piece[1]"),
            std::string::npos);
  EXPECT_NE(refusal("\"2.05826 N m-1\"", "\"2.06 N m-1\"")
                .find("surface_tension.piece[1]: the property jumps"),
            std::string::npos);
}

}  // namespace
}  // namespace meltproof
