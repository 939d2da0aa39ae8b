// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/artifact.hpp"

#include <fmt/format.h>

#include "base/artifact_hdf5.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof {

struct ArtifactWriter::State {
  bool prepared = prepare_hdf5();  // before any other call of the library
  AtomicFile place;
  bool in_memory;
  Handle file{H5I_INVALID_HID, &H5Fclose};
  Handle link_options{H5Pcreate(H5P_LINK_CREATE), &H5Pclose};
  bool failed = false;

  State(const std::filesystem::path& path, bool memory) : place(path), in_memory(memory) {}

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

ArtifactWriter::ArtifactWriter(const std::filesystem::path& path, const std::string& kind,
                               bool in_memory)
    : state_(std::make_unique<State>(path, in_memory)) {
  const Handle options{H5Pcreate(H5P_FILE_CREATE), &H5Pclose};
  H5Pset_obj_track_times(options.get(), false);
  const Handle access{H5Pcreate(H5P_FILE_ACCESS), &H5Pclose};
  if (in_memory) {
    constexpr std::size_t growth = std::size_t{1} << 22U;
    H5Pset_fapl_core(access.get(), growth, false);
  }
  state_->file = Handle{
      H5Fcreate(state_->place.temporary().c_str(), H5F_ACC_TRUNC, options.get(), access.get()),
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

void ArtifactWriter::copy_from(const ArtifactReader& other, const std::string& group) {
  // Asked beforehand, because HDF5's copying does not survive a disk that fills up meanwhile.
  std::error_code unknown;
  const auto room = std::filesystem::space(state_->place.temporary().parent_path(), unknown);
  if (!unknown && room.available < std::filesystem::file_size(other.path()) + (1U << 20U)) {
    state_->fail(group + " of " + other.path().string());
  }
  const Handle from{H5Fopen(other.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose};
  if (!from.valid() || !copy_group(from.get(), state_->file.get(), group)) {
    state_->fail(group + " of " + other.path().string());
  }
}

void ArtifactWriter::copy_to(ArtifactWriter& other, const std::string& group) const {
  if (!copy_group(state_->file.get(), other.state_->file.get(), group)) {
    other.state_->fail(group);
  }
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
  if (H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL) < 0) {
    state_->fail("as a whole");
  }
  if (state_->in_memory) {
    std::string image(static_cast<std::size_t>(H5Fget_file_image(state_->file.get(), nullptr, 0)),
                      '\0');
    H5Fget_file_image(state_->file.get(), image.data(), image.size());
    write_file(state_->place.place(), image);
    return;
  }
  if (!state_->file.reset()) {
    state_->fail("as a whole");
  }
  state_->place.commit();
}

}  // namespace meltproof
