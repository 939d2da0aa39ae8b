// SPDX-License-Identifier: GPL-3.0-or-later
// The programs as a user meets them: bad input is a sentence and a status, results are whole,
// threads do not matter.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"

namespace meltproof {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = 0;
  std::string output;  ///< standard output and standard error
};

Outcome call(const std::string& command) {
  Outcome outcome;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 512> block{};
  while (std::fgets(block.data(), block.size(), pipe) != nullptr) {
    outcome.output += block.data();
  }
  const int status = ::pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

fs::path fresh(const std::string& name) {
  const fs::path folder = fs::temp_directory_path() / ("meltproof_program_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

const std::string solve = SOLVE;
const std::string coarse =
    " --set spacing=\"16 um\" --set laser.exposure=\"0.1 ms\" --set domain.width=\"240 um\" --set "
    "domain.depth=\"96 um\"";

}  // namespace

TEST(SolveProgram, BadInputIsASentenceAndLeavesNothing) {
  const fs::path folder = fresh("bad");
  const std::string bare =
      solve + " solver/cases/track_316L_175W_750.toml --output " + (folder / "run").string();
  const auto refuse = [&](const std::string& command, const std::string& sentence) {
    const Outcome outcome = call(command);
    EXPECT_EQ(outcome.status, 2) << command << "\n" << outcome.output;
    EXPECT_NE(outcome.output.find(sentence), std::string::npos) << outcome.output;
  };
  refuse(bare + " --set laser.power=\"175 mm\"",
         "laser.power: \"mm\" has the wrong dimension: expected a quantity in W");
  refuse(bare + " --set laser.powr=\"175 W\"", "laser.powr: unknown key; did you mean \"power\"?");
  refuse(bare + " --set spacing=\"30 um\"", "needs a spacing of at most 20 um");
  refuse(bare + " --set materials.base=nowhere.toml", "there is no file nowhere.toml");
  refuse(solve + " nowhere.toml --output " + folder.string(),
         "nowhere.toml cannot be opened: there is no such file");
  refuse(solve + " solver/cases/track_1wt.toml --output " + (folder / "run").string(),
         "give it by --powder");
  refuse(solve + " solver/cases/track_1wt.toml --powder README.md --output " +
             (folder / "run").string(),
         "is not an HDF5 file");
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(SolveProgram, ValidateSchemaAndReferenceNeedNoRun) {
  EXPECT_NE(call(solve + " --schema").output.find("\"x-unit\": \"W\""), std::string::npos);
  EXPECT_NE(call(solve + " --reference").output.find("| `power` | W | required |"),
            std::string::npos);
  EXPECT_NE(call(solve + " solver/cases/track_316L_175W_750.toml --validate")
                .output.find("power = \"175 W\""),
            std::string::npos);
}

TEST(SolveProgram, OneAndTwoThreadsGiveTheSameBytesInEveryField) {
  const fs::path folder = fresh("threads");
  const std::string bed = (folder / "powder.h5").string();
  ASSERT_EQ(call(std::string(POWDER) + " solver/cases/powder_5wt.toml --output " + bed).status, 0);
  for (const std::string threads : {"1", "2"}) {
    const Outcome outcome =
        call(solve + " solver/cases/track_5wt.toml --powder " + bed + " --output " +
             (folder / threads).string() + " --threads " + threads + coarse);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
  }
  EXPECT_EQ(read_file(folder / "1" / "history.csv"), read_file(folder / "2" / "history.csv"));
  const ArtifactReader one(folder / "1" / "run.h5", "meltproof run"),
      two(folder / "2" / "run.h5", "meltproof run");
  std::size_t compared = 0;
  const std::function<void(const std::string&)> compare = [&](const std::string& group) {
    for (const auto& name : one.names(group.empty() ? "/" : group)) {
      const std::string path = group.empty() ? name : group + "/" + name;
      if (path == "provenance") {
        continue;  // command, threads and wall time are to differ
      }
      if (path == "snapshots" || path == "domain" || group == "snapshots") {
        compare(path);
        continue;
      }
      ASSERT_TRUE(two.has(path)) << path;
      EXPECT_EQ(one.read<double>(path).values, two.read<double>(path).values) << path;
      EXPECT_FALSE(one.units(path).empty()) << path;
      ++compared;
    }
  };
  compare("");
  EXPECT_GT(compared, 20U);
}

TEST(SolveProgram, AKilledRunLeavesNoHalfArtifact) {
  const fs::path folder = fresh("killed");
  call("timeout -s KILL 1 " + solve + " solver/cases/track_316L_175W_750.toml --output " +
       folder.string());
  EXPECT_FALSE(fs::exists(folder / "run.h5"));
  EXPECT_FALSE(fs::exists(folder / "result.json"));
}

}  // namespace meltproof
