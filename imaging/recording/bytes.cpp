// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/bytes.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/error.hpp"

namespace meltproof::imaging {

ByteFile::ByteFile(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(path.string() + ": there is no such file; check the name of the recording.");
  size_ = std::filesystem::file_size(path, error);
  stream_ = std::make_shared<std::ifstream>(path, std::ios::binary);
  if (error || !*stream_)
    throw InputError(path.string() + ": the file cannot be read; check its permissions.");
}

ByteFile::ByteFile(std::filesystem::path path, std::string content)
    : path_(std::move(path)),
      size_(content.size()),
      content_(std::make_shared<const std::string>(std::move(content))) {}

void ByteFile::read(std::uint64_t offset, std::uint64_t count, char* into) const {
  // Written so that no sum can overflow: offsets come from files that may be damaged.
  if (offset <= size_ && count <= size_ - offset) {
    if (content_) {
      std::copy_n(content_->data() + offset, count, into);
      return;
    }
    stream_->clear();
    stream_->seekg(static_cast<std::streamoff>(offset));
    stream_->read(into, static_cast<std::streamsize>(count));
    if (static_cast<std::uint64_t>(stream_->gcount()) == count) return;
  }
  throw InputError(path_.string() + ": " + std::to_string(count) + " bytes are expected at byte " +
                   std::to_string(offset) + ", but the file ends at byte " + std::to_string(size_) +
                   "; copy it again from its source.");
}

std::string ByteFile::bytes(std::uint64_t offset, std::uint64_t count) const {
  if (count > size_) read(offset, count, nullptr);  // throws before that much memory is asked for
  std::string result(count, '\0');
  read(offset, count, result.data());
  return result;
}

std::string ByteFile::beginning(std::uint64_t most) const {
  return bytes(0, std::min(most, size_));
}

double decimal(float value) {
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, value);
  double result = static_cast<double>(value);
  std::from_chars(text, written.ptr, result);
  return result;
}

void widen(const std::string& bytes, std::endian order, std::vector<float>& into) {
  const std::size_t low = order == std::endian::little ? 0 : 1;
  const auto byte = [&](std::size_t i) {
    return static_cast<unsigned>(static_cast<unsigned char>(bytes[i]));
  };
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i] = static_cast<float>(byte(2 * i + low) | byte(2 * i + 1 - low) << 8);
}

}  // namespace meltproof::imaging
