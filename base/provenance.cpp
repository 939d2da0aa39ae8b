// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/provenance.hpp"

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "revision.hpp"
#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/opensslv.h>
#include <spdlog/version.h>
#include <toml++/impl/version.h>

#include "base/artifact_hdf5.hpp"
#include "base/error.hpp"

namespace meltproof {
namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) {
      throw std::runtime_error("OpenSSL offers no SHA-256");
    }
  }
  void add(const char* bytes, std::size_t count) { EVP_DigestUpdate(context_.get(), bytes, count); }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
    std::string text;
    for (unsigned int i = 0; i < length; ++i) {
      text += fmt::format("{:02x}", digest[i]);
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

std::map<std::string, std::string> library_versions() {
  unsigned int major = 0, minor = 0, release = 0;
  prepare_hdf5();
  H5get_libversion(&major, &minor, &release);
  return {
      {"compiler", fmt::format("{}", __VERSION__)},
      {"HDF5", fmt::format("{}.{}.{}", major, minor, release)},
      {"OpenSSL", OPENSSL_VERSION_TEXT},
      {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
      {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"spdlog", fmt::format("{}.{}.{}", SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH)}};
}

}  // namespace

std::string sha256_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) {
    throw InputError(
        fmt::format("{} cannot be read: no such file, or no permission", path.string()));
  }
  Sha256 sum;
  std::array<char, 1 << 16> block{};
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    sum.add(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return sum.hexadecimal();
}

std::string sha256_text(const std::string& text) {
  Sha256 sum;
  sum.add(text.data(), text.size());
  return sum.hexadecimal();
}

std::string code_revision() { return MELTPROOF_REVISION; }
std::string suite_version() { return MELTPROOF_VERSION; }

void Provenance::add_input(const std::filesystem::path& path) {
  inputs.push_back({path.string(), sha256_file(path)});
}

Provenance begin_provenance(int argc, const char* const* argv) {
  Provenance provenance;
  provenance.program = argc > 0 ? std::filesystem::path(argv[0]).filename().string() : "";
  provenance.command = provenance.program;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain = argument.find_first_of(" \"'$\\") == std::string::npos && !argument.empty();
    provenance.command += plain ? " " + argument : fmt::format(" \"{}\"", argument);
  }
  provenance.libraries = library_versions();
  provenance.started = std::chrono::steady_clock::now();
  return provenance;
}

double Provenance::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

nlohmann::json Provenance::json() const {
  nlohmann::json files = nlohmann::json::array();
  for (const auto& input : inputs) {
    files.push_back({{"path", input.path}, {"sha256", input.sha256}});
  }
  return {{"program", program},
          {"version", suite_version()},
          {"revision", code_revision()},
          {"command", command},
          {"resolved_input", resolved_input},
          {"inputs", files},
          {"libraries", libraries},
          {"seed", seed},
          {"ranks", ranks},
          {"threads", threads},
          {"wall_time_s", wall_time}};
}

}  // namespace meltproof
