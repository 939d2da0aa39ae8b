// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/campaign.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof::imaging {

using nlohmann::json;

CampaignStatistics campaign_statistics(const std::vector<TrackMean>& tracks) {
  CampaignStatistics s;
  s.tracks = tracks.size();
  const auto n = static_cast<double>(tracks.size());
  double within = 0, freedom = 0, explained = 0;
  for (const auto& t : tracks) {
    s.mean += t.value / n;
    if (t.n > 1) {
      within += (t.n - 1) * t.deviation * t.deviation;
      freedom += t.n - 1;
      explained += t.deviation * t.deviation / std::max(t.effective, 1.0) / n;
    }
  }
  s.between_frames = freedom > 0 ? std::sqrt(within / freedom) : 0;
  if (tracks.size() < 2) return s;
  double squares = 0;
  for (const auto& t : tracks) squares += (t.value - s.mean) * (t.value - s.mean);
  const double variance = squares / (n - 1);
  s.between_tracks = std::sqrt(std::max(0.0, variance - explained));
  s.u_mean = std::sqrt(variance / n);
  return s;
}

namespace {

TrackMean track_of(const json& summary, const std::string& name, const std::string& file) {
  const std::string key = name + "_um";
  if (!summary.value("melt_pool_found", false) || !summary.contains(key))
    throw InputError(
        fmt::format("{}: there is no {} in it; give the summary.json of a recording "
                    "with a melt pool that was measured with --calibration.",
                    file, key));
  TrackMean t;
  try {
    const json& plain = summary.at(key);
    t = {plain.at("mean").get<double>(), plain.at("sd").get<double>(), plain.at("n").get<double>(),
         plain.at("n_effective").get<double>()};
    if (summary.contains("budget"))
      t.value = summary.at("budget").at(key).at("value").get<double>();
  } catch (const json::exception&) {
    throw InputError(
        fmt::format("{}: {} is not what meltproof-thermography writes; make it anew.", file, key));
  }
  return t;
}

}  // namespace

json campaign(const std::vector<std::filesystem::path>& summaries) {
  if (summaries.empty())
    throw InputError("There are no summaries; name the summary.json of one track or more.");
  std::vector<TrackMean> lengths, depths;
  json tracks = json::array();
  for (const auto& path : summaries) {
    const json summary = json::parse(read_file(path), nullptr, false);
    if (!summary.is_object())
      throw InputError(
          fmt::format("{} is no JSON object; give the summary.json of "
                      "meltproof-thermography.",
                      path.string()));
    lengths.push_back(track_of(summary, "length", path.string()));
    depths.push_back(track_of(summary, "depth", path.string()));
    tracks.push_back({{"summary", path.string()},
                      {"synthetic", summary.value("synthetic", json(nullptr))},
                      {"length_um", lengths.back().value},
                      {"depth_um", depths.back().value}});
  }
  const auto statistics = [](const std::vector<TrackMean>& values) {
    const CampaignStatistics s = campaign_statistics(values);
    return json{{"mean", s.mean},
                {"sigma_between_frames", s.between_frames},
                {"sigma_between_tracks", s.tracks > 1 ? json(s.between_tracks) : json(nullptr)},
                {"u_mean", s.tracks > 1 ? json(s.u_mean) : json(nullptr)}};
  };
  return {{"tracks", tracks},
          {"n_tracks", summaries.size()},
          {"length_um", statistics(lengths)},
          {"depth_um", statistics(depths)}};
}

}  // namespace meltproof::imaging
