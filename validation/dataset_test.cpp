// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/dataset.hpp"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/provenance.hpp"

namespace meltproof::validation {
namespace {

namespace fs = std::filesystem;

TEST(Campaigns, AmBench2018HoldsThePublishedMeans) {
  const auto campaign = read_campaign("data/experiments/ambench2018_02");
  const auto& table = campaign.file("geometry.csv");
  const auto length = datum(table, "length", table.row({"class = CBM-A"}));
  EXPECT_EQ(length.value, 659);
  EXPECT_EQ(length.uncertainty, 0.47);
  EXPECT_EQ(length.unit, "um");
  EXPECT_EQ(datum(table, "depth", table.row({"class = AMMT-A"})).value, 42);
  EXPECT_FALSE(datum(table, "cooling_rate_1290_1190", table.row({"class = AMMT-A"})).value);
  const auto& tracks = campaign.file("tracks.csv");
  EXPECT_EQ(tracks.rows(), 7u);
  // A longer integration time shows a longer pool: 346-350 um at 100 us, 300 um at 20 us.
  EXPECT_EQ(datum(tracks, "length", tracks.row({"class = AMMT-A", "track = 5"})).value, 350);
  EXPECT_EQ(datum(tracks, "length", tracks.row({"class = AMMT-A", "t_int = 20"})).value, 300);
}

TEST(Campaigns, AmBench2022HoldsFourCasesOfSixSections) {
  const auto campaign = read_campaign("data/experiments/ambench2022_03");
  const auto& table = campaign.file("tracks.csv");
  ASSERT_EQ(table.rows(), 4u);
  const auto depth = datum(table, "depth", table.row({"case = 1.1"}));
  EXPECT_EQ(depth.value, 227.2);
  EXPECT_EQ(depth.uncertainty, 3.2);
  EXPECT_EQ(datum(table, "width", table.row({"case = 2.2"})).value, 156.1);
}

TEST(Campaigns, TracksOf316lCarryTheScatterOfTheirReplicates) {
  const auto campaign = read_campaign("data/experiments/tracks316l");
  const auto& table = campaign.file("hofmann2026.csv");
  EXPECT_EQ(table.rows(), 8u);
  const auto row = table.row({"power = 175", "speed = 750"});
  EXPECT_EQ(datum(table, "width", row).value, 127.7);
  EXPECT_EQ(datum(table, "depth", row).value, 58.8);
  EXPECT_NEAR(*datum(table, "depth", row).uncertainty, 0.3 * 58.8, 1e-12);
  const double pair = std::abs(173.8 - 158.271) / std::sqrt(2.0) / (0.5 * (173.8 + 158.271));
  EXPECT_NEAR(*table.column("width").relative_uncertainty, pair, 5e-4);
  EXPECT_EQ(campaign.file("trapp2017.csv").obtained, "digitised");
  EXPECT_EQ(campaign.file("trapp2017.csv").rows(), 4u);
}

TEST(Campaigns, ThePaperHasTypedSlotsWithoutNumbers) {
  const auto campaign = read_campaign("data/experiments/wimmer2021");
  const auto& lengths = campaign.file("fig5_length.csv");
  EXPECT_EQ(lengths.obtained, "pending");
  for (const char* content : {"additive = 0", "additive = 1", "additive = 5"}) {
    const auto length = datum(lengths, "length", lengths.row({content}));
    EXPECT_FALSE(length.value);
    EXPECT_EQ(length.unit, "um");
  }
  for (const char* name : {"fig7_depth.csv", "fig7_lateral.csv"}) {
    EXPECT_EQ(campaign.file(name).obtained, "pending");
    EXPECT_EQ(campaign.file(name).rows(), 0u);
    EXPECT_EQ(campaign.file(name).columns.size(), 3u);
  }
  const auto& ranks = campaign.file("fig5_trend.csv").column("length_rank").numbers;
  EXPECT_TRUE(ranks[0] < ranks[1] && ranks[1] < ranks[2]);
}

/// Writes a campaign of synthetic numbers and returns the sentence with which it is refused.
std::string refusal(const std::string& csv, const std::string& toml, bool right_checksum = true) {
  const fs::path folder = fs::path(testing::TempDir()) / "synthetic_campaign";
  fs::remove_all(folder);
  fs::create_directories(folder);
  if (!csv.empty()) {
    std::ofstream(folder / "a.csv") << csv;
  }
  const std::string sum =
      right_checksum && !csv.empty() ? sha256_file(folder / "a.csv") : std::string(64, '0');
  std::ofstream(folder / "dataset.toml")
      << "title = \"synthetic\"\nauthors = []\ndoi = \"-\"\nlicence = \"-\"\nabout = \"-\"\n"
      << "[[file]]\nname = \"a.csv\"\nabout = \"-\"\nsha256 = \"" << sum << "\"\n"
      << toml;
  try {
    read_campaign(folder);
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

const std::string declared =
    "obtained = \"measured\"\ncolumn = [{name = \"length\", unit = \"um\", about = \"-\"}, "
    "{name = \"u\", unit = \"um\", about = \"-\"}]\n";

TEST(Campaigns, AGoodOneIsRead) { EXPECT_EQ(refusal("length [um],u [um]\n1,0.1\n", declared), ""); }

TEST(Campaigns, EveryFaultIsASentenceOfItsOwn) {
  EXPECT_NE(refusal("", declared).find("a.csv that it names is missing"), std::string::npos);
  EXPECT_NE(refusal("length [um],u [um]\n1,0.1\n", declared, false).find("SHA-256"),
            std::string::npos);
  EXPECT_NE(refusal("length [um]\n1\n", declared).find("a column \"u\" that the header does not"),
            std::string::npos);
  EXPECT_NE(refusal("length [mm],u [um]\n1,0.1\n", declared)
                .find("[mm] in the header where dataset.toml "
                      "declares [um]"),
            std::string::npos);
  EXPECT_NE(refusal("length [um],u [um],v [um]\n1,0.1,2\n", declared).find("has 3 columns"),
            std::string::npos);
  EXPECT_NE(refusal("length [um],u [um]\n1,many\n", declared).find(":2: \"many\""),
            std::string::npos);
  EXPECT_NE(refusal("length [um],u [um]\n1\n", declared).find("found 1 cells"), std::string::npos);
  EXPECT_NE(refusal("", "obtained = \"guessed\"\ncolumn = []\n").find("guessed"),
            std::string::npos);
  EXPECT_NE(refusal("l [wide]\n",
                    "obtained = \"measured\"\ncolumn = [{name = \"l\", unit = "
                    "\"wide\", about = \"-\"}]\n")
                .find("wide"),
            std::string::npos);
}

TEST(Campaigns, APendingSlotMustBeEmpty) {
  const std::string slot =
      "obtained = \"pending\"\ncolumn = [{name = \"length\", unit = \"um\", about = \"-\", "
      "uncertainty = \"u\"}, {name = \"u\", unit = \"um\", about = \"-\"}]\n";
  EXPECT_EQ(refusal("length [um],u [um]\n,\n", slot), "");
  EXPECT_NE(refusal("length [um],u [um]\n300,\n", slot).find("although dataset.toml says"),
            std::string::npos);
}

TEST(Campaigns, ARowSelectorMustPickOneRow) {
  const auto campaign = read_campaign("data/experiments/tracks316l");
  const auto& table = campaign.file("hofmann2026.csv");
  EXPECT_THROW(table.row({"power = 175"}), InputError);
  EXPECT_THROW(table.row({"power = 1"}), InputError);
  EXPECT_THROW(table.row({"power"}), InputError);
  EXPECT_THROW(table.row({"might = 175"}), InputError);
  EXPECT_THROW(read_campaign("data/experiments/nowhere"), InputError);
}

}  // namespace
}  // namespace meltproof::validation
