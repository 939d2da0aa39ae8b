// SPDX-License-Identifier: GPL-3.0-or-later
// What a run leaves behind while it is under way, so that it can go on after a crash or a stop.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/artifact.hpp"
#include "base/provenance.hpp"
#include "solver/output/acceptance.hpp"
#include "solver/output/history.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// What a run has found so far, beside the state of its engine.
struct RunProgress {
  std::vector<HistoryLine> lines;  ///< of history.csv
  std::size_t history = 0;         ///< lines at regular intervals so far
  std::size_t snapshots = 0;       ///< in run.h5 so far
  double beam_balance = 0;         ///< 1, largest so far
  double start_enthalpy = 0;       ///< J
  double start_additive = 0;       ///< kg
  double wall_time = 0;            ///< s, of all parts of the run so far
  NearestDistances melt;           ///< as the beam went off, once it has
  FilledVolume melt_volume;        ///< likewise
};

/// A run between two steps.
struct Checkpoint {
  std::filesystem::path file;
  EngineState engine;  ///< of several ranks each holds a part
  RunProgress run;
};

/// The folder `checkpoints` beside run.h5: the last two checkpoints, each a file that is there
/// whole or not at all and holds a checksum of every field, and the snapshots that run.h5 is put
/// together from. All ranks call everything here together, and what fails on one of them fails on
/// all.
class CheckpointFolder {
 public:
  /// @param run_folder where run.h5 goes. Nothing is made before something is written.
  CheckpointFolder(const std::filesystem::path& run_folder, const Ranks& ranks);

  /// Writes the state; older checkpoints than the one before go. @returns its file.
  /// @throws std::runtime_error with a sentence if the disk is full; the former one stays.
  std::filesystem::path write(const Engine& engine, const RunProgress& run,
                              const Provenance& provenance);
  /// Writes a snapshot of the present state. @throws likewise.
  void write_snapshot(std::size_t number, const Engine& engine, const Provenance& provenance);

  /// The newest checkpoint whose fields have the checksums that it names; damaged ones are passed
  /// over with a warning. None: no run was under way here.
  /// @throws InputError if it was made with another input or by another revision of the code, or if
  /// a snapshot that its run had written is missing.
  std::optional<Checkpoint> newest(const Provenance& provenance) const;

  /// Copies the first `count` snapshots into run.h5, which the root alone writes: a chunk at a
  /// time, so it needs no memory to speak of. @param run_file of the root; null elsewhere.
  void copy_snapshots(ArtifactWriter* run_file, std::size_t count) const;

  /// The run is complete, or begins anew: removes what this class wrote, and nothing else.
  void clear() const;

  /// "the last good checkpoint is <that written or read last>", or that there is none.
  std::string last_good() const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::vector<std::filesystem::path> files(const std::string& prefix) const;
  std::filesystem::path snapshot(std::size_t number) const;

  std::filesystem::path folder_;
  Ranks ranks_;
  mutable std::filesystem::path last_;
};

}  // namespace meltproof::solver
