// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-campaign: the statistics of several summaries, by hand.
#include <cmath>

#include "imaging/programs/program_test.hpp"

namespace meltproof::imaging {
namespace {

class Campaign : public ProgramTest {
 protected:
  /// A summary with a length and half of it as depth. @param corrected 0: without a budget.
  std::string summary(const std::string& name, double mean, double sd, double n, double effective,
                      double corrected) {
    nlohmann::json json = {{"melt_pool_found", true}, {"synthetic", "written by a test"}};
    for (const auto& [key, part] : {std::pair{"length_um", 1.0}, std::pair{"depth_um", 0.5}}) {
      json[key] = {{"mean", part * mean}, {"sd", part * sd}, {"n", n}, {"n_effective", effective}};
      if (corrected > 0) json["budget"][key]["value"] = part * corrected;
    }
    return file(name, json.dump()).string();
  }
  std::string command(const std::string& summaries) const {
    return fmt::format("{} {} --output {}", CAMPAIGN, summaries, output().string());
  }
};

TEST_F(Campaign, SeparatesScatterBetweenFramesFromThatBetweenTracks) {
  const std::string a = summary("a.json", 300, 6, 31, 10, 310),
                    b = summary("b.json", 320, 8, 41, 20, 330),
                    c = summary("c.json", 350, 10, 11, 5, 0);
  ASSERT_EQ(run(command(a + " " + b + " " + c)), 0) << text_;
  const auto result = json_of(output());
  EXPECT_EQ(result["n_tracks"], 3);
  // Corrected values count where there are any: 310, 330 and 350, of variance 400.
  EXPECT_NEAR(result["length_um"]["mean"].get<double>(), 330, 1e-9);
  EXPECT_NEAR(result["length_um"]["u_mean"].get<double>(), std::sqrt(400.0 / 3), 1e-9);
  EXPECT_NEAR(result["length_um"]["sigma_between_frames"].get<double>(),
              std::sqrt((30 * 36.0 + 40 * 64 + 10 * 100) / 80), 1e-9);
  // What independent frames scatter, over their number, is no scatter between tracks.
  EXPECT_NEAR(result["length_um"]["sigma_between_tracks"].get<double>(),
              std::sqrt(400 - (36.0 / 10 + 64.0 / 20 + 100.0 / 5) / 3), 1e-9);
  EXPECT_NEAR(result["depth_um"]["mean"].get<double>(), 165, 1e-9);
  EXPECT_EQ(result["tracks"][1]["length_um"], 330);
  EXPECT_EQ(result["tracks"][1]["synthetic"], "written by a test");
  EXPECT_EQ(result["provenance"]["inputs"].size(), 3u);
  EXPECT_NE(text_.find("3 tracks, length 330 um"), std::string::npos) << text_;
}

TEST_F(Campaign, OneTrackHasNoScatterBetweenTracks) {
  ASSERT_EQ(run(command(summary("a.json", 300, 6, 31, 10, 310))), 0) << text_;
  const auto result = json_of(output());
  EXPECT_TRUE(result["length_um"]["sigma_between_tracks"].is_null());
  EXPECT_TRUE(result["length_um"]["u_mean"].is_null());
  EXPECT_NEAR(result["length_um"]["sigma_between_frames"].get<double>(), 6, 1e-9);
}

TEST_F(Campaign, ReadsWhatTheProgramBeforeItWrites) {
  const auto film = file("film.toml", "[rosenthal]\nview = 'top'\nframes = 52\n");
  std::string summaries;
  double sum = 0;
  for (const char* seed : {"1", "2"}) {
    const std::string track = (folder_ / (std::string(seed) + ".h5")).string();
    ASSERT_EQ(run(fmt::format("{} --rosenthal --seed {} --settings {} --output {}", CAMERA, seed,
                              film.string(), track)),
              0);
    ASSERT_EQ(run(fmt::format("{} {} --output {}", THERMOGRAPHY, track, (folder_ / seed).string())),
              0)
        << text_;
    summaries += " " + (folder_ / seed / "summary.json").string();
    sum += json_of(folder_ / seed / "summary.json")["budget"]["length_um"]["value"].get<double>();
  }
  ASSERT_EQ(run(command(summaries)), 0) << text_;
  EXPECT_NEAR(json_of(output())["length_um"]["mean"].get<double>(), sum / 2, 1e-9);
}

TEST_F(Campaign, RefusesInASentenceAndWritesNothing) {
  const std::string good = summary("good.json", 300, 6, 31, 10, 310);
  expect_refusal(command(good + " " + (folder_ / "gone.json").string()), "gone.json");
  expect_refusal(command(good + " " + file("empty.json", "").string()), "empty.json");
  expect_refusal(command(file("text.json", "Monday: cleaned the lens.").string()), "text.json");
  expect_refusal(command(file("list.json", "[1, 2]").string()), "list.json");
  const std::string none = file("none.json", R"({"melt_pool_found": false})").string();
  expect_refusal(command(good + " " + none), "none.json: there is no length_um in it");
  expect_refusal(command(file("px.json", R"({"melt_pool_found": true, "length_px": {}})").string()),
                 "--calibration");
  expect_refusal(command(file("odd.json", R"({"melt_pool_found": true, "length_um": 3})").string()),
                 "make it anew");
  expect_refusal(
      command(file("odd.json", R"({"melt_pool_found": "yes", "length_um": 3})").string()),
      "odd.json");
}

}  // namespace
}  // namespace meltproof::imaging
