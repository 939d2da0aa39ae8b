// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/shared_artifact.hpp"

#include <optional>

#include <fmt/format.h>
#include <mpi.h>

#include "base/artifact_hdf5.hpp"
#include "solver/parallel/agreement.hpp"

namespace meltproof::solver {

struct SharedArtifact::State {
  Ranks ranks;
  std::filesystem::path place;
  std::optional<ArtifactWriter> writer;  // of the root
  Handle access{H5I_INVALID_HID, &H5Pclose}, transfer{H5I_INVALID_HID, &H5Pclose};
  hid_t file = H5I_INVALID_HID;
  std::string failed;  // the first data set that could not be written here
};

SharedArtifact::SharedArtifact(const Ranks& ranks, const std::filesystem::path& path,
                               const std::string& kind,
                               const std::function<void(ArtifactWriter&)>& build,
                               const Provenance& provenance)
    : state_(std::make_unique<State>()) {
  prepare_hdf5();
  state_->ranks = ranks;
  state_->place = path;
  std::string temporary;
  on_root(ranks, [&] {
    state_->writer.emplace(path, kind);
    build(*state_->writer);
    temporary = state_->writer->close(provenance);
  });
  temporary = ranks.said(temporary);
  state_->access = Handle{H5Pcreate(H5P_FILE_ACCESS), &H5Pclose};
  state_->transfer = Handle{H5Pcreate(H5P_DATASET_XFER), &H5Pclose};
  if (!ranks.alone()) {
    H5Pset_fapl_mpio(state_->access.get(), MPI_COMM_WORLD, MPI_INFO_NULL);
    // Each rank's rows are one piece of the file, so there is nothing that ranks could gather for
    // each other; and where a disk fills up, Open MPI's collective writes wait for ever for the
    // rank that met it.
    H5Pset_dxpl_mpio(state_->transfer.get(), H5FD_MPIO_INDEPENDENT);
  }
  state_->file = H5Fopen(temporary.c_str(), H5F_ACC_RDWR, state_->access.get());
  agree(ranks, [&] {
    if (state_->file < 0) {
      throw std::runtime_error(fmt::format(
          "{} was made by the first rank and cannot be opened by rank {}: all ranks must see the "
          "same folder; take one that they share",
          temporary, ranks.rank()));
    }
  });
}

// Without commit() something has failed, here or on another rank: closing the file would wait for
// all ranks, and HDF5 does not survive to write what a full disk left with it.
SharedArtifact::~SharedArtifact() = default;

template <class T>
void SharedArtifact::write(const std::string& name, std::size_t first, std::span<const T> rows) {
  const Handle set{H5Dopen2(state_->file, name.c_str(), H5P_DEFAULT), &H5Dclose};
  const Handle target{H5Dget_space(set.get()), &H5Sclose};
  std::vector<hsize_t> part(
      static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(target.get()))));
  H5Sget_simple_extent_dims(target.get(), part.data(), nullptr);
  if (part.at(0) == 0) {
    return;  // for all ranks: nothing has room in it
  }
  std::size_t width = 1;
  for (std::size_t d = 1; d < part.size(); ++d) {
    width *= part[d];
  }
  part[0] = rows.size() / width;
  std::vector<hsize_t> start(part.size(), 0);
  start[0] = first;
  const Handle memory{H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr),
                      &H5Sclose};
  if (rows.empty()) {
    H5Sselect_none(target.get());
    H5Sselect_none(memory.get());
  } else {
    H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
  }
  // With an error, too, the others are not left alone: it is told in commit().
  if (H5Dwrite(set.get(), native_type<T>(), memory.get(), target.get(), state_->transfer.get(),
               rows.data()) < 0 &&
      state_->failed.empty()) {
    state_->failed = "the data set " + name;
  }
}

#define MELTPROOF_WRITE(T) \
  template void SharedArtifact::write<T>(const std::string&, std::size_t, std::span<const T>);
MELTPROOF_WRITE(double)
MELTPROOF_WRITE(float)
MELTPROOF_WRITE(std::int64_t)
MELTPROOF_WRITE(std::int32_t)
MELTPROOF_WRITE(std::uint8_t)
#undef MELTPROOF_WRITE

void SharedArtifact::commit() {
  const auto check = [&](const std::string& what) {
    agree(state_->ranks, [&] {
      if (!what.empty()) {
        throw std::runtime_error(
            fmt::format("{}: {} cannot be written (is the disk full?); nothing was left behind",
                        state_->place.string(), what));
      }
    });
  };
  if (H5Fflush(state_->file, H5F_SCOPE_GLOBAL) < 0 && state_->failed.empty()) {
    state_->failed = "it";
  }
  check(state_->failed);
  check(H5Fclose(state_->file) < 0 ? "it" : "");
  on_root(state_->ranks, [&] { state_->writer->put_in_place(); });
}

}  // namespace meltproof::solver
