// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/artifact_hdf5.hpp"
#include "base/error.hpp"

namespace meltproof {

struct ArtifactReader::State {
  std::filesystem::path path;
  Handle file{H5I_INVALID_HID, &H5Fclose};

  Handle open(const std::string& name) const {
    Handle set{H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), &H5Dclose};
    if (!set.valid()) {
      throw InputError(
          fmt::format("{}: there is no data set {}: the file is of another kind or version",
                      path.string(), name));
    }
    return set;
  }
  std::vector<std::size_t> shape(const Handle& set) const {
    const Handle space{H5Dget_space(set.get()), &H5Sclose};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(0, rank)));
    if (rank > 0) {
      H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
    }
    return {dims.begin(), dims.end()};
  }
};

ArtifactReader::ArtifactReader(const std::filesystem::path& path, const std::string& kind)
    : state_(std::make_unique<State>()) {
  prepare_hdf5();
  state_->path = path;
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(fmt::format("{} cannot be opened: there is no such file", path.string()));
  }
  if (H5Fis_hdf5(path.c_str()) <= 0) {
    throw InputError(fmt::format("{} is not an HDF5 file", path.string()));
  }
  state_->file = Handle{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose};
  if (!state_->file.valid()) {
    throw InputError(fmt::format("{} is a damaged or unreadable HDF5 file", path.string()));
  }
  if (const auto found = attribute("kind"); !kind.empty() && found != kind) {
    throw InputError(
        fmt::format("{} is {}, expected a \"{}\"", path.string(),
                    found.empty() ? "no artifact of this suite" : "a \"" + found + "\"", kind));
  }
}

ArtifactReader::~ArtifactReader() = default;
ArtifactReader::ArtifactReader(ArtifactReader&&) noexcept = default;
ArtifactReader& ArtifactReader::operator=(ArtifactReader&&) noexcept = default;

bool ArtifactReader::has(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (slash > 0 &&
        H5Lexists(state_->file.get(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) {
      return false;
    }
  }
  return H5Lexists(state_->file.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::size_t> ArtifactReader::shape(const std::string& name) const {
  return state_->shape(state_->open(name));
}

std::string ArtifactReader::units(const std::string& name) const {
  return read_text_attribute(state_->open(name).get(), "units");
}

std::vector<std::string> ArtifactReader::names(const std::string& group) const {
  std::vector<std::string> result;
  const Handle at{H5Gopen2(state_->file.get(), group.c_str(), H5P_DEFAULT), &H5Gclose};
  if (!at.valid()) {
    throw InputError(fmt::format("{}: there is no group {}", state_->path.string(), group));
  }
  H5Literate(
      at.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &result);
  return result;
}

template <class T>
DataSet<T> ArtifactReader::read(const std::string& name) const {
  const Handle set = state_->open(name);
  DataSet<T> result{{}, state_->shape(set), read_text_attribute(set.get(), "units")};
  std::size_t count = 1;
  for (const auto n : result.shape) {
    count *= n;
  }
  result.values.resize(count);
  if (count > 0 && H5Dread(set.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                           result.values.data()) < 0) {
    throw InputError(fmt::format(
        "{}: the data set {} cannot be read: the file is damaged, or it holds no numbers",
        state_->path.string(), name));
  }
  return result;
}

template <class T>
std::vector<T> ArtifactReader::read_slab(const std::string& name, std::size_t first,
                                         std::size_t count) const {
  const Handle set = state_->open(name);
  const auto whole = state_->shape(set);
  if (whole.empty() || first + count > whole[0]) {
    throw InputError(fmt::format("{}: the data set {} has {} entries, asked for {} to {}",
                                 state_->path.string(), name, whole.empty() ? 0 : whole[0], first,
                                 first + count));
  }
  auto dims = extent(whole);
  dims[0] = count;
  std::vector<hsize_t> start(dims.size(), 0);
  start[0] = first;
  std::size_t total = 1;
  for (const auto n : dims) {
    total *= n;
  }
  std::vector<T> values(total);
  const Handle source{H5Dget_space(set.get()), &H5Sclose};
  H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, dims.data(), nullptr);
  const Handle memory{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                      &H5Sclose};
  if (total > 0 && H5Dread(set.get(), native_type<T>(), memory.get(), source.get(), H5P_DEFAULT,
                           values.data()) < 0) {
    throw InputError(fmt::format("{}: entries {} to {} of {} cannot be read: the file is damaged",
                                 state_->path.string(), first, first + count, name));
  }
  return values;
}

double ArtifactReader::scalar(const std::string& name) const {
  const auto set = read<double>(name);
  if (set.values.size() != 1) {
    throw InputError(fmt::format("{}: {} holds {} values, expected one", state_->path.string(),
                                 name, set.values.size()));
  }
  return set.values.front();
}

std::string ArtifactReader::attribute(const std::string& name, const std::string& object) const {
  const Handle at{H5Oopen(state_->file.get(), object.c_str(), H5P_DEFAULT), &H5Oclose};
  return at.valid() ? read_text_attribute(at.get(), name) : "";
}

const std::filesystem::path& ArtifactReader::path() const { return state_->path; }

#define MELTPROOF_READ(T)                                                               \
  template DataSet<T> ArtifactReader::read<T>(const std::string&) const;                \
  template std::vector<T> ArtifactReader::read_slab<T>(const std::string&, std::size_t, \
                                                       std::size_t) const;
MELTPROOF_READ(double)
MELTPROOF_READ(float)
MELTPROOF_READ(std::int64_t)
MELTPROOF_READ(std::int32_t)
MELTPROOF_READ(std::uint16_t)
MELTPROOF_READ(std::uint8_t)
#undef MELTPROOF_READ

}  // namespace meltproof
