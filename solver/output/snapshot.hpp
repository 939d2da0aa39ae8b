// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a run as data sets of an artifact.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "base/artifact.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// Stored number type of a field; no wider than its digits mean anything.
enum class FieldType { float32, float64, int32, int64, uint8 };

/// One field of a snapshot.
struct SnapshotField {
  const char* name;
  const char* units;
  const char* description;
  FieldType type;
  std::size_t components;  ///< 1, or 3 for a vector
};

/// Every field that a snapshot can hold besides `time` and `beam`, `position` first. Of flow runs
/// only: pressure. What has never melted has times of -1, what has never frozen again no rate.
std::span<const SnapshotField> snapshot_fields();

/// "snapshots/<number, four digits>".
std::string snapshot_group(std::size_t number);

/// Writes the particles of the present moment into a file of their own, in the group of that
/// number, ordered by identity, so that a snapshot does not depend on how the engine keeps its
/// particles: all ranks together, each its part of the identities. Nothing is compressed there.
/// Collective. @throws on all ranks as SharedArtifact.
void write_snapshot(const std::filesystem::path& place, std::size_t number, const Engine& engine,
                    const Provenance& provenance);

}  // namespace meltproof::solver
