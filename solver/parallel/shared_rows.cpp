// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/shared_rows.hpp"

#include <algorithm>
#include <numeric>

namespace meltproof::solver {

std::size_t SharedRows::begin(const Ranks& ranks, std::size_t range, int r) {
  const auto size = static_cast<std::size_t>(ranks.size()), at = static_cast<std::size_t>(r);
  const std::size_t blocks = (range + block - 1) / block;
  return std::min(range, block * (blocks * at / size));
}

SharedRows::SharedRows(const Ranks& ranks, std::span<const std::int64_t> identity,
                       std::vector<std::uint32_t> own, std::size_t range)
    : ranks_(ranks), own_(std::move(own)) {
  std::sort(own_.begin(), own_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return identity[a] < identity[b]; });
  const auto size = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<std::int64_t>> to(size);
  std::size_t r = 0;
  for (const std::uint32_t i : own_) {
    while (static_cast<std::size_t>(identity[i]) >= begin(ranks_, range, static_cast<int>(r) + 1)) {
      ++r;
    }
    to[r].push_back(identity[i]);
  }
  std::vector<std::vector<std::int64_t>> counts(size);
  for (std::size_t k = 0; k < size; ++k) {
    leaves_.push_back(static_cast<int>(to[k].size()));
    counts[k] = {leaves_.back()};
  }
  for (const std::int64_t n : ranks_.exchange(counts)) {
    arrives_.push_back(static_cast<int>(n));
  }
  const std::vector<std::int64_t> arrived = ranks_.exchange(to);
  std::vector<std::uint32_t> sorted(arrived.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(),
            [&](std::uint32_t a, std::uint32_t b) { return arrived[a] < arrived[b]; });
  place_.resize(arrived.size());
  for (std::uint32_t k = 0; k < sorted.size(); ++k) {
    place_[sorted[k]] = k;
  }
  const std::size_t lowest = begin(ranks_, range, ranks_.rank()),
                    end = begin(ranks_, range, ranks_.rank() + 1);
  in_blocks_.assign((end - lowest + block - 1) / block, 0);
  for (const std::int64_t id : arrived) {
    ++in_blocks_[(static_cast<std::size_t>(id) - lowest) / block];
  }
  total_ = ranks_.add(static_cast<std::uint64_t>(count()));
  first_ = ranks_.before(count());
}

}  // namespace meltproof::solver
