// SPDX-License-Identifier: GPL-3.0-or-later
// How long the rest of a run will take, where its melt has still to grow.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace meltproof::solver {

/// **An estimate of the time left.** What a run costs grows with its melt, so early steps say too
/// little of later ones. How the melt grows is nearly the same at any spacing: a coarser run of the
/// same track has shown it, and this run's own steps show what a microsecond costs with that much
/// melt, seconds = a + b V by least squares, neither negative. The sum of that over the rest of the
/// coarser run is the time left.
class TimeLeft {
 public:
  struct Melt {
    double time = 0;    ///< s
    double volume = 0;  ///< m3, liquid
  };
  /// Nothing is known of the melt: no estimate.
  TimeLeft() = default;
  /// @param coarser of a run of the same track, in the order of time.
  explicit TimeLeft(std::vector<Melt> coarser) : coarser_(std::move(coarser)) {}

  /// @param span simulated time, s; @param seconds that it took; @param volume of melt in it, m3.
  void add(double span, double seconds, double volume);
  /// Seconds of wall-clock time from `now` (s, simulated) to the end of the coarser run; none
  /// before three spans, or without a coarser run.
  std::optional<double> seconds(double now) const;

 private:
  std::vector<Melt> coarser_;
  // Sums of least squares over spans, each weighted by its length.
  std::size_t spans_ = 0;
  double w_ = 0, wv_ = 0, wvv_ = 0, wy_ = 0, wvy_ = 0;
};

/// Time and liquid volume of a history.csv. @throws InputError if the file cannot be read, lacks
/// one of the two columns, or has a line with something else than numbers in them.
std::vector<TimeLeft::Melt> read_melt(const std::filesystem::path& history);

}  // namespace meltproof::solver
