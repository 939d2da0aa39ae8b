// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of the alloy's freezing heat reaches the measurement.
#include "imaging/programs/program_test.hpp"

namespace meltproof::imaging {
namespace {

class FreezingHeat : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const auto film = file("film.toml", "[rosenthal]\nview = 'top'\nframes = 30\n");
    ASSERT_EQ(run(fmt::format("{} --rosenthal --settings {} --output {}", CAMERA, film.string(),
                              recording())),
              0)
        << text_;
  }
  std::string recording() const { return (folder_ / "track.h5").string(); }
  /// With a settings file of this text; the reference signal is not looked for, since only what
  /// arrives is asked for.
  std::string command(const std::string& options, const std::string& settings = "") {
    return fmt::format("{} {} --output {} --settings {} --reference-signal off {}", THERMOGRAPHY,
                       recording(), output().string(),
                       file("s.toml", settings + "[budget]\ndraws = 100\n").string(), options);
  }
  nlohmann::json parameter() const {
    const auto summary = json_of(output() / "summary.json");
    for (const auto& p : summary["parameters"])
      if (p["name"] == "freezing heat") return p;
    return nullptr;
  }
};

TEST_F(FreezingHeat, IsTakenFromTheOptionInFrontOfTheSettings) {
  EXPECT_EQ(run(command("")), 0) << text_;
  EXPECT_EQ(parameter()["source"], "unknown");
  EXPECT_TRUE(parameter()["value"].is_null());
  EXPECT_EQ(run(command("--freezing-heat 0.21")), 0) << text_;
  EXPECT_EQ(parameter()["value"], 0.21);
  EXPECT_EQ(parameter()["source"], "given");
  EXPECT_NEAR(parameter()["u"].get<double>(), 0.15 * 0.21, 1e-12);
  const std::string settings = "[reference]\nfreezing_heat = 0.3\nu_freezing_heat = 0.05\n";
  EXPECT_EQ(run(command("", settings)), 0) << text_;
  EXPECT_EQ(parameter()["value"], 0.3);
  // What is typed replaces what the file says, as --reference-temperature does; the rest stands.
  EXPECT_EQ(run(command("--freezing-heat 0.21", settings)), 0) << text_;
  EXPECT_EQ(parameter()["value"], 0.21);
  EXPECT_NEAR(parameter()["u"].get<double>(), 0.05 * 0.21, 1e-12);
}

TEST_F(FreezingHeat, NeedsNoSettingsFile) {
  EXPECT_EQ(run(fmt::format("{} {} --output {} --reference-signal off --freezing-heat '21 %'",
                            THERMOGRAPHY, recording(), output().string())),
            0)
      << text_;
  EXPECT_NEAR(parameter()["value"].get<double>(), 0.21, 1e-12);
}

TEST_F(FreezingHeat, IsRefusedOutOfBoundsAndWithAUnit) {
  expect_refusal(command("--freezing-heat 2"), "reference.freezing_heat");
  expect_refusal(command("--freezing-heat '300 kJ/kg'"), "reference.freezing_heat");
}

TEST_F(FreezingHeat, IsExplainedByHelp) {
  EXPECT_EQ(run(fmt::format("{} --help", THERMOGRAPHY)), 0);
  EXPECT_NE(text_.find("--freezing-heat"), std::string::npos) << text_;
  EXPECT_NE(text_.find("over specific heat times liquidus"), std::string::npos) << text_;
}

}  // namespace
}  // namespace meltproof::imaging
