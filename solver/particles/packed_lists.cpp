// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/particles/packed_lists.hpp"

#include <limits>

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

std::size_t PackedLists::count(std::size_t i) const {
  std::size_t sum = 0;
  for (std::size_t at = first[i]; at != last[i]; at += std::size_t{3} + code[at + 2]) {
    sum += code[at + 2];
  }
  return sum;
}

std::span<const std::uint32_t> PackedLists::of(std::size_t i, ListBuffer& buffer) const {
  const std::size_t most = last[i] - first[i] + lane_count;
  if (buffer.size() < most) {
    buffer.resize(most);
  }
  std::uint32_t* out = buffer.data();
  const std::uint16_t *at = code.data() + first[i], *const end = code.data() + last[i];
  while (at != end) {
    const std::uint32_t base = at[0] | static_cast<std::uint32_t>(at[1]) << 16U, length = at[2];
    at += 3;
    for (std::uint32_t k = 0; k < length; ++k) {
      out[k] = base + at[k];
    }
    out += length;
    at += length;
  }
  while ((out - buffer.data()) % static_cast<std::ptrdiff_t>(lane_count) != 0) {
    *out++ = void_index;
  }
  return {buffer.data(), out};
}

double PackedLists::mean_neighbours() const {
  std::size_t real = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    real += count(i);
  }
  return size() == 0 ? 0 : static_cast<double>(real) / static_cast<double>(size());
}

void append_packed(std::span<const std::uint32_t> entries, std::vector<std::uint16_t>& code) {
  constexpr std::uint32_t most = std::numeric_limits<std::uint16_t>::max();
  const std::size_t n = entries.size();
  std::size_t k = 0;
  while (k < n) {
    const std::uint32_t base = entries[k];
    const std::size_t head = code.size();
    code.resize(head + 3 + (n - k));
    std::uint16_t* out = code.data() + head + 3;
    std::uint32_t length = 0;
    // Of several ranks, entries that came from elsewhere are not in the order of their indices.
    while (k < n && length < most && entries[k] >= base && entries[k] - base <= most) {
      out[length++] = static_cast<std::uint16_t>(entries[k++] - base);
    }
    code[head] = static_cast<std::uint16_t>(base & 0xffffU);
    code[head + 1] = static_cast<std::uint16_t>(base >> 16U);
    code[head + 2] = static_cast<std::uint16_t>(length);
    code.resize(head + 3 + length);
  }
}

NeighbourList unpacked(const PackedLists& lists) {
  NeighbourList list;
  list.void_index = lists.void_index;
  list.reach = lists.reach;
  ListBuffer buffer;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const auto entries = lists.of(i, buffer);
    list.first.push_back(list_place(list.index.size()));
    list.index.insert(list.index.end(), entries.begin(), entries.end());
    list.last.push_back(list_place(list.index.size()));
  }
  list.first.push_back(list_place(list.index.size()));
  return list;
}

}  // namespace meltproof::solver
