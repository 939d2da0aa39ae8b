// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/stack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <gsl/gsl_sf_bessel.h>
#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {
namespace {

constexpr std::size_t most_frames = 400, fewest_frames = 12, fewest_values = 3;
constexpr double ahead = 8;  // px kept before the leading edge: the cold plate
constexpr auto nothing = std::numeric_limits<float>::quiet_NaN();

/// Leading edge in pixels counted along the scan.
double onset_of(const FrameResult& f, const RecordingHeader& h, ScanDirection direction) {
  switch (direction) {
    case ScanDirection::right:
      return f.region.x.high;
    case ScanDirection::left:
      return static_cast<double>(h.width) - 1 - f.region.x.low;
    case ScanDirection::down:
      return f.region.y.high;
    case ScanDirection::up:
      break;
  }
  return static_cast<double>(h.height) - 1 - f.region.y.low;
}

/// Mean of the values near their median, and its standard error.
std::pair<float, float> clipped_mean(std::vector<double>& values) {
  if (values.size() < fewest_values) return {nothing, nothing};
  const double middle = median(values);
  std::vector<double> deviations;
  for (const double v : values) deviations.push_back(std::abs(v - middle));
  const double limit = 3 * 1.4826 * median(deviations) + 1e-12 * std::abs(middle);
  double sum = 0, squares = 0, n = 0;
  for (const double v : values) {
    if (std::abs(v - middle) > limit) continue;
    sum += v - middle;
    squares += (v - middle) * (v - middle);
    n += 1;
  }
  const double variance = n > 1 ? std::max(0.0, squares - sum * sum / n) / (n - 1) : 0;
  return {static_cast<float>(middle + sum / n), static_cast<float>(std::sqrt(variance / n))};
}

/// Pixel number of the scan's own coordinates: along it towards higher numbers, line by line.
std::size_t pixel_at(const RecordingHeader& h, ScanDirection d, std::size_t along,
                     std::size_t line) {
  const bool along_x = d == ScanDirection::right || d == ScanDirection::left;
  const std::size_t n = along_x ? h.width : h.height;
  const bool forward = d == ScanDirection::right || d == ScanDirection::down;
  const std::size_t i = forward ? along : n - 1 - along;
  return along_x ? line * h.width + i : i * h.width + line;
}

}  // namespace

StackResult stack_frames(const Recording& recording, const Analysis& analysis,
                         ScanDirection direction) {
  const auto& h = recording.header();
  std::vector<double> number, onset, length;
  for (const auto& f : analysis.frames) {
    if (!f.complete) continue;
    number.push_back(static_cast<double>(f.index));
    onset.push_back(onset_of(f, h, direction));
    length.push_back(analysis.along_x ? f.region.x.size() : f.region.y.size());
  }
  if (number.size() < fewest_frames)
    return {{},
            fmt::format("{} frames show the whole pool, where {} are needed to average it in "
                        "its own frame",
                        number.size(), fewest_frames)};
  // Frames next to each other, from the middle on: a stack over a long recording would smear.
  if (number.size() > most_frames) {
    const auto first = static_cast<std::ptrdiff_t>((number.size() - most_frames) / 2);
    for (auto* v : {&number, &onset, &length})
      *v = {v->begin() + first, v->begin() + first + static_cast<std::ptrdiff_t>(most_frames)};
  }
  const RobustLine line = robust_line(number, onset);
  if (!(std::abs(line.slope) >= 0.05) || std::abs(line.slope) > 0.5 * median(length))
    return {{},
            fmt::format("the pool moves by {:.3g} px a frame, where between 0.05 px and half "
                        "its length are needed to average it in its own frame",
                        line.slope)};
  if (line.slope < 0)
    return {{}, "the pool moves against the scan direction; give the other --scan-direction"};
  if (line.deviation > 0.5)
    return {{},
            fmt::format("the leading edge leaves its straight line by {:.2g} px, so that an "
                        "average would smear the pool",
                        line.deviation)};

  Stack stack;
  const bool along_x = analysis.along_x;
  const std::size_t n = along_x ? h.width : h.height;
  stack.lines = along_x ? h.height : h.width;
  stack.speed = line.slope;
  stack.residual = line.deviation;
  stack.onset = static_cast<double>(n);
  stack.columns = Stack::samples * (n + static_cast<std::size_t>(ahead));
  std::vector<std::vector<double>> values(stack.lines * stack.columns);
  Frame frame;
  const double tolerance = std::max(4 * line.deviation, 0.2);
  for (std::size_t k = 0; k < number.size(); ++k) {
    const double front = line.intercept + line.slope * number[k];
    if (std::abs(onset[k] - front) > tolerance) continue;
    const auto index = static_cast<std::size_t>(number[k]);
    recording.read(index, frame);
    stack.used.push_back(index);
    for (std::size_t i = 0; i < n; ++i) {
      const double place = static_cast<double>(i) - front + stack.onset;
      const double column = std::round(place * static_cast<double>(Stack::samples));
      if (column < 0 || column >= static_cast<double>(stack.columns)) continue;
      for (std::size_t l = 0; l < stack.lines; ++l) {
        const std::size_t p = pixel_at(h, direction, i, l);
        if (frame.status[p] == PixelStatus::dead) continue;
        values[l * stack.columns + static_cast<std::size_t>(column)].push_back(
            static_cast<double>(frame.values[p]));
      }
    }
  }
  stack.frames = stack.used.size();
  if (stack.frames < fewest_frames)
    return {{},
            fmt::format("{} frames have their leading edge on its straight line, where {} are "
                        "needed",
                        stack.frames, fewest_frames)};
  stack.signal.resize(values.size());
  stack.deviation.resize(values.size());
  std::vector<double> single;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto count = static_cast<double>(values[i].size());
    std::tie(stack.signal[i], stack.deviation[i]) = clipped_mean(values[i]);
    // One pixel's noise, from the tail, where the signal is smooth over a quarter of a pixel.
    const double level = analysis.level.value.value_or(0);
    const auto s = static_cast<double>(stack.signal[i]);
    const double behind = stack.onset - static_cast<double>(i % stack.columns) / Stack::samples;
    if (behind > 4 && s > 0.3 * level && s < 2 * level)
      single.push_back(static_cast<double>(stack.deviation[i]) * std::sqrt(count));
  }
  stack.noise = single.empty() ? 0 : median(single);
  return {std::move(stack), {}};
}

namespace {

/// The discrete analogue of a Gaussian (Lindeberg 1990, T(n, t) = exp(-t) I_n(t)). Its variance is
/// exactly sigma^2; that of a Gaussian sampled a line apart falls to nothing where sigma is less
/// than half a line.
cv::Mat between_lines(double sigma) {
  const int reach = sigma > 0 ? static_cast<int>(std::ceil(4 * sigma)) + 2 : 0;
  cv::Mat kernel(2 * reach + 1, 1, CV_64F);
  double sum = 0;
  for (int n = -reach; n <= reach; ++n)
    sum += kernel.at<double>(n + reach) = gsl_sf_bessel_In_scaled(n, sigma * sigma);
  kernel /= sum;
  return kernel;
}

}  // namespace

std::vector<float> smoothed(const Stack& stack, double along, double across) {
  std::vector<float> image = stack.signal;
  for (std::size_t l = 0; l < stack.lines; ++l) {
    float* const line = image.data() + l * stack.columns;
    std::ptrdiff_t last = -1;
    for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(stack.columns); ++i) {
      if (std::isnan(line[i])) continue;
      for (std::ptrdiff_t k = last + 1; k < i; ++k) {
        const float t = last < 0 ? 1 : static_cast<float>(k - last) / static_cast<float>(i - last);
        line[k] = last < 0 ? line[i] : (1 - t) * line[last] + t * line[i];
      }
      last = i;
    }
    for (std::ptrdiff_t k = last + 1; last >= 0 && k < static_cast<std::ptrdiff_t>(stack.columns);
         ++k)
      line[k] = line[last];
  }
  if (along > 0 || across > 0) {
    cv::Mat mat(static_cast<int>(stack.lines), static_cast<int>(stack.columns), CV_32F,
                image.data());
    const auto kernel = [](double sigma) {
      if (!(sigma > 0)) return cv::Mat(cv::Mat::ones(1, 1, CV_64F));
      return cv::getGaussianKernel(2 * static_cast<int>(std::ceil(4 * sigma)) + 1, sigma, CV_64F);
    };
    cv::sepFilter2D(mat, mat, -1, kernel(along * Stack::samples), between_lines(across), {-1, -1},
                    0, cv::BORDER_REPLICATE);
  }
  return image;
}

std::optional<StackedPool> measure_stack(const Stack& stack, const Level& level, double along,
                                         double across) {
  const std::vector<float> image = smoothed(stack, along, across);
  if (!level.step) {
    // On the fine columns themselves: less is left to interpolation along the scan.
    RegionFinder finder(stack.columns, stack.lines, level.interpolation);
    const auto region = finder.largest(image, *level.value);
    if (!region || region->pixels < smallest_pool * Stack::samples) return std::nullopt;
    const double fine = 1.0 / Stack::samples;
    return StackedPool{fine * region->x.high, fine * region->x.low, fine * region->x.size(),
                       region->y.size()};
  }
  const std::size_t width = stack.columns / Stack::samples;
  RegionFinder finder(width, stack.lines, level.interpolation);
  std::vector<float> part(width * stack.lines), marked;
  StackedPool mean;
  for (std::size_t k = 0; k < Stack::samples; ++k) {
    for (std::size_t l = 0; l < stack.lines; ++l)
      for (std::size_t i = 0; i < width; ++i)
        part[l * width + i] = image[l * stack.columns + i * Stack::samples + k];
    if (level.step) {
      mark_fronts(part, width, stack.lines, true, *level.step, marked);
      part.swap(marked);
    }
    const auto region = finder.largest(part, *level.value);
    if (!region || region->pixels < smallest_pool) return std::nullopt;
    const double weight = 1.0 / Stack::samples, offset = static_cast<double>(k) / Stack::samples;
    mean.onset += weight * (region->x.high + offset);
    mean.end += weight * (region->x.low + offset);
    mean.length += weight * region->x.size();
    mean.depth += weight * region->y.size();
  }
  return mean;
}

}  // namespace meltproof::imaging
