// SPDX-License-Identifier: GPL-3.0-or-later
// The table that is shipped: validation/comparisons.toml.
#include <set>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "validation/compare/runner.hpp"

namespace meltproof::validation {
namespace {

ComparisonTable shipped() {
  ComparisonTable table;
  comparison_input(table).read("validation/comparisons.toml");
  check(table, "validation/comparisons.toml");
  return table;
}

const Places nothing_yet{"no/results", "no/verification.json", "data/experiments"};

TEST(ShippedTable, EveryReferenceIsThere) {
  for (const auto& row : shipped().rows) {
    SCOPED_TRACE(row.name);
    if (row.has_reference) {
      const auto campaign = reference_campaign(row, nothing_yet);
      EXPECT_NO_THROW(campaign.file(row.reference.file).column(row.reference.column));
      if (row.metric == "difference") {
        EXPECT_NO_THROW(reference_number(row, nothing_yet));
      }
    }
  }
}

TEST(ShippedTable, AllThatThePaperMeasuredIsInIt) {
  std::set<std::string> names;
  for (const auto& row : expand(shipped(), nlohmann::json::object())) {
    names.insert(row.name);
  }
  for (const char* name : {"species_stripe_2um",
                           "species_stripe_20um",
                           "conduction_slab",
                           "stefan_0.1",
                           "stefan_0.5",
                           "stefan_1",
                           "fig5_length_0wt",
                           "fig5_length_1wt",
                           "fig5_length_5wt",
                           "fig5_trend_pool",
                           "fig5_trend_any_liquid",
                           "fig7_depth",
                           "fig7_lateral",
                           "energy_track_5wt",
                           "species_track_5wt",
                           "clumped_track_5wt",
                           "lost_track_cbm_a",
                           "volume_track_0wt",
                           "refilled_track_316L_175W_750",
                           "verification_cases",
                           "bare_316l_width",
                           "bare_316l_depth"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(ShippedTable, NothingIsSkippedWhenResultsAreMissing) {
  for (const auto& result : run_table(shipped(), nothing_yet)) {
    SCOPED_TRACE(result.row.name);
    const bool waits = result.row.waits_for == "simulation";
    EXPECT_EQ(result.verdict, waits ? "pending" : "not computed");
    EXPECT_EQ(result.failure.empty(), waits);
  }
}

TEST(ShippedTable, TheLengthOfACbmTrackHasThePublishedTotalUncertainty) {
  for (const auto& row : shipped().rows) {
    if (row.name == "ambench2018_02_cbm_a_length") {
      EXPECT_NEAR(*reference_number(row, nothing_yet).uncertainty / 659, 0.055, 1e-4);
    }
  }
}

std::string refusal(const std::string& change) {
  ComparisonTable table;
  try {
    comparison_input(table).read_text(
        "[[row]]\nname = \"a\"\ntitle = \"-\"\nkind = \"verification\"\nquantity = \"-\"\nwindow = "
        "\"-\"\nmetric = \"error_norm\"\nrule = \"at_most\"\nrule_reason = \"-\"\nfigure = "
        "\"-\"\nreason = \"-\"\n" +
            change,
        "table.toml");
    check(table, "table.toml");
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "";
}

TEST(ShippedTable, AFaultyRowIsRefused) {
  const std::string simulated = "[row.simulated]\ncase = \"slab\"\n";
  EXPECT_EQ(refusal("verdict = \"agrees\"\n" + simulated), "");
  EXPECT_NE(refusal("verdict = \"perhaps\"\n" + simulated).find("perhaps"), std::string::npos);
  EXPECT_NE(refusal("verdict = \"pending\"\n" + simulated).find("waits_for"), std::string::npos);
  EXPECT_NE(
      refusal("verdict = \"agrees\"\nwaits_for = \"simulation\"\n" + simulated).find("not pending"),
      std::string::npos);
  EXPECT_NE(refusal("verdict = \"agrees\"\n").find("exactly one of"), std::string::npos);
  EXPECT_NE(refusal("verdict = \"agrees\"\n[row.simulated]\nfile = \"a.json\"\n").find("no value"),
            std::string::npos);
  EXPECT_NE(refusal("verdict = \"agrees\"\ncolour = \"red\"\n" + simulated).find("colour"),
            std::string::npos);
}

}  // namespace
}  // namespace meltproof::validation
