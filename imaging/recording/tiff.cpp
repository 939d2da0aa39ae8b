// SPDX-License-Identifier: GPL-3.0-or-later
// Pages are frames. ImageJ writes stacks beyond 4 GiB with one page only, whose description begins
// with ImageJ= and says images=N; the other frames follow its pixels without gaps.
#include "imaging/recording/tiff.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/bytes.hpp"
#include "imaging/recording/tiff_pixels.hpp"

namespace meltproof::imaging {
namespace {

/// Whether all the data that the page points to lie within the file.
bool is_whole(TIFF* t, std::uint64_t file_size) {
  const bool tiled = TIFFIsTiled(t) != 0;
  std::uint64_t* places = nullptr;
  std::uint64_t* lengths = nullptr;
  TIFFGetField(t, tiled ? TIFFTAG_TILEOFFSETS : TIFFTAG_STRIPOFFSETS, &places);
  TIFFGetField(t, tiled ? TIFFTAG_TILEBYTECOUNTS : TIFFTAG_STRIPBYTECOUNTS, &lengths);
  const std::uint32_t parts = tiled ? TIFFNumberOfTiles(t) : TIFFNumberOfStrips(t);
  if (!places || !lengths) return false;
  for (std::uint32_t i = 0; i < parts; ++i)
    if (places[i] > file_size || lengths[i] > file_size - places[i]) return false;
  return true;
}

/// What ImageJ says in the description of the first page.
struct ImageJ {
  std::uint64_t images = 0;   ///< 0: it says nothing
  double frame_interval = 0;  ///< s; 0: it says nothing
};

ImageJ read_imagej(TIFF* t) {
  const char* description = nullptr;
  ImageJ says;
  if (TIFFGetField(t, TIFFTAG_IMAGEDESCRIPTION, &description) != 1 || !description) return says;
  const std::string text = description;
  if (!text.starts_with("ImageJ=")) return says;
  const auto number = [&](const std::string& key, auto& value) {
    const auto at = text.find("\n" + key + "=");
    if (at == std::string::npos) return;
    const char* begin = text.data() + at + key.size() + 2;
    std::from_chars(begin, text.data() + text.size(), value);
  };
  number("images", says.images);
  number("finterval", says.frame_interval);
  if (!(std::isfinite(says.frame_interval) && says.frame_interval > 0)) says.frame_interval = 0;
  // Other units of time than seconds are named.
  if (text.find("\ntunit=") != std::string::npos && text.find("\ntunit=s") == std::string::npos)
    says.frame_interval = 0;
  return says;
}

/// Where the pixels of a page lie if they lie in one piece as they are, or nothing.
std::optional<std::uint64_t> plain_pixels(TIFF* t, const TiffLayout& layout) {
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint64_t* places = nullptr;
  TIFFGetFieldDefaulted(t, TIFFTAG_COMPRESSION, &compression);
  if (TIFFIsTiled(t) != 0 || compression != COMPRESSION_NONE || layout.bits % 8 != 0)
    return std::nullopt;
  if (TIFFGetField(t, TIFFTAG_STRIPOFFSETS, &places) != 1 || !places) return std::nullopt;
  std::uint32_t rows = layout.height;
  TIFFGetFieldDefaulted(t, TIFFTAG_ROWSPERSTRIP, &rows);
  const std::uint64_t strip = layout.row_bytes(layout.width) * std::uint64_t{rows};
  for (std::uint32_t i = 1; i < TIFFNumberOfStrips(t); ++i)
    if (places[i] != places[0] + i * strip) return std::nullopt;
  return places[0];
}

/// The frames of a stack that ImageJ wrote behind a single page.
Recording open_imagej_stack(RecordingHeader header, const ByteFile& file, const TiffLayout& layout,
                            std::uint64_t start, std::uint64_t images, bool swapped) {
  const std::uint64_t frame_bytes = layout.row_bytes(layout.width) * std::uint64_t{layout.height};
  header.frames = std::min(images, (file.size() - start) / frame_bytes);
  header.frames_lost = images - header.frames;
  return {header, [file, layout, start, frame_bytes, swapped](std::size_t index, Frame& frame) {
            std::string bytes = file.bytes(start + index * frame_bytes, frame_bytes);
            const std::size_t size = layout.bits / 8;
            if (swapped)
              for (auto at = bytes.begin(); at != bytes.end();
                   at += static_cast<std::ptrdiff_t>(size))
                std::reverse(at, at + static_cast<std::ptrdiff_t>(size));
            convert_tiff_row(bytes.data(), frame.values.size(), layout, frame.values.data());
          }};
}

/// Size, limits and times, from what the pages say.
void describe(const TiffLayout& layout, const ImageJ& imagej, std::size_t colour_pages,
              RecordingHeader& header) {
  header.width = layout.width;
  header.height = layout.height;
  if (layout.format == SAMPLEFORMAT_UINT) {
    header.saturation = std::ldexp(1.0, layout.bits) - 1;
    header.under_range = 0;
  }
  if (colour_pages > 0)
    header.notes.push_back(
        fmt::format("{} coloured pages are no signal and were left out.", colour_pages));
  if (layout.white_is_zero)
    header.notes.push_back(
        "The file says that its lowest number is white, so the counts are turned round.");
  if (imagej.frame_interval > 0)
    header.frame_rate = 1 / imagej.frame_interval;
  else
    header.notes.push_back(
        "TIFF stores no times: frame rate and integration time are unknown unless they are given.");
}

/// What the chain of pages holds.
struct Pages {
  /// Of the directories: a page is then reached at once, not by counting.
  std::vector<std::uint64_t> places;
  std::optional<TiffLayout> layout;
  std::size_t lost = 0, coloured = 0;
};

Pages read_pages(TIFF* t, const ByteFile& file) {
  Pages pages;
  const std::string name = file.path().string();
  for (std::size_t page = 0;; ++page) {
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(t, TIFFTAG_SUBFILETYPE, &kind);
    // Previews are no frames.
    const auto here = kind & FILETYPE_REDUCEDIMAGE ? std::nullopt : tiff_layout(t, name, page);
    if (here) {
      if (!pages.layout) pages.layout = here;
      const auto& first = *pages.layout;
      if (*here != first)
        throw InputError(fmt::format(
            "{}: page {} is {} x {} pixels of {} bits, but the first is {} x {} of {}; the frames "
            "of a recording are alike.",
            name, page, here->width, here->height, here->bits, first.width, first.height,
            first.bits));
      if (is_whole(t, file.size()))
        pages.places.push_back(TIFFCurrentDirOffset(t));
      else
        ++pages.lost;
    } else if (!(kind & FILETYPE_REDUCEDIMAGE)) {
      ++pages.coloured;
    }
    if (TIFFLastDirectory(t)) return pages;
    if (!TIFFReadDirectory(t)) {  // the chain of pages is cut off: at least one more was announced
      ++pages.lost;
      return pages;
    }
  }
}

}  // namespace

bool is_tiff(std::string_view first_bytes) {
  using namespace std::string_view_literals;
  for (const auto mark : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})  // + is BigTIFF
    if (first_bytes.starts_with(mark)) return true;
  return false;
}

Recording open_tiff(const std::filesystem::path& path) {
  const ByteFile file(path);
  const TiffHandle tiff = open_tiff_handle(path, file.size());
  TIFF* t = tiff.tiff.get();
  RecordingHeader header;
  header.path = path;
  const ImageJ imagej = read_imagej(t);
  const Pages pages = read_pages(t, file);
  if (!pages.layout && pages.coloured > 0)
    throw InputError(path.string() +
                     ": the pictures are coloured, and colours are no signal; export the camera's "
                     "grey values as one channel.");
  header.frames = pages.places.size();
  header.frames_lost = pages.lost;
  if (!pages.layout) return {header, nullptr};
  const TiffLayout layout = *pages.layout;
  describe(layout, imagej, pages.coloured, header);
  check_frame_size(header);
  if (!tiff_can_hold(layout.row_bytes(layout.width) * std::uint64_t{layout.height}, file.size()))
    throw InputError(fmt::format(
        "{}: the pages are said to have {} x {} pixels, which the file cannot hold; it is damaged.",
        path.string(), layout.width, layout.height));
  if (pages.places.size() == 1 && pages.lost == 0 && imagej.images > 1)
    if (const auto start = plain_pixels(t, layout))
      return open_imagej_stack(header, file, layout, *start, imagej.images, TIFFIsByteSwapped(t));
  return {header, [tiff, size = file.size(), path, places = pages.places, layout](std::size_t index,
                                                                                  Frame& frame) {
            if (!TIFFSetSubDirectory(tiff.tiff.get(), places[index]))
              throw InputError(path.string() + ": page " + std::to_string(index) +
                               " cannot be reached (" + *tiff.last_error +
                               "); the file is damaged.");
            read_tiff_page(tiff, path, size, layout, frame);
          }};
}

}  // namespace meltproof::imaging
