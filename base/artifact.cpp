// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/artifact.hpp"

#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof {
namespace {

/// An HDF5 identifier that is closed by the function that fits it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }
  bool reset() {
    const hid_t id = std::exchange(id_, H5I_INVALID_HID);
    return id < 0 || close_(id) >= 0;
  }
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its error stack by default; our sentences replace it.
void silence_hdf5() {
  static const bool silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  static_cast<void>(silent);
}

template <class T>
hid_t native_type();
template <>
hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t native_type<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

std::vector<hsize_t> extent(const std::vector<std::size_t>& shape) {
  return {shape.begin(), shape.end()};
}

void write_text_attribute(hid_t object, const std::string& name, const std::string& value) {
  Handle type{H5Tcopy(H5T_C_S1), &H5Tclose};
  // HDF5 knows no text of length zero.
  H5Tset_size(type.get(), std::max<std::size_t>(1, value.size()));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  const Handle space{H5Screate(H5S_SCALAR), &H5Sclose};
  if (H5Aexists(object, name.c_str()) > 0) {
    H5Adelete(object, name.c_str());
  }
  const Handle attribute{
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      &H5Aclose};
  const std::string padded = value.empty() ? std::string(1, '\0') : value;
  if (!attribute.valid() || H5Awrite(attribute.get(), type.get(), padded.data()) < 0) {
    throw std::runtime_error("the attribute " + name + " cannot be written");
  }
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) {
    return "";
  }
  const Handle attribute{H5Aopen(object, name.c_str(), H5P_DEFAULT), &H5Aclose};
  const Handle type{H5Aget_type(attribute.get()), &H5Tclose};
  if (H5Tget_class(type.get()) != H5T_STRING) {
    return "";
  }
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    const Handle memory{H5Tcopy(H5T_C_S1), &H5Tclose};
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
    if (H5Aread(attribute.get(), memory.get(), static_cast<void*>(&text)) < 0 || text == nullptr) {
      return "";
    }
    std::string result(text);
    H5free_memory(text);
    return result;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    return "";
  }
  return text.substr(0, text.find('\0'));
}

}  // namespace

struct ArtifactWriter::State {
  AtomicFile place;
  Handle file{H5I_INVALID_HID, &H5Fclose};
  Handle link_options{H5Pcreate(H5P_LINK_CREATE), &H5Pclose};
  bool failed = false;

  explicit State(const std::filesystem::path& path) : place(path) {}

  [[noreturn]] void fail(const std::string& name) {
    failed = true;
    throw std::runtime_error(fmt::format(
        "{}: the data set {} cannot be written (is the disk full?); nothing was left behind",
        place.place().string(), name));
  }

  void describe(const Handle& set, const std::string& units, const std::string& description) {
    write_text_attribute(set.get(), "units", units);
    write_text_attribute(set.get(), "description", description);
  }

  template <class T>
  void write(const std::string& name, std::span<const T> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description) {
    std::size_t count = 1;
    for (const auto n : shape) {
      count *= n;
    }
    if (count != values.size()) {
      throw std::logic_error(fmt::format("data set {}: {} values do not fill the shape of {}", name,
                                         values.size(), count));
    }
    const auto dims = extent(shape);
    const Handle space{shape.empty()
                           ? H5Screate(H5S_SCALAR)
                           : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                       &H5Sclose};
    const Handle options{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
    H5Pset_obj_track_times(options.get(), false);
    if (count > 4096 && !dims.empty()) {
      auto chunk = dims;
      std::size_t rest = 1;
      for (std::size_t d = 1; d < dims.size(); ++d) {
        rest *= dims[d];
      }
      chunk[0] = std::clamp<hsize_t>((1U << 17) / std::max<std::size_t>(1, rest), 1, dims[0]);
      H5Pset_chunk(options.get(), static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(options.get());
      H5Pset_deflate(options.get(), 4);
    }
    const Handle set{H5Dcreate2(file.get(), name.c_str(), native_type<T>(), space.get(),
                                link_options.get(), options.get(), H5P_DEFAULT),
                     &H5Dclose};
    if (!set.valid() || (count > 0 && H5Dwrite(set.get(), native_type<T>(), H5S_ALL, H5S_ALL,
                                               H5P_DEFAULT, values.data()) < 0)) {
      fail(name);
    }
    describe(set, units, description);
  }

  template <class T>
  void append(const std::string& name, std::span<const T> slab,
              const std::vector<std::size_t>& slab_shape, const std::string& units,
              const std::string& description) {
    auto dims = extent(slab_shape);
    dims.insert(dims.begin(), 1);
    Handle set{H5Lexists(file.get(), name.substr(0, name.find('/')).c_str(), H5P_DEFAULT) > 0
                   ? H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT)
                   : H5I_INVALID_HID,
               &H5Dclose};
    hsize_t at = 0;
    if (!set.valid()) {
      auto none = dims, most = dims;
      none[0] = 0;
      most[0] = H5S_UNLIMITED;
      const Handle space{H5Screate_simple(static_cast<int>(dims.size()), none.data(), most.data()),
                         &H5Sclose};
      const Handle options{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
      H5Pset_obj_track_times(options.get(), false);
      H5Pset_chunk(options.get(), static_cast<int>(dims.size()), dims.data());
      H5Pset_shuffle(options.get());
      H5Pset_deflate(options.get(), 1);
      set = Handle{H5Dcreate2(file.get(), name.c_str(), native_type<T>(), space.get(),
                              link_options.get(), options.get(), H5P_DEFAULT),
                   &H5Dclose};
      if (!set.valid()) {
        fail(name);
      }
      describe(set, units, description);
    } else {
      const Handle space{H5Dget_space(set.get()), &H5Sclose};
      std::vector<hsize_t> now(dims.size());
      H5Sget_simple_extent_dims(space.get(), now.data(), nullptr);
      at = now[0];
    }
    auto grown = dims;
    grown[0] = at + 1;
    std::vector<hsize_t> start(dims.size(), 0);
    start[0] = at;
    if (H5Dset_extent(set.get(), grown.data()) < 0) {
      fail(name);
    }
    const Handle target{H5Dget_space(set.get()), &H5Sclose};
    H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, dims.data(), nullptr);
    const Handle source{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                        &H5Sclose};
    if (H5Dwrite(set.get(), native_type<T>(), source.get(), target.get(), H5P_DEFAULT,
                 slab.data()) < 0) {
      fail(name);
    }
  }
};

ArtifactWriter::ArtifactWriter(const std::filesystem::path& path, const std::string& kind)
    : state_(std::make_unique<State>(path)) {
  silence_hdf5();
  const Handle options{H5Pcreate(H5P_FILE_CREATE), &H5Pclose};
  H5Pset_obj_track_times(options.get(), false);
  state_->file = Handle{
      H5Fcreate(state_->place.temporary().c_str(), H5F_ACC_TRUNC, options.get(), H5P_DEFAULT),
      &H5Fclose};
  if (!state_->file.valid()) {
    throw InputError(fmt::format(
        "{} cannot be created: check the folder's permissions and the space left", path.string()));
  }
  H5Pset_create_intermediate_group(state_->link_options.get(), 1);
  H5Pset_char_encoding(state_->link_options.get(), H5T_CSET_UTF8);
  attribute("kind", kind);
  attribute("format_version", "1");
}

ArtifactWriter::~ArtifactWriter() = default;

#define MELTPROOF_WRITE(T)                                                                    \
  void ArtifactWriter::write(const std::string& name, std::span<const T> values,              \
                             const std::vector<std::size_t>& shape, const std::string& units, \
                             const std::string& description) {                                \
    state_->write(name, values, shape, units, description);                                   \
  }
MELTPROOF_WRITE(double)
MELTPROOF_WRITE(float)
MELTPROOF_WRITE(std::int64_t)
MELTPROOF_WRITE(std::int32_t)
MELTPROOF_WRITE(std::uint16_t)
MELTPROOF_WRITE(std::uint8_t)
#undef MELTPROOF_WRITE

void ArtifactWriter::write(const std::string& name, double value, const std::string& units,
                           const std::string& description) {
  state_->write(name, std::span<const double>(&value, 1), {}, units, description);
}

void ArtifactWriter::append(const std::string& name, std::span<const std::uint16_t> slab,
                            const std::vector<std::size_t>& slab_shape, const std::string& units,
                            const std::string& description) {
  state_->append(name, slab, slab_shape, units, description);
}
void ArtifactWriter::append(const std::string& name, std::span<const float> slab,
                            const std::vector<std::size_t>& slab_shape, const std::string& units,
                            const std::string& description) {
  state_->append(name, slab, slab_shape, units, description);
}
void ArtifactWriter::append(const std::string& name, std::span<const double> slab,
                            const std::vector<std::size_t>& slab_shape, const std::string& units,
                            const std::string& description) {
  state_->append(name, slab, slab_shape, units, description);
}

void ArtifactWriter::attribute(const std::string& name, const std::string& value,
                               const std::string& object) {
  const Handle at{H5Oopen(state_->file.get(), object.c_str(), H5P_DEFAULT), &H5Oclose};
  if (!at.valid()) {
    throw std::logic_error("attribute " + name + ": there is no object " + object);
  }
  write_text_attribute(at.get(), name, value);
}

void ArtifactWriter::commit(const Provenance& provenance) {
  {
    const Handle group{
        H5Gcreate2(state_->file.get(), "provenance", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        &H5Gclose};
    write_text_attribute(group.get(), "program", provenance.program);
    write_text_attribute(group.get(), "version", suite_version());
    write_text_attribute(group.get(), "revision", code_revision());
    write_text_attribute(group.get(), "command", provenance.command);
    const auto json = provenance.json();
    write_text_attribute(group.get(), "resolved_input", provenance.resolved_input);
    write_text_attribute(group.get(), "inputs", json["inputs"].dump());
    write_text_attribute(group.get(), "libraries", json["libraries"].dump());
  }
  write("provenance/seed", static_cast<double>(provenance.seed), "1",
        "seed of the random numbers, 0 if none");
  write("provenance/ranks", provenance.ranks, "1", "MPI ranks");
  write("provenance/threads", provenance.threads, "1", "threads per rank");
  write("provenance/wall_time", provenance.wall_time, "s",
        "from the start of the program to this file");
  if (H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL) < 0 || !state_->file.reset()) {
    state_->fail("as a whole");
  }
  state_->place.commit();
}

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
  silence_hdf5();
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
