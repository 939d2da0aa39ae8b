// SPDX-License-Identifier: GPL-3.0-or-later
// Where each rank stores its part of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/parallel/ranks.hpp"

namespace meltproof::solver {

/// **Rows by identity.** In files particles stand by increasing identity, so that a row is the same
/// particle for life; on the ranks they are where they happen to be in space. Each rank stores the
/// rows of one range of identities, a piece of the file without gaps: values go there first, of one
/// field at a time, so no rank ever holds more than its share of one field. The ranges begin at
/// multiples of `block` identities, whatever the number of ranks.
class SharedRows {
 public:
  static constexpr std::size_t block = 1024;

  /// Collective. @param identity per entry of this rank's particles, at least zero; @param own the
  /// entries of those who get a row; @param range identities lie below it, the same on all ranks.
  SharedRows(const Ranks& ranks, std::span<const std::int64_t> identity,
             std::vector<std::uint32_t> own, std::size_t range);

  /// Where the identities of rank r begin that has its part of `range`.
  static std::size_t begin(const Ranks& ranks, std::size_t range, int r);

  std::size_t total() const { return total_; }  ///< rows, on all ranks
  std::size_t first() const { return first_; }  ///< row of this rank
  std::size_t count() const { return place_.size(); }
  /// Rows of every block of this rank's identities.
  const std::vector<std::size_t>& in_blocks() const { return in_blocks_; }

  /// The values of this rank's rows, `width` numbers each. Collective. @param value(i, out) writes
  /// those of entry i.
  template <class T, class Value>
  std::vector<T> bring(std::size_t width, const Value& value) const {
    std::vector<T> leaving(width * own_.size());
    for (std::size_t k = 0; k < own_.size(); ++k) {
      value(own_[k], &leaving[width * k]);
    }
    if (ranks_.alone()) {
      return leaving;
    }
    std::vector<T> arrived(width * count());
    ranks_.exchange_rows(leaving.data(), leaves_, arrived.data(), arrives_, width * sizeof(T));
    leaving = {};
    std::vector<T> rows(arrived.size());
    for (std::size_t k = 0; k < place_.size(); ++k) {
      for (std::size_t c = 0; c < width; ++c) {
        rows[width * place_[k] + c] = arrived[width * k + c];
      }
    }
    return rows;
  }

 private:
  Ranks ranks_;
  std::vector<std::uint32_t> own_;    // by identity, and so by the rank that stores them
  std::vector<std::uint32_t> place_;  // row, from first_ on, of what arrives
  std::vector<int> leaves_, arrives_;
  std::vector<std::size_t> in_blocks_;
  std::size_t first_ = 0, total_ = 0;
};

}  // namespace meltproof::solver
