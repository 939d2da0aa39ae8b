// SPDX-License-Identifier: GPL-3.0-or-later
// uniform_cold and uniform_hot: a synthetic pool seen by pixels of uneven offset and gain measures
// as the same pool seen by even pixels, but only with the two references.
#include <algorithm>
#include <cmath>

#include "imaging/programs/program_test.hpp"
#include "imaging/recording/synthetic_files.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::size_t width = 80, height = 40, pixels = width * height, frames = 24;
// A pixel on the pool's way that sees nothing, beside the axis on which the length is measured.
constexpr std::size_t dead = 17 * width + 40;

/// Deviations of pixel i from -1 to 1; those of the picture's two halves cancel.
double deviation(std::size_t i, unsigned seed) {
  const bool second = i >= pixels / 2;
  unsigned x = static_cast<unsigned>(second ? i - pixels / 2 : i) * 2654435761U + seed;
  x ^= x >> 15;
  x *= 2246822519U;
  x ^= x >> 13;
  const double d = static_cast<double>(x) / 2147483648.0 - 1;
  return second ? -d : d;
}

/// Counts of a camera whose pixel i has the offset 200 d and the gain 1 + 0.3 d.
synthetic::Picture seen(const std::vector<double>& signal, bool uneven) {
  synthetic::Picture p{width, height, std::vector<std::uint16_t>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    double counts = signal[i];
    if (uneven) counts = 200 * deviation(i, 1) + (1 + 0.3 * deviation(i, 77)) * counts;
    if (uneven && i == dead) counts = 3000;
    p.counts[i] = static_cast<std::uint16_t>(std::lround(std::clamp(counts, 0.0, 16383.0)));
  }
  return p;
}

synthetic::Picture uniform(double signal, bool uneven = true) {
  return seen(std::vector<double>(pixels, signal), uneven);
}

std::string track(bool uneven) {
  std::vector<synthetic::Picture> film;
  for (std::size_t k = 0; k < frames; ++k) {
    std::vector<double> signal(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      const double x = (static_cast<double>(i % width) - 20 - 2 * static_cast<double>(k)) / 8;
      const double y = (static_cast<double>(i / width) - 20) / 4;
      signal[i] = 600 + 9000 * std::exp(-(x * x + y * y) / 2);
    }
    film.push_back(seen(signal, uneven));
  }
  return synthetic::ptw(film);
}

class Uniform : public ProgramTest {
 protected:
  std::string command(const std::string& recording, const std::string& settings = "") {
    std::string text = fmt::format("{} {} --output {} --level 4000", THERMOGRAPHY,
                                   (folder_ / recording).string(), output().string());
    if (!settings.empty()) text += " --settings " + file("settings.toml", settings).string();
    return text;
  }
  std::vector<double> lengths(const std::string& recording, const std::string& settings = "") {
    EXPECT_EQ(run(command(recording, settings)), 0) << text_;
    return column(output() / "frames.csv", "length");
  }
  void SetUp() override {
    ProgramTest::SetUp();
    file("even.ptw", track(false));
    file("uneven.ptw", track(true));
    file("cold.ptw", synthetic::ptw({uniform(800), uniform(800)}));
    file("hot.ptw", synthetic::ptw({uniform(6000), uniform(6000)}));
  }
};

const std::string both = "uniform_cold = 'cold.ptw'\nuniform_hot = 'hot.ptw'\n";

TEST_F(Uniform, ReferencesGiveThePoolOfEvenPixels) {
  const auto even = lengths("even.ptw"), uneven = lengths("uneven.ptw");
  const auto mended = lengths("uneven.ptw", both);
  ASSERT_EQ(mended.size(), frames);
  double worst = 0, without = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    worst = std::max(worst, std::abs(mended[k] - even[k]));
    without = std::max(without, std::abs(uneven[k] - even[k]));
  }
  EXPECT_LT(worst, 0.05);  // px, of 20; counts are whole numbers
  EXPECT_GT(without, 0.5);
  const auto summary = json_of(output() / "summary.json");
  EXPECT_NE(summary["notes"].dump().find("1 dead pixel"), std::string::npos) << summary["notes"];
  EXPECT_NE(summary["notes"].dump().find("gains differed by 17 %"), std::string::npos)
      << summary["notes"];  // 0.3 over the root of 3
  for (const double n : column(output() / "frames.csv", "dead")) EXPECT_EQ(n, 1);
  // Whoever asks what the result rests on finds the references with their checksums.
  EXPECT_NE(summary["provenance"]["inputs"].dump().find("hot.ptw"), std::string::npos);
}

TEST_F(Uniform, ASaturatedPixelStaysMarkedWhateverItsGain) {
  std::vector<double> signal(pixels, 600);
  for (std::size_t i = 0; i < 400; ++i) signal[i] = 40000;
  file("bright.ptw", synthetic::ptw({seen(signal, true)}));
  run(command("bright.ptw", both));
  EXPECT_EQ(column(output() / "frames.csv", "saturated"), std::vector<double>{400}) << text_;
}

TEST_F(Uniform, WhatIsWrongWithReferencesIsSaidInASentence) {
  expect_refusal(command("uneven.ptw", "uniform_cold = 'cold.ptw'\n"), "belong together");
  expect_refusal(command("uneven.ptw", "uniform_cold = 'hot.ptw'\nuniform_hot = 'cold.ptw'\n"),
                 "cold.ptw: The hot reference is not brighter");
  expect_refusal(command("uneven.ptw", "uniform_cold = 'gone.ptw'\nuniform_hot = 'hot.ptw'\n"),
                 "gone.ptw");
  file("small.ptw", synthetic::ptw({synthetic::scene(9, 6, 0)}));
  expect_refusal(command("uneven.ptw", "uniform_cold = 'small.ptw'\nuniform_hot = 'hot.ptw'\n"),
                 "small.ptw: the reference has 9 x 6 pixels, the recording 80 x 40");
  file("seven.ptw", synthetic::ptw({synthetic::scene(7, 6, 0)}));
  expect_refusal(command("seven.ptw", both), "cold.ptw: the reference has 80 x 40 pixels");
  // As many pixels, but of another window.
  file("turned.ptw", synthetic::ptw({synthetic::scene(height, width, 0)}));
  expect_refusal(command("turned.ptw", both), "the recording 40 x 80");
  file("notes.txt", "no recording\n");
  expect_refusal(command("uneven.ptw", "uniform_cold = 'notes.txt'\nuniform_hot = 'hot.ptw'\n"),
                 "notes.txt");
}

}  // namespace
}  // namespace meltproof::imaging
