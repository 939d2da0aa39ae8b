// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/compare/recordings.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "validation/compare/sources.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

/// One track: its value, and the variances of its scatter and of what it shares with the others.
struct Track {
  double value = 0, scatter = 0, systematic = 0;
};

Track with_budget(const json& summary, const std::string& quantity,
                  const std::filesystem::path& path) {
  Track track;
  const std::string of = "/budget/" + quantity + "_um/value";
  track.value = number_at(summary, of, path);
  const json& inputs = summary["budget"].value("inputs", json::array());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double u =
        number_at(summary, fmt::format("/budget/inputs/{}/u_{}_um", i, quantity), path);
    (inputs[i].value("type", "") == "A" ? track.scatter : track.systematic) += u * u;
  }
  return track;
}

/// Without a budget: the mean over the frames, with the parts of its u_mean.
Track of_frames(const json& summary, const std::string& quantity,
                const std::filesystem::path& path) {
  Track track;
  const std::string of = "/" + quantity + "_um";
  track.value = number_at(summary, of + "/mean", path);
  const double whole = number_at(summary, of + "/u_mean", path);
  const double frames = number_at(summary, of + "/u_parts/scatter between frames", path);
  track.scatter = frames * frames;
  track.systematic = std::max(0.0, whole * whole - track.scatter);
  return track;
}

}  // namespace

RecordedQuantity recorded_quantity(const std::vector<std::filesystem::path>& summaries,
                                   const std::string& quantity) {
  std::vector<Track> tracks;
  RecordedQuantity result;
  double mean = 0, systematic = 0;
  for (const auto& path : summaries) {
    const json summary = read_json(path);
    if (!summary.contains(quantity + "_um")) {
      throw InputError(fmt::format(
          "{}: there is no {} in um: name the summary.json of a recording in which a pool was "
          "found, evaluated with its calibration.",
          path.string(), quantity));
    }
    tracks.push_back(summary.contains("budget") ? with_budget(summary, quantity, path)
                                                : of_frames(summary, quantity, path));
    const json mark = summary.value("synthetic", json());
    result.synthetic = result.synthetic || !(mark.is_null() || mark == false || mark == "");
    mean += tracks.back().value;
    systematic += tracks.back().systematic;
  }
  if (tracks.empty()) {
    throw InputError("there are no recordings: name the summary.json of one track or more.");
  }
  const auto n = static_cast<double>(tracks.size());
  mean /= n;
  double squares = 0;
  for (const auto& track : tracks) {
    squares += std::pow(track.value - mean, 2);
  }
  const double scatter = tracks.size() > 1 ? squares / (n - 1) / n : tracks.front().scatter;
  result.scatter = std::sqrt(scatter);
  result.systematic = std::sqrt(systematic / n);
  result.datum = {mean, std::hypot(result.scatter, result.systematic), "um"};
  return result;
}

}  // namespace meltproof::validation
