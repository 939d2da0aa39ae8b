// SPDX-License-Identifier: GPL-3.0-or-later
// One checkpoint as a file.
#pragma once

#include <filesystem>
#include <string>

#include "solver/output/checkpoint.hpp"

namespace meltproof::solver {

/// What a checkpoint calls itself, for ArtifactReader.
constexpr const char* checkpoint_kind = "meltproof checkpoint";

/// Writes the state of the engine, whose ranks do so together: each its part of the identities,
/// every field in one piece. For each field the file names a **checksum**: the SHA-256 of the
/// SHA-256s of what each block of SharedRows::block identities holds of it, so ranks can work it
/// out together and their number does not show.
/// Collective. @throws on all ranks as SharedArtifact.
void write_checkpoint(const std::filesystem::path& place, const Engine& engine,
                      const RunProgress& run, const Provenance& provenance);

/// Reads a checkpoint, each rank its part of the identities. Collective. @throws InputError on all
/// ranks if it is damaged anywhere.
Checkpoint read_checkpoint(const std::filesystem::path& place, const Ranks& ranks);

}  // namespace meltproof::solver
