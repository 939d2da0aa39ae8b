// SPDX-License-Identifier: GPL-3.0-or-later
// Frames that were saved as arrays of their own: Frame1, Frame2, ...
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace meltproof::imaging {

/// An array by its name, and its size.
struct NamedShape {
  std::string name;
  std::vector<std::size_t> shape;
};

/// The arrays that are one shape and whose names differ in their last number only, by their places
/// in `arrays`, in the order of these numbers: what camera software writes that saves every frame
/// as a variable. Nothing if fewer than two are, or if as many others are there.
std::vector<std::size_t> picture_series(const std::vector<NamedShape>& arrays);

}  // namespace meltproof::imaging
