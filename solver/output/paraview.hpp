// SPDX-License-Identifier: GPL-3.0-or-later
// The snapshots of a run in the forms that ParaView opens without a plugin.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meltproof::solver {

/// The text of an XDMF file that points into `run` (a run.h5 with the name under which it stands
/// beside the XDMF file): one grid of points per snapshot at its time, every field as a point
/// attribute named with its unit. No number is copied, so it stays a few kilobytes.
/// @throws InputError if `run` is no run, or holds no snapshots.
std::string xdmf(const std::filesystem::path& run);

/// Writes `run` with the extension .xdmf beside it. @returns its path.
std::filesystem::path write_xdmf(const std::filesystem::path& run);

/// Writes every snapshot of `run` as <folder>/<number>.vtu (points and their fields, binary) and
/// <folder>/<stem of run>.pvd with their times: for readers without XDMF, as Debian's VTK is. What
/// the run holds is copied. @returns the paths written, the .pvd last.
/// @throws InputError as xdmf().
std::vector<std::filesystem::path> write_vtu(const std::filesystem::path& run,
                                             const std::filesystem::path& folder);

}  // namespace meltproof::solver
