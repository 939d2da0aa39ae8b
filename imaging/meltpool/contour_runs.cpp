// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/contour_runs.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace meltproof::imaging {
namespace {

/// Where `mark` comes next, or `end`. memchr looks at many bytes at once.
const std::uint8_t* next(const std::uint8_t* from, const std::uint8_t* end, std::uint8_t mark) {
  const void* const found = std::memchr(from, mark, static_cast<std::size_t>(end - from));
  return found == nullptr ? end : static_cast<const std::uint8_t*>(found);
}

}  // namespace

std::size_t RunFinder::root(std::size_t run) {
  while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
  return run;
}

void RunFinder::unite(std::size_t a, std::size_t b) {
  a = root(a);
  b = root(b);
  // The earlier run leads, so that the order of the regions is that of their first pixels.
  parent_[std::max(a, b)] = std::min(a, b);
}

/// Joins the runs from `begin` on, all of one row, with those from `above` to `begin`, which are
/// the row above it.
void RunFinder::join_row(std::size_t above, std::size_t begin, const Joined& joined) {
  std::size_t first = above;
  for (std::size_t i = begin; i < runs_.size(); ++i) {
    const Run run = runs_[i];
    while (first < begin && runs_[first].end < run.begin) ++first;
    for (std::size_t k = first; k < begin && runs_[k].begin <= run.end; ++k) {
      // Beside a corner that two runs share the other two pixels of the square are dark.
      const bool corner = runs_[k].end == run.begin || runs_[k].begin == run.end;
      const std::ptrdiff_t x = (runs_[k].end == run.begin ? run.begin : run.end) - 1;
      if (!corner || joined(static_cast<std::size_t>(x), static_cast<std::size_t>(run.row - 1)))
        unite(k, i);
    }
  }
}

std::span<const Run> RunFinder::largest(std::span<const std::uint8_t> marks, std::size_t width,
                                        const Joined& joined, const std::optional<Near>& near) {
  runs_.clear();
  parent_.clear();
  const std::uint8_t* const start = marks.data();
  const std::uint8_t* const stop = start + marks.size();
  std::size_t above = 0;  // first run of the row above
  for (const std::uint8_t* p = next(start, stop, 1); p != stop;) {
    const std::size_t row = static_cast<std::size_t>(p - start) / width;
    const std::uint8_t* const row_start = start + row * width;
    const std::uint8_t* const row_stop = row_start + width;
    const std::size_t begin = runs_.size();
    while (p != row_stop) {
      const std::uint8_t* const end = next(p, row_stop, 0);
      parent_.push_back(runs_.size());
      runs_.push_back({static_cast<std::ptrdiff_t>(row), p - row_start, end - row_start});
      p = next(end, row_stop, 1);
    }
    const bool adjacent = above < begin && runs_[above].row + 1 == static_cast<std::ptrdiff_t>(row);
    if (adjacent) join_row(above, begin, joined);
    above = begin;
    p = next(row_stop, stop, 1);
  }

  totals_.assign(runs_.size(), {});
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    Total& total = totals_[root(i)];
    const auto n = static_cast<std::size_t>(runs_[i].end - runs_[i].begin);
    total.pixels += n;
    // Sums of whole numbers, exact as long as they stay below 2^53.
    total.x +=
        0.5 * static_cast<double>(n) * static_cast<double>(runs_[i].begin + runs_[i].end - 1);
    total.y += static_cast<double>(n) * static_cast<double>(runs_[i].row);
  }
  const auto is_near = [&](const Total& t) {
    const auto n = static_cast<double>(t.pixels);
    return std::hypot(t.x / n - near->place.x, t.y / n - near->place.y) <= near->distance;
  };
  std::size_t best = 0, most = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i)
    if (totals_[i].pixels > most && (!near || is_near(totals_[i]))) {
      most = totals_[i].pixels;
      best = i;
    }
  if (most == 0) return {};
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i)
    if (root(i) == best) runs_[kept++] = runs_[i];
  return {runs_.data(), kept};
}

}  // namespace meltproof::imaging
