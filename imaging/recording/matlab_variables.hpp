// SPDX-License-Identifier: GPL-3.0-or-later
// The variables of a MATLAB 5 file that may hold frames.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <matio.h>

namespace meltproof::imaging {

/// Whether a variable of real numbers has three dimensions, or two that are more than one row.
bool is_stack_or_picture(const matvar_t& v);
/// Drops dimensions of one value from a variable that has more than three (see counting_dims()):
/// matio reads parts of three dimensions as they are, and of four some zeros.
void drop_single_dims(matvar_t& v);
/// "480 x 640 x 100".
std::string matlab_shape_text(const matvar_t& v);
/// A variable that frees itself.
std::shared_ptr<matvar_t> owned_variable(matvar_t* v);

/// The only stack; where there is none, the only picture, or those that are the frames of one
/// recording, in order.
/// @throws InputError if there is none, or if the choice is the user's.
std::vector<std::shared_ptr<matvar_t>> choose_variables(const std::filesystem::path& path,
                                                        mat_t* file);

}  // namespace meltproof::imaging
