// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a run as data sets of an artifact.
#pragma once

#include <cstddef>
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

/// Writes the particles of the present moment into the group snapshots/<number, four digits>,
/// ordered by identity, so that a snapshot does not depend on how the engine keeps its particles.
/// Collective. @param writer null on all ranks but the root.
void write_snapshot(ArtifactWriter* writer, std::size_t number, const Engine& engine);

}  // namespace meltproof::solver
