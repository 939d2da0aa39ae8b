// SPDX-License-Identifier: GPL-3.0-or-later
// Layout: 128 bytes of text, at 126 the letters IM if little endian and MI if big. Then elements:
// u32 type, u32 length, content. Type 14 is a variable, 15 a compressed one. A variable consists of
// elements again, each filled up to 8 bytes: flags (type 6, 8 bytes), dimensions (type 5), name
// (type 1), numbers. An element of at most four bytes may instead be u16 type, u16 length and its
// content in the next four.
#include "imaging/recording/mat5_elements.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

constexpr std::uint64_t header_size = 128, tag_size = 8;
constexpr std::uint32_t name_type = 1, dimensions_type = 5, flags_type = 6, variable = 14,
                        compressed_variable = 15;
constexpr std::uint64_t most_dimensions = 32, longest_name = 4096;
// The low byte of the flags says what the variable is. Cells, structs and objects hold elements.
constexpr std::uint32_t cell_class = 1, struct_class = 2, object_class = 3;
// DEFLATE gains a factor of 1032 at most.
constexpr std::uint64_t most_gain = 1032;

struct Tag {
  std::uint32_t type = 0;
  std::uint64_t length = 0, content = 0, next = 0;
};

Tag read_tag(const ByteFile& file, std::uint64_t at, std::endian order) {
  const std::string b = file.bytes(at, tag_size);
  const auto first = number_at<std::uint32_t>(b, 0, order);
  if (first >> 16 != 0)
    return {first & 0xFFFF, std::min<std::uint64_t>(first >> 16, 4), at + 4, at + tag_size};
  const std::uint64_t length = number_at<std::uint32_t>(b, 4, order);
  return {first, length, at + tag_size, at + tag_size + (length + 7) / 8 * 8};
}

[[noreturn]] void refuse(const ByteFile& file, std::uint64_t at, const std::string& what) {
  throw InputError(
      fmt::format("{}: the MATLAB variable at byte {} {}; the file is damaged or cut "
                  "off, copy it again from its source.",
                  file.path().string(), at, what));
}

/// Refuses cells and structs of more elements than have room in them: matio asks for a pointer to
/// each before it reads the first. A struct without fields has elements of no length, which are as
/// many as `fieldless` at most.
void check_elements(const ByteFile& file, std::endian order, const Mat5Element& element,
                    std::uint32_t kind, const Tag& dimensions) {
  constexpr double fieldless = 4096;
  if (kind != cell_class && kind != struct_class && kind != object_class) return;
  const std::string sizes = file.bytes(dimensions.content, dimensions.length);
  double count = 1;
  for (std::size_t at = 0; at + 4 <= sizes.size(); at += 4)
    count *= number_at<std::uint32_t>(sizes, at, order);
  if (kind != cell_class && count <= fieldless) return;
  if (count * tag_size > static_cast<double>(element.length))
    refuse(file, element.place,
           fmt::format("is said to hold {} elements in {} bytes", count, element.length));
}

/// Flags, dimensions, name and the place of the numbers; nothing for objects that have no such
/// parts.
void read_parts(const ByteFile& file, std::endian order, Mat5Element& element) {
  const std::uint64_t end = std::min(file.size(), element.place + element.length);
  std::uint64_t at = element.place;
  std::uint32_t kind = 0;
  for (const auto expected : {flags_type, dimensions_type, name_type}) {
    if (at > end || end - at < tag_size) refuse(file, element.place, "ends within its description");
    const Tag tag = read_tag(file, at, order);
    const std::uint64_t most = expected == flags_type        ? 8
                               : expected == dimensions_type ? 4 * most_dimensions
                                                             : longest_name;
    if (tag.type != expected || tag.length > most || tag.next > end)
      refuse(file, element.place,
             fmt::format("has a part of type {} and {} bytes where type {} is expected", tag.type,
                         tag.length, expected));
    if (expected == flags_type && tag.length >= 4)
      kind = number_at<std::uint32_t>(file.bytes(tag.content, 4), 0, order) & 0xFF;
    if (expected == dimensions_type) check_elements(file, order, element, kind, tag);
    if (expected == name_type) element.name = file.bytes(tag.content, tag.length);
    at = tag.next;
  }
  if (at > end || end - at < tag_size) return;
  const Tag data = read_tag(file, at, order);
  if (data.content > element.place + element.length ||
      data.length > element.place + element.length - data.content)
    refuse(file, element.place, "has numbers beyond its own end");
  element.data_place = data.content;
  element.data_length = data.length;
}

/// The first bytes of a compressed variable, as many as its description can have, decompressed.
std::string inflate_head(const ByteFile& file, const Mat5Element& element) {
  constexpr std::size_t most = 3 * tag_size + 8 + 4 * most_dimensions + longest_name + 64;
  const std::string packed =
      file.bytes(element.place,
                 std::min({element.length, file.size() - element.place, std::uint64_t{2 * most}}));
  std::string head(most, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(head.size());
  if (inflateInit(&stream) == Z_OK) inflate(&stream, Z_SYNC_FLUSH);
  head.resize(head.size() - stream.avail_out);
  inflateEnd(&stream);
  return head;
}

/// The same as read_parts() for a compressed variable: matio asks for as much memory as the
/// description inside says.
void read_compressed_parts(const ByteFile& file, std::endian order, Mat5Element& element) {
  const ByteFile head(file.path(), inflate_head(file, element));
  if (head.size() < tag_size) refuse(file, element.place, "cannot be decompressed");
  const Tag tag = read_tag(head, 0, order);
  if (tag.type != variable || tag.content != tag_size)
    refuse(file, element.place, fmt::format("holds type {}, expected 14", tag.type));
  if (tag.length / most_gain > element.length)
    refuse(file, element.place,
           fmt::format("is said to hold {} bytes, which {} compressed ones cannot", tag.length,
                       element.length));
  Mat5Element inside{tag_size, tag.length, true, "", 0, 0};
  read_parts(head, order, inside);
  element.name = inside.name;
  element.data_length = inside.data_length;
}

}  // namespace

std::vector<Mat5Element> read_mat5_elements(const ByteFile& file) {
  if (file.size() < header_size + tag_size)
    throw InputError(
        fmt::format("{}: a MATLAB file has more than {} bytes, this one has {}; copy "
                    "it again from its source.",
                    file.path().string(), header_size + tag_size, file.size()));
  const std::string mark = file.bytes(126, 2);
  if (mark != "IM" && mark != "MI")
    throw InputError(file.path().string() +
                     ": the MATLAB file does not say its byte order; the file is damaged.");
  const auto order = mark == "IM" ? std::endian::little : std::endian::big;
  std::vector<Mat5Element> elements;
  for (std::uint64_t at = header_size; file.size() - at >= tag_size;) {
    const std::string tag = file.bytes(at, tag_size);
    const auto type = number_at<std::uint32_t>(tag, 0, order);
    if (type != variable && type != compressed_variable)
      refuse(file, at, fmt::format("is of type {}, expected 14 or 15", type));
    Mat5Element element{at + tag_size,
                        number_at<std::uint32_t>(tag, 4, order),
                        type == compressed_variable,
                        "",
                        0,
                        0};
    if (element.compressed)
      read_compressed_parts(file, order, element);
    else
      read_parts(file, order, element);
    elements.push_back(element);
    at = std::min(file.size(), element.place + element.length);
  }
  return elements;
}

}  // namespace meltproof::imaging
