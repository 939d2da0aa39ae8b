// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stop_request.hpp"

namespace meltproof {
namespace {

volatile std::sig_atomic_t requested = 0;

void note(int) { requested = 1; }

}  // namespace

StopRequest::StopRequest() {
  requested = 0;
  struct sigaction action {};
  action.sa_handler = note;
  // Once: the second signal finds the default action again. Interrupted system calls go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  sigaction(SIGTERM, &action, &before_term_);
  sigaction(SIGINT, &action, &before_int_);
}

StopRequest::~StopRequest() {
  sigaction(SIGTERM, &before_term_, nullptr);
  sigaction(SIGINT, &before_int_, nullptr);
}

bool StopRequest::made() const { return requested != 0; }

}  // namespace meltproof
