// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace meltproof {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  if (whole < 60) {
    return fmt::format("{} s", whole);
  }
  if (whole < 3600) {
    return fmt::format("{} min {} s", whole / 60, whole % 60);
  }
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(std::string what, double total, double before)
    : what_(std::move(what)),
      total_(total),
      before_(before),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() { finish(); }

bool Progress::due() {
  const auto now = Clock::now();
  const std::chrono::duration<double> since_start = now - start_, since_last = now - last_;
  const double pause = terminal_ ? 0.2 : 10.0;
  if (since_start.count() < 1.0 || since_last.count() < pause) {
    return false;
  }
  last_ = now;
  shown_ = true;
  return true;
}

void Progress::say(const std::string& detail) {
  if (due()) {
    fmt::print(stderr, "{}{}: {}{}", terminal_ ? "\r\x1b[K" : "", what_, detail,
               terminal_ ? "" : "\n");
    std::fflush(stderr);
  }
}

void Progress::update(double done, const std::string& detail) {
  if (!due()) {
    return;
  }
  const std::chrono::duration<double> since_start = last_ - start_;
  const double share = total_ > 0 ? std::min(1.0, done / total_) : 0;
  // The time left assumes a steady rate, which holds once a run is under way.
  const double here = total_ > 0 ? share - before_ / total_ : 0;
  const std::string left = here > 0.005
                               ? duration_text(since_start.count() * (1 - share) / here) + " left"
                               : "estimating";
  fmt::print(stderr, "{}{}: {:5.1f} %, {}{}{}{}", terminal_ ? "\r\x1b[K" : "", what_, 100 * share,
             left, detail.empty() ? "" : "; ", detail, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void Progress::finish() {
  if (!finished_ && shown_ && terminal_) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }
  finished_ = true;
}

}  // namespace meltproof
