// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/output/history.hpp"

namespace meltproof::solver {

TEST(RunSummary, NamesWhatWasFoundWhereTimeWentAndWhatWasRun) {
  Provenance provenance;
  provenance.program = "meltproof-solve";
  provenance.libraries = {{"HDF5", "1.10.8"}};
  provenance.wall_time = 100;
  provenance.threads = 2;
  nlohmann::json result = {{"title", "a track"}, {"steps", 42}, {"energy_relative_error", 3e-16}};
  result["steady_state"]["pool_length"]["sentence"] = "length of the pool: growing";
  const std::string text =
      run_summary(result, measure_acceptance({}, {}),
                  {{"heat", 60}, {"flow", 30}, {"species", 0.001}}, provenance, "run");
  for (const char* part :
       {"a track\n", "length of the pool: growing", "energy closes to 3.0e-16", "particles lost",
        "heat 1 min 0 s (60 %)", "flow 30 s (30 %)", "other 10 s", "2 threads", "42 steps",
        "HDF5 1.10.8", "run/input.toml"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  EXPECT_EQ(text.find("species 0"), std::string::npos);
  EXPECT_EQ(timings_json({{"heat", 60}})["heat_s"], 60);
}

TEST(RunSummary, TheStartIsLeftOutButNeverMostOfATrack) {
  EXPECT_EQ(start_up_length(390e-6), 130e-6);
  EXPECT_DOUBLE_EQ(start_up_length(100e-6), 40e-6);
  const auto s = track_acceptance({0, 0, 0}, {1, 1, 1}, 390e-6, 40e-6);
  EXPECT_EQ(s.from, 130e-6);
  EXPECT_DOUBLE_EQ(s.to, 312e-6);
}

TEST(History, SteadinessIsJudgedWithinTheExposure) {
  std::vector<HistoryLine> lines;
  for (int i = 0; i <= 250; ++i) {
    HistoryLine line;
    line.time = 5e-6 * i;
    // Grows while the beam is on, is gone afterwards.
    line.pool.length = i <= 208 ? -300e-6 * std::expm1(-line.time / 0.4e-3) : 0;
    line.pool.width = i <= 208 ? 1e-4 : 0;
    lines.push_back(line);
  }
  const auto found = steadiness_json(lines, 0.35e-3, 1.04e-3);
  EXPECT_EQ(found["pool_length"]["verdict"], "growing");
  EXPECT_NEAR(found["pool_length"]["limit_um"].get<double>(), 300, 0.1);
  EXPECT_NEAR(found["pool_length"]["time_constant_us"].get<double>(), 400, 1);
  EXPECT_EQ(found["pool_width"]["verdict"], "steady");
  EXPECT_NEAR(found["pool_width"]["mean_um"].get<double>(), 100, 1e-9);
  EXPECT_NEAR(found["pool_width"]["window_to_us"].get<double>(), 1040, 1e-6);
}

TEST(History, TheTableHasAsManyCellsAsColumns) {
  HistoryLine line;
  line.largest_speed = 3.5;
  line.lost_particles = 2;
  const std::string csv = history_csv({line});
  const auto head = csv.substr(0, csv.find('\n')), row = csv.substr(csv.find('\n') + 1);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_NE(row.find(",3.50000,0.00000,0.00,2,"), std::string::npos) << row;
}

}  // namespace meltproof::solver
