// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.hpp"

#include <chrono>
#include <exception>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/provenance.hpp"

namespace meltproof {

Program::Program(const std::string& name, const std::string& about)
    : app(about, name), name_(name) {
  app.set_version_flag("--version",
                       fmt::format("{} {} ({})", name, suite_version(), code_revision()));
  app.add_flag("-q,--quiet", quiet_, "say only what went wrong");
  app.footer(
      "Exit status: 0 done; 1 could not finish; 2 input refused, nothing written; 3 input read "
      "and\n"
      "described, but what was looked for is not in it; 4 input ends early, results stand for its "
      "whole\n"
      "frames; 5 stopped by a signal, with a checkpoint to go on from.");
}

int Program::run(int argc, const char* const* argv, const std::function<ExitStatus()>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    std::ostringstream nobody;
    const int status = hushed_ ? app.exit(problem, nobody, nobody) : app.exit(problem);
    return status == 0 ? 0 : static_cast<int>(ExitStatus::bad_input);
  }
  // Log lines go to standard error, so that standard output stays the result.
  auto log = spdlog::stderr_color_mt(name_);
  log->set_pattern("%n: %v");
  spdlog::set_default_logger(log);
  spdlog::set_level(hushed_  ? spdlog::level::err
                    : quiet_ ? spdlog::level::warn
                             : spdlog::level::info);
  try {
    return static_cast<int>(body());
  } catch (const InputError& problem) {
    if (hushed_) {
      // Where all find the same, the one that speaks has ended all of them by now.
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
    fmt::print(stderr, "{}: error: {}\n", name_, problem.what());
    return static_cast<int>(ExitStatus::bad_input);
  } catch (const Stopped& request) {
    if (!hushed_) {
      fmt::print(stderr, "{}: stopped: {}\n", name_, request.what());
    }
    return static_cast<int>(ExitStatus::stopped);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}: failed: {}\n", name_, problem.what());
    return static_cast<int>(ExitStatus::failure);
  }
}

void InputOptions::add_to(CLI::App& app, const std::string& what) {
  app.add_option("input", path, what + " (TOML)");
  app.add_option("--set", overrides,
                 "replace one value: --set laser.power=\"200 W\"; may be repeated")
      ->type_name("KEY=VALUE");
  app.add_flag("--validate", validate,
               "check the input, print it with every default filled in, and stop");
  app.add_flag("--schema", schema, "print the JSON Schema of the input and stop");
  app.add_flag("--reference", reference,
               "print the reference page of the input (Markdown) and stop");
}

bool InputOptions::handle(Input& input) const {
  if (schema) {
    fmt::print("{}\n", input.schema().dump(2));
    return true;
  }
  if (reference) {
    fmt::print("{}", input.reference());
    return true;
  }
  if (path.empty()) {
    throw InputError("no input file was named; see --help for an example");
  }
  input.read(path, overrides);
  if (validate) {
    fmt::print("{}", input.resolved());
  }
  return validate;
}

}  // namespace meltproof
