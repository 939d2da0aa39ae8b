// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/guarded.hpp"

#include <cerrno>
#include <csignal>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.hpp"

namespace meltproof::imaging {

void try_in_child(const std::filesystem::path& path, const char* library,
                  const std::function<void()>& attempt) {
  const pid_t child = ::fork();
  if (child < 0) return;
  if (child == 0) {
    for (const int s : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE}) std::signal(s, SIG_DFL);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    try {
      attempt();
    } catch (...) {  // said by the parent's own attempt
    }
    ::_exit(0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  // A sanitizer ends a program by itself, with a status of its own.
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
    throw InputError(
        fmt::format("{}: the file is damaged so that the {} library breaks off on it (status {}). "
                    "Copy it again "
                    "from its source.",
                    path.string(), library, WEXITSTATUS(status)));
  if (WIFSIGNALED(status) && WTERMSIG(status) != SIGINT && WTERMSIG(status) != SIGTERM)
    throw InputError(
        fmt::format("{}: the file is damaged so that the {} library breaks off on it (signal {}). "
                    "Copy it again from its source.",
                    path.string(), library, WTERMSIG(status)));
}

}  // namespace meltproof::imaging
