// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/artifact.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/artifact_state.hpp"
#include "base/error.hpp"

namespace meltproof {
namespace {

/// Has the disk set aside what a file as long as this one takes, holes included; false where it is
/// full. A file system that cannot is no reason to stop.
bool take_room(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) {
    return false;
  }
  const auto size = static_cast<off_t>(std::filesystem::file_size(path));
  const int problem = size > 0 ? ::posix_fallocate(file, 0, size) : 0;
  ::close(file);
  return problem != ENOSPC && problem != EDQUOT && problem != EFBIG && problem != EIO;
}

}  // namespace

ArtifactWriter::ArtifactWriter(const std::filesystem::path& path, const std::string& kind)
    : state_(std::make_unique<State>(path)) {
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

template <class T>
void ArtifactWriter::reserve(const std::string& name, const std::vector<std::size_t>& shape,
                             const std::string& units, const std::string& description) {
  const Handle options{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
  H5Pset_alloc_time(options.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(options.get(), H5D_FILL_TIME_NEVER);
  state_->make(name, native_type<T>(), extent(shape), options, units, description);
}
#define MELTPROOF_RESERVE(T)                                                                    \
  template void ArtifactWriter::reserve<T>(const std::string&, const std::vector<std::size_t>&, \
                                           const std::string&, const std::string&);
MELTPROOF_RESERVE(double)
MELTPROOF_RESERVE(float)
MELTPROOF_RESERVE(std::int64_t)
MELTPROOF_RESERVE(std::int32_t)
MELTPROOF_RESERVE(std::uint16_t)
MELTPROOF_RESERVE(std::uint8_t)
#undef MELTPROOF_RESERVE

void ArtifactWriter::copy_from(const ArtifactReader& other, const std::string& group) {
  const auto names = other.names(group);
  const Handle from{H5Fopen(other.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose};
  for (const auto& name : names) {
    const std::string path = group + "/" + name;
    const Handle set{H5Dopen2(from.get(), path.c_str(), H5P_DEFAULT), &H5Dclose};
    if (!set.valid()) {
      throw InputError(fmt::format("{}: {} is no data set: the file is of another kind or version",
                                   other.path().string(), path));
    }
    state_->copy(set, path);
  }
}

void ArtifactWriter::commit(const Provenance& provenance) {
  close(provenance);
  put_in_place();
}

std::filesystem::path ArtifactWriter::close(const Provenance& provenance) {
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
  if (H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL) < 0 || !state_->file.reset() ||
      !take_room(state_->place.temporary())) {
    state_->fail();
  }
  return state_->place.temporary();
}

void ArtifactWriter::put_in_place() { state_->place.commit(); }

}  // namespace meltproof
