// SPDX-License-Identifier: GPL-3.0-or-later
// The errors that a user meets, each a whole sentence, and the exit statuses of every program.
#pragma once

#include <stdexcept>
#include <string>

namespace meltproof {

/// Exit statuses shared by every program of the suite; `--help` prints them.
enum class ExitStatus : int {
  success = 0,    ///< everything asked for was done
  failure = 1,    ///< the program could not finish (disk full, internal error)
  bad_input = 2,  ///< an argument, file, key or value was refused; nothing was written
  no_result = 3,  ///< the input was read and described, but what was looked for is not in it
  truncated = 4,  ///< the input ends early: results stand for its whole frames only
  stopped = 5,    ///< asked to stop by a signal: a checkpoint is written, to go on from
};

/// Something the user gave cannot be used. The message is one or two sentences that name the file
/// and the key, frame or value, what was found, what was expected, and what to do.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user or a batch queue asked the program to stop, and it has put its work in order. The
/// message says how to go on.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace meltproof
