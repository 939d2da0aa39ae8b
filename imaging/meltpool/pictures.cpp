// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {
namespace {

const cv::Scalar paper(255, 255, 255), ink(40, 40, 40), faint(130, 130, 130),
    edge_colour(255, 255, 0);  // BGR
constexpr int font = cv::FONT_HERSHEY_SIMPLEX;

/// Text with its lower left corner at (x, y). The font has ASCII only.
void write(cv::Mat& canvas, const std::string& text, int x, int y, double size = 0.5,
           const cv::Scalar& colour = ink) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](unsigned char c) { return c >= 0x80; }, '?');
  cv::putText(canvas, plain, {x, y}, font, size, colour, 1, cv::LINE_AA);
}

int text_width(const std::string& text, double size = 0.5) {
  int baseline = 0;
  return cv::getTextSize(text, font, size, 1, &baseline).width;
}

/// `text` in lines no wider than `width` pixels.
std::vector<std::string> wrapped(const std::string& text, int width, double size = 0.5) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (text_width(longer, size) > width && !lines.back().empty())
      lines.push_back(word);
    else
      lines.back() = longer;
    at = space + 1;
  }
  return lines;
}

/// Values between low and high in false colour, each pixel `zoom` pixels wide.
cv::Mat coloured(const std::vector<float>& values, std::size_t width, double low, double high,
                 double zoom) {
  const int columns = static_cast<int>(width), rows = static_cast<int>(values.size() / width);
  cv::Mat grey(rows, columns, CV_8U);
  const double scale = high > low ? 255 / (high - low) : 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const auto v = static_cast<double>(
          values[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)]);
      grey.at<unsigned char>(y, x) = static_cast<unsigned char>(
          std::isfinite(v) ? std::clamp((v - low) * scale, 0.0, 255.0) : 0);
    }
  cv::Mat colour, large;
  cv::applyColorMap(grey, colour, cv::COLORMAP_INFERNO);
  cv::resize(colour, large, {}, zoom, zoom, zoom >= 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  return large;
}

/// Draws the edge; a pixel's centre (0, 0) lies half an enlarged pixel from the corner.
void draw_edge(cv::Mat& picture, const Region& region, double zoom, int thickness) {
  constexpr int shift = 4;
  const auto place = [&](const Point& p) {
    return cv::Point(static_cast<int>(std::lround(((p.x + 0.5) * zoom - 0.5) * (1 << shift))),
                     static_cast<int>(std::lround(((p.y + 0.5) * zoom - 0.5) * (1 << shift))));
  };
  for (const auto& s : region.edge)
    cv::line(picture, place(s.from), place(s.to), edge_colour, thickness, cv::LINE_AA, shift);
}

/// A step of 1, 2 or 5 times a power of ten, not above `most`.
double round_step(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= most) return digit * power;
  return power;
}

void draw_colour_bar(cv::Mat& canvas, const cv::Rect& place, double low, double high,
                     const std::string& unit, const std::optional<double>& level) {
  std::vector<float> ramp(256);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(255 - i);
  cv::Mat bar;
  cv::resize(coloured(ramp, 1, 0, 255, 1), bar, place.size(), 0, 0, cv::INTER_LINEAR);
  bar.copyTo(canvas(place));
  cv::rectangle(canvas, place, faint);
  const auto row = [&](double v) {
    return place.y + place.height - 1 -
           static_cast<int>(
               std::lround((v - low) / std::max(high - low, 1e-30) * (place.height - 1)));
  };
  const int right = place.x + place.width;
  if (high > low) {
    const double step = round_step((high - low) / 4);
    for (double v = std::ceil(low / step) * step; v <= high + 1e-9 * step; v += step) {
      cv::line(canvas, {right, row(v)}, {right + 5, row(v)}, ink);
      write(canvas, fmt::format("{:.6g}", std::abs(v) < 1e-9 * step ? 0.0 : v), right + 9,
            row(v) + 5, 0.45);
    }
  }
  write(canvas, unit, place.x, place.y - 8, 0.45);
  if (level && *level > low && *level < high)
    cv::line(canvas, {place.x - 6, row(*level)}, {right, row(*level)}, edge_colour, 2);
}

std::string encoded(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", picture, bytes))
    throw std::runtime_error("OpenCV could not encode a PNG picture.");
  return {bytes.begin(), bytes.end()};
}

std::string time_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.4g} ms", seconds * 1e3) : fmt::format("{:.4g} s", seconds);
}

/// What the picture says beneath the frame.
std::vector<std::string> caption(const Recording& recording, const Analysis& a) {
  const auto& h = recording.header();
  const auto& f = a.frames[a.shown];
  std::vector<std::string> lines;
  if (!h.synthetic.empty()) lines.push_back("SYNTHETIC recording: " + h.synthetic);
  std::string where =
      fmt::format("{}   frame {} of {}", h.path.filename().string(), f.index, h.frames);
  if (h.frame_rate > 0) where += "   t = " + time_text(f.time);
  lines.push_back(where);
  if (!a.found) {
    lines.push_back("No melt pool. " + a.reason);
    return lines;
  }
  const bool metric = a.unit == "m";
  const double scale = metric ? 1e6 : 1;
  const char* const unit = metric ? "um" : "px";
  lines.push_back(fmt::format("this frame: length {:.4g} {}, {} {:.4g} {}, area {:.4g} {}^2{}",
                              f.length * scale, unit, a.along_x ? "depth" : "extent across",
                              f.depth * scale, unit, f.area * scale * scale, unit,
                              f.complete             ? ""
                              : f.region.at_border() ? "  (touches the border)"
                                                     : "  (front not seen)"));
  if (a.length.n > 1)
    lines.push_back(fmt::format("all {} frames: length {:.4g} {}, standard deviation {:.3g} {}",
                                a.length.n, a.length.mean * scale, unit, a.length.deviation * scale,
                                unit));
  lines.push_back(fmt::format("level {:.6g} {}: {}", *a.level.value, h.unit, a.level.how));
  return lines;
}

}  // namespace

std::string annotated_picture(const Recording& recording, const Analysis& a,
                              const PixelSize& pixel) {
  const auto& h = recording.header();
  const auto frame = recording.frame(a.shown);
  const auto& f = a.frames[a.shown];
  const double largest = static_cast<double>(std::max(h.width, h.height));
  // Whole factors keep the pixels square-edged; a frame larger than the page is shrunk.
  const double zoom = largest <= 900 ? std::max(1.0, std::floor(900 / largest)) : 900 / largest;
  cv::Mat picture = coloured(frame.values, h.width, f.values.low, f.values.high, zoom);
  const auto region = pool_in(recording, a, frame);
  if (region) draw_edge(picture, *region, zoom, 2);

  constexpr int margin = 24, bar_width = 18, bar_room = 110, line_height = 22, top = 40;
  const int text_wide = std::max(picture.cols + bar_room, 560);
  std::vector<std::string> lines;
  for (const auto& line : caption(recording, a))
    for (const auto& part : wrapped(line, text_wide)) lines.push_back(part);
  const int text_top = top + picture.rows + 44;
  cv::Mat canvas(text_top + line_height * static_cast<int>(lines.size()) + margin / 2,
                 text_wide + 2 * margin, CV_8UC3, paper);
  picture.copyTo(canvas(cv::Rect(margin, top, picture.cols, picture.rows)));
  draw_colour_bar(canvas, {margin + picture.cols + 16, top, bar_width, picture.rows}, f.values.low,
                  f.values.high, h.unit, a.level.value);

  if (region) {  // onset and end as ticks outside the picture, with the length between them
    const Extent& e = a.along_x ? region->x : region->y;
    const auto at = [&](double p) {
      return (a.along_x ? margin : top) + static_cast<int>(std::lround((p + 0.5) * zoom));
    };
    const std::string label = a.unit == "m" ? fmt::format("{:.4g} um", f.length * 1e6)
                                            : fmt::format("{:.4g} px", f.length);
    if (a.along_x) {
      for (const double p : {e.low, e.high})
        cv::line(canvas, {at(p), top - 10}, {at(p), top - 1}, ink);
      cv::line(canvas, {at(e.low), top - 6}, {at(e.high), top - 6}, ink);
      write(canvas, label, (at(e.low) + at(e.high) - text_width(label)) / 2, top - 14);
    } else {
      for (const double p : {e.low, e.high})
        cv::line(canvas, {margin - 10, at(p)}, {margin - 1, at(p)}, ink);
      cv::line(canvas, {margin - 6, at(e.low)}, {margin - 6, at(e.high)}, ink);
      write(canvas, "length " + label, margin, top - 14);
    }
  }
  const double per_pixel = pixel.known() ? pixel.x * 1e6 : 1;
  const double step = round_step(0.3 * picture.cols / zoom * per_pixel);
  const int bar = static_cast<int>(std::lround(step / per_pixel * zoom)),
            y = top + picture.rows + 12;
  cv::line(canvas, {margin, y}, {margin + bar, y}, ink, 2);
  write(canvas, fmt::format("{:.6g} {}", step, pixel.known() ? "um" : "px"), margin + bar + 8,
        y + 5, 0.45);
  for (std::size_t i = 0; i < lines.size(); ++i)
    write(canvas, lines[i], margin, text_top + line_height * static_cast<int>(i));
  return encoded(canvas);
}

std::string contact_sheet(const Recording& recording, const Analysis& a) {
  const auto& h = recording.header();
  const std::size_t shown = std::min<std::size_t>(24, h.frames);
  const int columns =
      static_cast<int>(std::min<std::size_t>(h.width > 2 * h.height ? 3 : 6, shown));
  const int rows = (static_cast<int>(shown) + columns - 1) / columns;
  const double tile_width = 1080.0 / std::max(columns, 2),
               zoom = tile_width / static_cast<double>(h.width);
  const int tile_height = static_cast<int>(std::ceil(zoom * static_cast<double>(h.height)));
  double low = 1e300, high = -1e300;
  for (const auto& f : a.frames) {
    low = std::min(low, f.values.low);
    high = std::max(high, f.values.high);
  }
  constexpr int gap = 8, label = 18, head = 30;
  cv::Mat canvas(head + rows * (tile_height + label + gap) + gap,
                 gap + columns * (static_cast<int>(std::ceil(tile_width)) + gap), CV_8UC3, paper);
  write(canvas,
        fmt::format("{}{}: {} of {} frames, {:.6g} to {:.6g} {}",
                    h.synthetic.empty() ? "" : "SYNTHETIC ", h.path.filename().string(), shown,
                    h.frames, low, high, h.unit),
        gap, 20);
  Frame frame;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t index = shown > 1 ? i * (h.frames - 1) / (shown - 1) : 0;
    recording.read(index, frame);
    cv::Mat tile = coloured(frame.values, h.width, low, high, zoom);
    if (const auto region = pool_in(recording, a, frame)) draw_edge(tile, *region, zoom, 1);
    const int x =
        gap + static_cast<int>(i) % columns * (static_cast<int>(std::ceil(tile_width)) + gap);
    const int y = head + static_cast<int>(i) / columns * (tile_height + label + gap);
    tile.copyTo(canvas(cv::Rect(x, y, tile.cols, tile.rows)));
    write(canvas,
          h.frame_rate > 0 ? fmt::format("{}  {}", index, time_text(frame.time))
                           : fmt::format("{}", index),
          x, y + tile.rows + 14, 0.4);
  }
  return encoded(canvas);
}

FilmStrip film_strip(const Recording& recording, const Analysis& a, std::size_t most) {
  const auto& h = recording.header();
  std::size_t first = 0, last = h.frames - 1;
  if (a.found) {
    while (first < last && !a.frames[first].found) ++first;
    while (last > first && !a.frames[last].found) --last;
    first -= std::min<std::size_t>(first, 2);
    last = std::min(last + 2, h.frames - 1);
  }
  FilmStrip strip;
  const std::size_t step = (last - first) / most + 1;
  for (std::size_t i = first; i <= last; i += step) strip.frames.push_back(i);
  double low = 1e300, high = -1e300;
  for (const std::size_t i : strip.frames) {
    low = std::min(low, a.frames[i].values.low);
    high = std::max(high, a.frames[i].values.high);
  }
  const auto wide = static_cast<double>(std::max(h.width, h.height));
  const double zoom = wide <= 480 ? std::max(1.0, std::floor(480 / wide)) : 480 / wide;
  const int columns =
      std::max(420, static_cast<int>(std::ceil(zoom * static_cast<double>(h.width))));
  const int rows = static_cast<int>(std::ceil(zoom * static_cast<double>(h.height)));
  constexpr int label = 24;
  const int tile_height = rows + label;
  cv::Mat canvas(tile_height * static_cast<int>(strip.frames.size()), columns, CV_8UC3, paper);
  const double scale = a.unit == "m" ? 1e6 : 1;
  Frame frame;
  for (std::size_t k = 0; k < strip.frames.size(); ++k) {
    recording.read(strip.frames[k], frame);
    const FrameResult& f = a.frames[strip.frames[k]];
    cv::Mat tile = coloured(frame.values, h.width, low, high, zoom);
    if (const auto region = pool_in(recording, a, frame)) draw_edge(tile, *region, zoom, 1);
    const int top = static_cast<int>(k) * tile_height;
    tile.copyTo(canvas(cv::Rect(0, top, tile.cols, tile.rows)));
    std::string text = fmt::format("frame {}", f.index);
    if (h.frame_rate > 0) text += "  " + time_text(f.time);
    if (f.found)
      text += fmt::format("  length {:.4g} {}{}", f.length * scale, a.unit == "m" ? "um" : "px",
                          f.complete ? "" : "  (not used)");
    if (!h.synthetic.empty()) text += "  SYNTHETIC";
    write(canvas, text, 4, top + rows + 16, 0.42);
  }
  strip.png = encoded(canvas);
  return strip;
}

}  // namespace meltproof::imaging
