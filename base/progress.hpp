// SPDX-License-Identifier: GPL-3.0-or-later
// How far long work has come, and how long it will still take.
#pragma once

#include <chrono>
#include <string>

namespace meltproof {

/// Shows progress on standard error: one line rewritten in place on a terminal, a plain line every
/// ten seconds otherwise. Silent for work that ends within a second.
class Progress {
 public:
  /// @param what what is being done, for example "solve"; @param total the amount of work;
  /// @param before how much of it was done earlier, by a run that this one continues.
  Progress(std::string what, double total, double before = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// @param done work done so far, in the units of total; @param detail a few words shown behind
  /// it.
  void update(double done, const std::string& detail = "");
  /// For work whose amount nobody can tell: only the words, no share and no time left.
  void say(const std::string& detail);
  /// Ends the line; called by the destructor.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  /// Whether it is time for another line, and remembers that there was one.
  bool due();
  std::string what_;
  double total_, before_;
  bool terminal_, shown_ = false, finished_ = false;
  Clock::time_point start_, last_;
};

/// A duration in words a person reads: "8 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace meltproof
