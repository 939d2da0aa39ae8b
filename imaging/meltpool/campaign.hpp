// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics over the tracks of a campaign.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof::imaging {

/// One track's length or depth.
struct TrackMean {
  double value = 0;      ///< mean over its frames, corrected where the summary has a correction
  double deviation = 0;  ///< between its frames
  double n = 0;          ///< frames
  double effective = 0;  ///< independent frames
};

/// Spread within and between tracks (analysis of variance with tracks as a random effect).
struct CampaignStatistics {
  std::size_t tracks = 0;
  double mean = 0;            ///< of the tracks, each with the same weight
  double between_frames = 0;  ///< standard deviation within a track, pooled by frames
  double between_tracks = 0;  ///< standard deviation of the tracks' own means, scatter taken off
  double u_mean = 0;  ///< standard deviation of the tracks' means over the root of their number
};

/// The variance of the tracks' means less the part that their scatter between frames explains,
/// deviation^2 / effective on average; not below zero. @param tracks at least one.
CampaignStatistics campaign_statistics(const std::vector<TrackMean>& tracks);

/// Reads summaries of meltproof-thermography and gives length and depth over them.
/// @throws InputError naming the file that is no summary, has no pool, or has another unit.
nlohmann::json campaign(const std::vector<std::filesystem::path>& summaries);

}  // namespace meltproof::imaging
