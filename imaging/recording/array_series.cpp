// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/array_series.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "imaging/recording/folder.hpp"

namespace meltproof::imaging {

std::vector<std::size_t> picture_series(const std::vector<NamedShape>& arrays) {
  std::map<std::pair<std::string, std::vector<std::size_t>>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const auto& name = arrays[i].name;
    const std::size_t stem = name.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
    if (stem < name.size()) groups[{name.substr(0, stem), arrays[i].shape}].push_back(i);
  }
  std::vector<std::size_t> best;
  for (auto& [key, members] : groups)
    if (members.size() > best.size()) best = members;
  if (best.size() < 2 || 2 * best.size() <= arrays.size()) return {};
  std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) {
    return natural_order(arrays[a].name, arrays[b].name);
  });
  return best;
}

}  // namespace meltproof::imaging
