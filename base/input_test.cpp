// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/input.hpp"

#include <deque>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace meltproof {
namespace {

struct Case {
  double power = 175, absorptivity = 0.4;
  std::string beam = "gaussian";
  bool has_wall = false;
  double wall = 300;
  std::deque<double> lines;
};

Input declare(Case& c) {
  InputTable laser("laser", "The laser beam.");
  laser
      .quantity(c.power, {.name = "power",
                          .unit = "W",
                          .about = "Power.",
                          .required = true,
                          .minimum = 0,
                          .maximum = 1000})
      .quantity(
          c.absorptivity,
          {.name = "absorptivity", .unit = "1", .about = "Share.", .minimum = 0, .maximum = 1})
      .text(c.beam, {.name = "profile", .about = "Shape.", .choices = {"gaussian", "top-hat"}});
  InputTable wall("wall", "A wall.");
  wall.quantity(c.wall,
                {.name = "temperature", .unit = "K", .about = "Of the wall.", .required = true});
  InputTable root("case", "A case.");
  root.table(std::move(laser)).table(std::move(wall), &c.has_wall);
  root.tables("line", "Lines.", [&c](std::size_t) {
    c.lines.push_back(0);
    InputTable line("line", "A line.");
    line.quantity(c.lines.back(),
                  {.name = "length", .unit = "m", .about = "Length.", .required = true});
    return line;
  });
  return Input(std::move(root));
}

std::string refusal(const std::string& text) {
  Case c;
  auto input = declare(c);
  try {
    input.read_text(text, "case.toml");
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

}  // namespace

TEST(Input, ValuesArriveInTheDeclaredUnitAndDefaultsStay) {
  Case c;
  auto input = declare(c);
  input.read_text(
      "[laser]\npower = \"0.2 kW\"\n[wall]\ntemperature = \"100 degC\"\n[[line]]\nlength=\"2 "
      "um\"\n",
      "x");
  EXPECT_DOUBLE_EQ(c.power, 200);
  EXPECT_DOUBLE_EQ(c.absorptivity, 0.4);
  EXPECT_TRUE(c.has_wall);
  EXPECT_NEAR(c.wall, 373.15, 1e-9);
  ASSERT_EQ(c.lines.size(), 1U);
  EXPECT_NEAR(c.lines[0], 2e-6, 1e-20);
}

TEST(Input, RefusalsNameFileLineKeyFoundAndExpected) {
  EXPECT_EQ(refusal("[laser]\npower = \"175 mm\""),
            "case.toml:2: laser.power: \"mm\" has the wrong dimension: expected a quantity in W");
  EXPECT_EQ(refusal("[laser]\npower = \"175 W\"\npowr = \"1 W\""),
            "case.toml:3: laser.powr: unknown key; did you mean \"power\"?");
  EXPECT_EQ(refusal("[laser]\npower = 175"),
            "case.toml:2: laser.power: 175 has no unit: write it as text with its unit, for "
            "example \"175 W\"");
  EXPECT_EQ(refusal("[laser]\npower = \"2 kW\""),
            "case.toml:2: laser.power: 2000 W is out of bounds: expected 0 to 1000 W");
  EXPECT_NE(refusal("[laser]\n").find("laser.power: this key is missing"), std::string::npos);
  EXPECT_NE(refusal("[laser]\npower = \"nan W\"").find("out of bounds"), std::string::npos);
  EXPECT_NE(refusal("[laser]\npower = \"1 W\"\nprofile = \"round\"").find("gaussian, top-hat"),
            std::string::npos);
  EXPECT_NE(refusal("[laser\n").find("case.toml:1: this is not TOML"), std::string::npos);
  EXPECT_NE(
      refusal("[laser]\npower=\"1 W\"\n[[line]]\n").find("line[0].length: this key is missing"),
      std::string::npos);
}

TEST(Input, OverridesReplaceWhatTheFileSays) {
  const auto path = std::filesystem::temp_directory_path() / "meltproof_input_test.toml";
  std::ofstream(path) << "[laser]\npower = \"175 W\"\n";
  Case c;
  auto input = declare(c);
  input.read(path, {"laser.power=200 W", "laser.absorptivity=0.3", "wall.temperature=400 K"});
  EXPECT_DOUBLE_EQ(c.power, 200);
  EXPECT_DOUBLE_EQ(c.absorptivity, 0.3);
  EXPECT_DOUBLE_EQ(c.wall, 400);
  try {
    input.read(path, {"laser.power=200 m"});
    FAIL();
  } catch (const InputError& problem) {
    EXPECT_TRUE(std::string(problem.what())
                    .starts_with("--set laser.power: \"m\" has the wrong dimension"));
  }
  std::filesystem::remove(path);
}

TEST(Input, TheResolvedInputReadsBackToTheSameValues) {
  Case first, second;
  auto input = declare(first);
  input.read_text("[laser]\npower = \"1.23456789 W\"\n[[line]]\nlength=\"2 um\"\n", "x");
  auto again = declare(second);
  again.read_text(input.resolved(), "resolved");
  EXPECT_EQ(first.power, second.power);
  EXPECT_EQ(first.lines[0], second.lines[0]);
  EXPECT_EQ(input.resolved(), again.resolved());
}

TEST(Input, TheDeclarationYieldsSchemaAndReference) {
  Case c;
  const auto input = declare(c);
  const auto schema = input.schema();
  EXPECT_EQ(schema["properties"]["laser"]["properties"]["power"]["x-unit"], "W");
  EXPECT_EQ(schema["properties"]["laser"]["required"][0], "power");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_NE(input.reference().find("| `absorptivity` | 1 | `0.4` | 0 to 1 | Share. |"),
            std::string::npos);
}

}  // namespace meltproof
