// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.hpp"

namespace meltproof {

AtomicFile::AtomicFile(std::filesystem::path place) : place_(std::move(place)) {
  const auto folder = place_.has_parent_path() ? place_.parent_path() : std::filesystem::path(".");
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem || !std::filesystem::is_directory(folder) || ::access(folder.c_str(), W_OK) != 0) {
    throw InputError(fmt::format("the folder {} cannot be written{}: choose another place for {}",
                                 folder.string(), problem ? " (" + problem.message() + ")" : "",
                                 place_.filename().string()));
  }
  temporary_ = folder / fmt::format(".{}.{}.tmp{}", place_.stem().string(), ::getpid(),
                                    place_.extension().string());
}

AtomicFile::~AtomicFile() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
}

void AtomicFile::commit() {
  // The name must not reach the disk before the content does, or a machine that loses power leaves
  // an empty file in the place of a good one.
  if (const int file = ::open(temporary_.c_str(), O_RDONLY); file >= 0) {
    ::fsync(file);
    ::close(file);
  }
  std::error_code problem;
  std::filesystem::rename(temporary_, place_, problem);
  if (problem) {
    throw std::runtime_error(fmt::format("{} cannot be put in place: {}; nothing was changed",
                                         place_.string(), problem.message()));
  }
  committed_ = true;
}

void write_file(const std::filesystem::path& place, const std::string& content) {
  AtomicFile file(place);
  {
    std::ofstream stream(file.temporary(), std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) {
      throw std::runtime_error(fmt::format("{} cannot be written: {}; nothing was left behind",
                                           place.string(), std::strerror(errno)));
    }
  }
  file.commit();
}

std::string read_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("{} is a folder, expected a file", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(fmt::format(
        "{} cannot be opened: {}", path.string(),
        std::filesystem::exists(path, ignored) ? std::strerror(errno) : "there is no such file"));
  }
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

}  // namespace meltproof
