// SPDX-License-Identifier: GPL-3.0-or-later
// What fails on one rank fails on all of them.
#pragma once

#include <chrono>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>

#include "base/error.hpp"
#include "solver/parallel/ranks.hpp"

namespace meltproof::solver {

/// Runs work() here. If it throws on any rank, all throw what the first of these says, so that none
/// waits for ever for one that has given up. Collective, but work() must not be.
/// @throws InputError where that rank did, else std::runtime_error.
template <class Work>
void agree(const Ranks& ranks, const Work& work) {
  constexpr char input = 'i', other = 'o';
  std::string problem;
  try {
    work();
  } catch (const InputError& found) {
    problem = input + std::string(found.what());
  } catch (const std::exception& found) {
    problem = other + std::string(found.what());
  }
  problem = ranks.said(problem);
  if (problem.empty()) {
    return;
  }
  if (problem.front() == input) {
    throw InputError(problem.substr(1));
  }
  if (!ranks.root()) {
    // All are about to say the same; where that ends the program, the root has done so by then.
    std::this_thread::sleep_for(std::chrono::seconds(5));
  }
  throw std::runtime_error(problem.substr(1));
}

/// Runs work() on the root; what it throws there, all throw. Collective.
template <class Work>
void on_root(const Ranks& ranks, const Work& work) {
  agree(ranks, [&] {
    if (ranks.root()) {
      work();
    }
  });
}

}  // namespace meltproof::solver
