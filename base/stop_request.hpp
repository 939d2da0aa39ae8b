// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <csignal>

namespace meltproof {

/// While it lives, SIGTERM (a batch queue) and SIGINT (Ctrl-C) no longer end the program but are
/// noted, so that long work can put itself in order first. A second signal of either kind ends the
/// program at once. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  /// Whether one has come since.
  bool made() const;

 private:
  struct sigaction before_term_ {
  }, before_int_{};
};

}  // namespace meltproof
