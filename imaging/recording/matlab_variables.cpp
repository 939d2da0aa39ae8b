// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/matlab_variables.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/array_axes.hpp"
#include "imaging/recording/array_series.hpp"

namespace meltproof::imaging {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw InputError(path.string() + ": " + what);
}

bool holds_numbers(const matvar_t& v) {
  switch (v.class_type) {
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT8:
    case MAT_C_UINT8:
    case MAT_C_INT16:
    case MAT_C_UINT16:
    case MAT_C_INT32:
    case MAT_C_UINT32:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      return v.isComplex == 0;
    default:
      return false;
  }
}

std::vector<std::size_t> dims_of(const matvar_t& v) { return {v.dims, v.dims + v.rank}; }

}  // namespace

bool is_stack_or_picture(const matvar_t& v) {
  const auto dims = dims_of(v);
  const std::size_t least = v.rank == 2 ? 2 : 1;
  return holds_numbers(v) && (v.rank == 2 || v.rank == 3) &&
         *std::min_element(dims.begin(), dims.end()) >= least;
}

void drop_single_dims(matvar_t& v) {
  const auto dims = dims_of(v);
  const auto counting = counting_dims(dims);
  if (counting.size() != 2 && counting.size() != 3) return;
  for (std::size_t i = 0; i < counting.size(); ++i) v.dims[i] = dims[counting[i]];
  v.rank = static_cast<int>(counting.size());
}

std::string matlab_shape_text(const matvar_t& v) {
  return fmt::format("{}", fmt::join(dims_of(v), " x "));
}

std::shared_ptr<matvar_t> owned_variable(matvar_t* v) {
  return {v, [](matvar_t* p) { Mat_VarFree(p); }};
}

std::vector<std::shared_ptr<matvar_t>> choose_variables(const std::filesystem::path& path,
                                                        mat_t* file) {
  std::vector<std::shared_ptr<matvar_t>> found;
  while (auto v = owned_variable(Mat_VarReadNextInfo(file))) {
    drop_single_dims(*v);
    if (is_stack_or_picture(*v)) found.push_back(v);
  }
  const auto is_stack = [](const auto& v) { return v->rank == 3; };
  const bool stacks = std::any_of(found.begin(), found.end(), is_stack);
  if (stacks) std::erase_if(found, [&](const auto& v) { return !is_stack(v); });
  if (found.size() == 1) return found;
  if (found.empty())
    refuse(path,
           "there is no variable of numbers with three dimensions in it, which frames would be; "
           "save them as a variable of their own, not inside a struct or cell.");
  std::vector<NamedShape> arrays;
  for (const auto& v : found) arrays.push_back({v->name ? v->name : "", dims_of(*v)});
  std::vector<std::shared_ptr<matvar_t>> pictures;
  if (!stacks)
    for (const std::size_t i : picture_series(arrays)) pictures.push_back(found[i]);
  if (!pictures.empty()) return pictures;
  std::string list;
  for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 8); ++i)
    list += fmt::format("{}{} ({})", i == 0 ? "" : ", ", found[i]->name ? found[i]->name : "?",
                        matlab_shape_text(*found[i]));
  refuse(path, fmt::format("{} variables may hold the frames: {}; say which one (dataset).",
                           found.size(), list));
}

}  // namespace meltproof::imaging
