// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/units.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof {

TEST(Units, QuantitiesAreConverted) {
  EXPECT_DOUBLE_EQ(parse_quantity("175 W", "W"), 175.0);
  EXPECT_NEAR(parse_quantity("10 um", "m"), 1e-5, 1e-20);
  EXPECT_NEAR(parse_quantity("375 mm/s", "m s-1"), 0.375, 1e-15);
  EXPECT_NEAR(parse_quantity("1400 degC", "K"), 1673.15, 1e-9);
  EXPECT_NEAR(parse_quantity("5 %", "1"), 0.05, 1e-15);
  EXPECT_DOUBLE_EQ(parse_quantity("0.4", "1"), 0.4);
  EXPECT_DOUBLE_EQ(parse_quantity(" +2.5e3 K ", "K"), 2500);
}

TEST(Units, WhatHasNoUnitOrAnotherDimensionIsRefused) {
  EXPECT_THROW(parse_quantity("175", "W"), InputError);
  EXPECT_THROW(parse_quantity("175 m", "W"), InputError);
  EXPECT_THROW(parse_quantity("175 Wobble", "W"), InputError);
  EXPECT_THROW(parse_quantity("many W", "W"), InputError);
  try {
    parse_quantity("175 mm", "W");
    FAIL();
  } catch (const InputError& problem) {
    EXPECT_EQ(std::string(problem.what()),
              "\"mm\" has the wrong dimension: expected a quantity in W");
  }
}

TEST(Units, ShortestReadsBackToTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3, 1e-30, 175.0}) {
    EXPECT_EQ(std::stod(shortest(value)), value);
  }
}

}  // namespace meltproof
