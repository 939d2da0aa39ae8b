// SPDX-License-Identifier: GPL-3.0-or-later
// TIFF, BMP and PNG.
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "imaging/recording/synthetic_bytes.hpp"
#include "imaging/recording/synthetic_files.hpp"

namespace meltproof::imaging::synthetic {
namespace {

using u16 = std::uint16_t;
using u32 = std::uint32_t;

std::string pixel_bytes(const Picture& picture, bool big) {
  Bytes b;
  for (const u16 count : picture.counts) b.add(count, big);
  return b.text;
}

}  // namespace

std::string tiff(const std::vector<Picture>& frames) {
  Bytes b;
  b.text = std::string("II*\0", 4);
  std::size_t link = 4;
  b.add(u32{0});
  for (const auto& picture : frames) {
    const auto pixels = static_cast<u32>(b.text.size());
    b.text += pixel_bytes(picture, false);
    b.put(link, static_cast<u32>(b.text.size()));
    const std::pair<u16, u32> tags[] = {{256, static_cast<u32>(picture.width)},
                                        {257, static_cast<u32>(picture.height)},
                                        {258, 16},
                                        {259, 1},
                                        {262, 1},
                                        {273, pixels},
                                        {277, 1},
                                        {278, static_cast<u32>(picture.height)},
                                        {279, static_cast<u32>(2 * picture.counts.size())}};
    b.add(static_cast<u16>(std::size(tags)));
    for (const auto& [tag, value] : tags) {
      b.add(tag);
      b.add(u16{4});  // every value as u32
      b.add(u32{1});
      b.add(value);
    }
    link = b.text.size();
    b.add(u32{0});
  }
  return b.text;
}

namespace {

using Tag = std::pair<u16, u32>;

/// A TIFF with one page: its directory, then `behind`, which begins with the pixels. A tag that is
/// text points to `description`.
std::string one_page(std::vector<Tag> tags, const std::string& description,
                     const std::string& behind, bool big) {
  const std::size_t directory = 8;
  const auto text = static_cast<u32>(directory + 2 + 12 * tags.size() + 4);
  Bytes b;
  b.text = big ? std::string("MM\0*", 4) : std::string("II*\0", 4);
  b.add(static_cast<u32>(directory), big);
  b.add(static_cast<u16>(tags.size()), big);
  for (auto [tag, value] : tags) {
    b.add(tag, big);
    b.add(u16{tag == 270 ? u16{2} : u16{4}}, big);  // text, or u32
    b.add(tag == 270 ? static_cast<u32>(description.size()) : u32{1}, big);
    if (tag == 270) value = text;
    if (tag == 273) value = text + static_cast<u32>(description.size());
    b.add(value, big);
  }
  b.add(u32{0}, big);
  return b.text + description + behind;
}

}  // namespace

std::string imagej_stack(const std::vector<Picture>& frames, std::size_t announced) {
  const auto& first = frames[0];
  std::string pixels;
  for (const auto& frame : frames) pixels += pixel_bytes(frame, true);
  return one_page({{256, static_cast<u32>(first.width)},
                   {257, static_cast<u32>(first.height)},
                   {258, 16},
                   {259, 1},
                   {262, 1},
                   {270, 0},
                   {273, 0},
                   {277, 1},
                   {278, static_cast<u32>(first.height)},
                   {279, static_cast<u32>(2 * first.counts.size())}},
                  fmt::format("ImageJ=1.53t\nimages={}\nslices={}\nfinterval=0.002\nloop=false\n",
                              announced, announced) +
                      '\0',
                  pixels, true);
}

std::string tiff_12(const Picture& picture, bool white) {
  std::string packed;
  for (std::size_t y = 0; y < picture.height; ++y) {
    u32 held = 0;
    unsigned bits = 0;
    for (std::size_t x = 0; x < picture.width; ++x) {
      held = held << 12 | picture.counts[y * picture.width + x] >> 4;
      for (bits += 12; bits >= 8; bits -= 8) packed += static_cast<char>(held >> (bits - 8) & 0xFF);
    }
    if (bits > 0) packed += static_cast<char>(held << (8 - bits) & 0xFF);  // rows begin at a byte
  }
  return one_page({{256, static_cast<u32>(picture.width)},
                   {257, static_cast<u32>(picture.height)},
                   {258, 12},
                   {259, 1},
                   {262, white ? 0U : 1U},
                   {273, 0},
                   {277, 1},
                   {278, static_cast<u32>(picture.height)},
                   {279, static_cast<u32>(packed.size())}},
                  "", packed, false);
}

std::string bmp(const Picture& picture) {
  const std::size_t row = (picture.width + 3) / 4 * 4, start = 54 + 1024;
  Bytes b;
  b.text.assign(start, '\0');
  b.text.replace(0, 2, "BM");
  b.put(2, static_cast<u32>(start + row * picture.height));
  b.put(10, static_cast<u32>(start));
  b.put(14, u32{40});
  b.put(18, static_cast<u32>(picture.width));
  b.put(22, static_cast<u32>(picture.height));
  b.put(26, u16{1});
  b.put(28, u16{8});
  for (u32 i = 0; i < 256; ++i) b.put(54 + 4 * i, i * 0x010101);
  for (std::size_t y = picture.height; y-- > 0;) {  // from the bottom up
    std::string line(row, '\0');
    for (std::size_t x = 0; x < picture.width; ++x)
      line[x] = static_cast<char>(picture.counts[y * picture.width + x] >> 7);
    b.text += line;
  }
  return b.text;
}

std::string png(const Picture& picture) {
  const cv::Mat image(static_cast<int>(picture.height), static_cast<int>(picture.width), CV_16U,
                      const_cast<u16*>(picture.counts.data()));
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace meltproof::imaging::synthetic
