// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of every program of the suite: standard options, log, errors as sentences, exit status.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "base/input.hpp"

namespace meltproof {

/// A command-line program: construct it, add options to `app`, then run().
/// Gives every program `--help`, `--version`, `--quiet`, a footer with the exit statuses, and turns
/// an InputError into "name: error: sentence" with status 2, any other exception into status 1.
class Program {
 public:
  /// @param name "meltproof-solve"; @param about what it does, with an example a user can type.
  Program(const std::string& name, const std::string& about);
  CLI::App app;
  /// Parses the command line and calls `body`, whose result is the exit status.
  int run(int argc, const char* const* argv, const std::function<ExitStatus()>& body);
  bool quiet() const { return quiet_; }
  /// One of several processes of which another speaks: says nothing but what failed only here.
  void hush() { hushed_ = true; }

 private:
  std::string name_;
  bool quiet_ = false, hushed_ = false;
};

/// Options of a program that takes a TOML input: the file, `--set key=value`, `--validate`,
/// `--schema`, `--reference`.
struct InputOptions {
  std::string path;
  std::vector<std::string> overrides;
  bool validate = false, schema = false, reference = false;
  void add_to(CLI::App& app, const std::string& what);
  /// Answers --schema and --reference, reads the input, answers --validate. Returns true when the
  /// program has nothing more to do. @throws InputError as Input::read, or if no file was named.
  bool handle(Input& input) const;
  /// Whether handle() will only print something.
  bool only_asks() const { return validate || schema || reference; }
};

}  // namespace meltproof
