// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/time_left.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::solver {

void TimeLeft::add(double span, double seconds, double volume) {
  if (!(span > 0)) {
    return;
  }
  const double rate = seconds / span;
  ++spans_;
  w_ += span;
  wv_ += span * volume;
  wvv_ += span * volume * volume;
  wy_ += span * rate;
  wvy_ += span * volume * rate;
}

std::optional<double> TimeLeft::seconds(double now) const {
  if (spans_ < 3 || coarser_.size() < 2) {
    return {};
  }
  const double spread = w_ * wvv_ - wv_ * wv_;
  // One and the same volume tells nothing of how cost grows with it.
  double per_volume = spread > 1e-9 * w_ * wvv_ ? (w_ * wvy_ - wv_ * wy_) / spread : 0;
  double fixed = (wy_ - per_volume * wv_) / w_;
  if (per_volume < 0) {
    per_volume = 0;
    fixed = wy_ / w_;
  } else if (fixed < 0) {
    fixed = 0;
    per_volume = wvy_ / wvv_;
  }
  double left = 0;
  for (std::size_t k = 1; k < coarser_.size(); ++k) {
    const Melt &a = coarser_[k - 1], &b = coarser_[k];
    const double span = b.time - std::max(a.time, now);
    if (span > 0) {
      left += span * (fixed + per_volume * (a.volume + b.volume) / 2);
    }
  }
  return left;
}

std::vector<TimeLeft::Melt> read_melt(const std::filesystem::path& history) {
  std::ifstream file(history);
  if (!file) {
    throw InputError(history.string() +
                     " cannot be opened; give the history.csv of a coarser run of this track.");
  }
  const auto cells = [](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream rest(line);
    for (std::string cell; std::getline(rest, cell, ',');) {
      found.push_back(cell);
    }
    return found;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = cells(line);
  std::array<std::size_t, 2> column{};
  const std::array<std::string, 2> names{"time [us]", "liquid_volume [um3]"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto at = std::find(header.begin(), header.end(), names[k]);
    if (at == header.end()) {
      throw InputError(fmt::format("{}: there is no column \"{}\"; give the history.csv of a run.",
                                   history.string(), names[k]));
    }
    column[k] = static_cast<std::size_t>(at - header.begin());
  }
  std::vector<TimeLeft::Melt> melt;
  for (std::size_t number = 2; std::getline(file, line); ++number) {
    const std::vector<std::string> row = cells(line);
    std::array<double, 2> value{};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string cell = column[k] < row.size() ? row[column[k]] : "";
      std::istringstream text(cell);
      if (!(text >> value[k]) || !text.eof()) {
        throw InputError(fmt::format("{}, line {}: \"{}\" in the column \"{}\" is no number.",
                                     history.string(), number, cell, names[k]));
      }
    }
    melt.push_back({1e-6 * value[0], 1e-18 * value[1]});
  }
  return melt;
}

}  // namespace meltproof::solver
