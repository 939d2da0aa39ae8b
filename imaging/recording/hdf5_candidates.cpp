// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/hdf5_candidates.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/array_axes.hpp"
#include "imaging/recording/array_series.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::size_t most_data_sets = 100'000;

struct Candidate {
  std::string name;
  std::vector<hsize_t> dims;
  bool is_stack = false;
};

/// Every data set of numbers with two or three dimensions that count, by its path.
std::vector<Candidate> find_candidates(hid_t file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* data) -> herr_t {
    auto& list = *static_cast<std::vector<std::string>*>(data);
    // MATLAB keeps the contents of cells in groups whose names begin so.
    if (info->type == H5O_TYPE_DATASET && name[0] != '#') list.emplace_back(name);
    return list.size() > most_data_sets ? 1 : 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC);
  std::vector<Candidate> candidates;
  for (const auto& name : names) {
    const Handle set{H5Dopen2(file, name.c_str(), H5P_DEFAULT), &H5Dclose};
    if (!set.valid() || !hdf5_holds_numbers(set.get())) continue;
    auto dims = hdf5_dims(set.get());
    const std::size_t counting = counting_dims({dims.begin(), dims.end()}).size();
    // MATLAB's scalars and rows have two dimensions as well.
    const hsize_t least = dims.size() == 2 ? 2 : 1;
    if ((counting == 2 || counting == 3) && *std::min_element(dims.begin(), dims.end()) >= least)
      candidates.push_back({name, dims, counting == 3});
  }
  return candidates;
}

}  // namespace

bool hdf5_holds_numbers(hid_t set) {
  const Handle type{H5Dget_type(set), &H5Tclose};
  const auto kind = H5Tget_class(type.get());
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Tget_size(type.get()) <= 8;
}

std::vector<hsize_t> hdf5_dims(hid_t set) {
  const Handle space{H5Dget_space(set), &H5Sclose};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(0, rank)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  return dims;
}

std::string hdf5_shape_text(std::vector<hsize_t> dims, bool reversed) {
  if (reversed) std::reverse(dims.begin(), dims.end());
  return fmt::format("{}", fmt::join(dims, " x "));
}

std::vector<std::string> choose_hdf5_arrays(const std::filesystem::path& path, hid_t file,
                                            bool reversed) {
  auto candidates = find_candidates(file);
  const bool stacks = std::any_of(candidates.begin(), candidates.end(),
                                  [](const Candidate& c) { return c.is_stack; });
  if (stacks) std::erase_if(candidates, [](const Candidate& c) { return !c.is_stack; });
  if (candidates.size() == 1) return {candidates[0].name};
  if (candidates.empty())
    throw InputError(path.string() +
                     ": there is no array of numbers with three dimensions in it, which frames "
                     "would be; give a file with frames.");
  std::vector<NamedShape> arrays;
  for (const auto& c : candidates) arrays.push_back({c.name, {c.dims.begin(), c.dims.end()}});
  std::vector<std::string> names;
  if (!stacks)
    for (const std::size_t i : picture_series(arrays)) names.push_back(arrays[i].name);
  if (!names.empty()) return names;
  std::string list;
  for (std::size_t i = 0; i < std::min<std::size_t>(candidates.size(), 8); ++i)
    list += fmt::format("{}{} ({})", i == 0 ? "" : ", ", candidates[i].name,
                        hdf5_shape_text(candidates[i].dims, reversed));
  throw InputError(fmt::format("{}: {} arrays may hold the frames: {}; say which one (dataset).",
                               path.string(), candidates.size(), list));
}

}  // namespace meltproof::imaging
