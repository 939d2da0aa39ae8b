// SPDX-License-Identifier: GPL-3.0-or-later
// The processes that share a run. Only this folder knows MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/particles/exact_sum.hpp"

namespace meltproof::solver {

/// Starts MPI if the program was started by mpirun or srun, and ends it. Without one of them the
/// program is alone, and MPI is never touched.
class MpiSession {
 public:
  MpiSession();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  /// @throws InputError if srun started several processes of which each believes to be alone.
  static void check();
  /// Ends all processes at once, after a failure of this one that the others may not know of; does
  /// nothing where MPI was not started.
  void give_up(int status) const;
};

/// **The ranks of a run**, and what they say to each other. Alone, every call returns what it was
/// given. All calls are collective: every rank makes them, in the same order. Nothing here rounds:
/// extremes and integers are the same however particles are divided among ranks.
class Ranks {
 public:
  /// This process alone.
  Ranks() = default;
  /// All processes of the session.
  static Ranks world();

  int size() const { return size_; }
  int rank() const { return rank_; }
  bool alone() const { return size_ == 1; }
  /// The rank that reads the screen's part: messages, files.
  bool root() const { return rank_ == 0; }

  /// Each value becomes the largest of all ranks'.
  void largest(std::span<double> values) const;
  double largest(double value) const;
  /// Each value becomes the smallest of all ranks'.
  void smallest(std::span<double> values) const;
  bool any(bool value) const;
  void add(ExactSum& sum) const;
  void add(std::span<std::uint64_t> counts) const;
  std::uint64_t add(std::uint64_t count) const;
  /// The sum of the counts of the ranks before this one.
  std::uint64_t before(std::uint64_t count) const;
  /// Per entry the largest of all ranks'.
  void largest(std::span<std::uint8_t> flags) const;
  /// What the first rank that says anything says, on all of them; "" if none does.
  std::string said(const std::string& own) const;

  /// Gives to[r] to rank r; returns what the ranks gave to this one, joined in the order of ranks.
  template <class T>
  std::vector<T> exchange(const std::vector<std::vector<T>>& to) const {
    // What is sent is counted in words.
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
    std::vector<std::span<const std::byte>> parts;
    std::vector<std::size_t> sizes;
    for (const auto& part : to) {
      parts.push_back(std::as_bytes(std::span(part)));
      sizes.push_back(parts.back().size());
    }
    const auto arriving = exchange_sizes(sizes);
    std::size_t bytes = 0;
    for (const std::size_t b : arriving) {
      bytes += b;
    }
    std::vector<T> result(bytes / sizeof(T));
    exchange_bytes(parts, result.data(), arriving);
    return result;
  }

  /// The values of all ranks on the root, in the order of ranks; nothing elsewhere.
  template <class T>
  std::vector<T> to_root(const std::vector<T>& values) const {
    std::vector<std::vector<T>> to(static_cast<std::size_t>(size_));
    to[0] = values;
    return exchange(to);
  }

  /// The values of all ranks everywhere, in the order of ranks.
  template <class T>
  std::vector<T> to_all(const std::vector<T>& values) const {
    return exchange(std::vector<std::vector<T>>(static_cast<std::size_t>(size_), values));
  }
  /// Returns once all ranks have called it.
  void meet() const;
  /// Gives rows of `bytes` each to the ranks, counts[r] of them to rank r, and takes arriving[r] of
  /// it; both stand in the order of ranks.
  void exchange_rows(const void* from, std::span<const int> counts, void* to,
                     std::span<const int> arriving, std::size_t bytes) const;

 private:
  std::vector<std::size_t> exchange_sizes(const std::vector<std::size_t>& sizes) const;
  void exchange_bytes(const std::vector<std::span<const std::byte>>& from, void* to,
                      const std::vector<std::size_t>& arriving) const;

  int size_ = 1, rank_ = 0;
};

}  // namespace meltproof::solver
