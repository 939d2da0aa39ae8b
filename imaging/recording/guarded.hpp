// SPDX-License-Identifier: GPL-3.0-or-later
// Opening a file with a library that some damaged files bring down.
#pragma once

#include <filesystem>
#include <functional>

namespace meltproof::imaging {

/// Does `attempt` in a child process first, whose end by a signal does not end this one. What the
/// child throws is left to the caller's own attempt; it has no other effect here.
/// @throws InputError if the child is ended by a signal or by a sanitizer: the file is damaged so
/// that `library`
///         cannot read it. Where no child can be made, nothing is tried.
void try_in_child(const std::filesystem::path& path, const char* library,
                  const std::function<void()>& attempt);

}  // namespace meltproof::imaging
