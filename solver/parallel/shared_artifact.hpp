// SPDX-License-Identifier: GPL-3.0-or-later
// An artifact that all ranks write together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "base/artifact.hpp"
#include "solver/parallel/ranks.hpp"

namespace meltproof::solver {

/// **One file, written by all ranks**, each its own rows: HDF5 over MPI. The root alone makes what
/// is not fields, and the room for the fields, so nothing but numbers is written together and no
/// two ranks can disagree about the file's structure. A process that is alone writes the same file
/// without MPI. The file is under a temporary name until commit(), and goes without it.
class SharedArtifact {
 public:
  /// Collective. @param build reserves the fields and writes all else; called on the root only.
  /// @throws on all ranks what it throws, and std::runtime_error with a sentence if the disk has
  /// no room for the whole file.
  SharedArtifact(const Ranks& ranks, const std::filesystem::path& path, const std::string& kind,
                 const std::function<void(ArtifactWriter&)>& build, const Provenance& provenance);
  ~SharedArtifact();
  SharedArtifact(const SharedArtifact&) = delete;
  SharedArtifact& operator=(const SharedArtifact&) = delete;

  /// Writes rows of a reserved data set from `first` on; a rank without any gives none. Collective.
  template <class T>
  void write(const std::string& name, std::size_t first, std::span<const T> rows);

  /// Gives the file its name. Collective. @throws std::runtime_error with a sentence on all ranks
  /// if any could not write its part.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meltproof::solver
