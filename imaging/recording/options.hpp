// SPDX-License-Identifier: GPL-3.0-or-later
// What a user says about a file that does not say it itself.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace meltproof::imaging {

/// Every field may be left empty; the reader then finds out, or refuses with a sentence that names
/// the choices. A reader ignores what is not about its format.
struct ReadOptions {
  /// HDF5, MATLAB: the array with the frames by its path, "scan/frames".
  std::string dataset = {};
  /// HDF5, MATLAB: what the array's indices count, as a program in the file's own language writes
  /// them: letters f (frame), h (row), w (column). Python's frames[f, y, x] is "fhw", the default
  /// of HDF5; MATLAB's frames(y, x, f) is "hwf", the default of MATLAB.
  std::string axes = {};
  /// CSV: what stands between two values: "tab", "space", ",", ";" or "|".
  std::string separator = {};
  /// CSV: "." or ",".
  std::string decimal = {};
  /// CSV: how many lines at the beginning of the file hold no pixels.
  std::optional<std::size_t> preamble_lines = {};
  /// CSV: rows of a frame, for files in which nothing separates one frame from the next.
  std::optional<std::size_t> frame_rows = {};
  /// What values are whose file does not say it: "count", "K" or "degC".
  std::string unit = {};
};

}  // namespace meltproof::imaging
