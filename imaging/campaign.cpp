// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-campaign: statistics over the tracks of a campaign.
#include "imaging/meltpool/campaign.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"

namespace {

/// Reads a summary by itself: what is of another type than it should be is told with its file.
void check_summary(const std::filesystem::path& path) {
  try {
    static_cast<void>(meltproof::imaging::campaign({path}));
  } catch (const nlohmann::json::exception&) {
    throw meltproof::InputError(path.string() +
                                ": it is not what meltproof-thermography writes; make it anew.");
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace meltproof;
  Program program("meltproof-campaign",
                  "Takes the summary.json of several tracks and gives mean length and depth with "
                  "their spread between frames and between tracks.\n"
                  "Example: meltproof-campaign track_*/summary.json --output campaign.json");
  std::vector<std::filesystem::path> summaries;
  std::string output;
  program.app.add_option("summaries", summaries, "summary.json of every track")->required();
  program.app.add_option("-o,--output", output, "JSON file to write")->required();
  return program.run(argc, argv, [&] {
    Provenance provenance = begin_provenance(argc, argv);
    for (const auto& path : summaries)
      if (std::filesystem::exists(path)) provenance.add_input(path);
    for (const auto& path : summaries) check_summary(path);
    nlohmann::json result = imaging::campaign(summaries);
    provenance.wall_time = provenance.elapsed();
    result["provenance"] = provenance.json();
    AtomicFile file(output);
    write_file(file.temporary(), result.dump(2) + "\n");
    file.commit();
    if (!program.quiet())
      fmt::print("{} tracks, length {:.5g} um; written to {}.\n", summaries.size(),
                 result["length_um"]["mean"].get<double>(), output);
    return ExitStatus::success;
  });
}
