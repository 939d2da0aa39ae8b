// SPDX-License-Identifier: GPL-3.0-or-later
// InfraTec IRB: single pictures and sequences of the IRBIS software.
#pragma once

#include <filesystem>
#include <string_view>

#include "imaging/recording/recording.hpp"

namespace meltproof::imaging {

/// Whether a file begins with FF and the letters IRB.
bool is_irb(std::string_view first_bytes);
/// Temperatures in K by the table that each frame carries.
/// @throws InputError if the file is damaged or compressed in an unknown way.
Recording open_irb(const std::filesystem::path& path);

}  // namespace meltproof::imaging
