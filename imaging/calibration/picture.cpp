// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/calibration/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace meltproof::imaging {
namespace {

const cv::Scalar ink(40, 40, 40), paper(255, 255, 255), green(90, 160, 30), red(60, 40, 215),
    grey(190, 190, 190);
constexpr int plot_width = 420, margin = 24, caption = 46;

void write(cv::Mat& canvas, const std::string& text, cv::Point at) {
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, ink, 1, cv::LINE_AA);
}

/// Middle of the line nearest to a phase of zero, in periods: where the model's stripes are
/// highest. Lines can be darker than their gaps; the edges then count the gaps, and so does this.
double middle_phase(const ScaleImage& image) {
  double best = 0, phase = 0;
  const auto& f = image.stripes.frequency.value;
  const double x0 = 0.5 * (image.image.cols - 1), y0 = 0.5 * (image.image.rows - 1);
  for (int i = 0; i < 360; ++i) {
    const double p = i / 360.0;
    const cv::Point2d at =
        image.across_x() ? cv::Point2d(x0 + p / f.x(), y0) : cv::Point2d(x0, y0 + p / f.y());
    const double value = image.stripes.model(at.x, at.y, image.image.size(), true);
    if (i == 0 || value > best) best = value, phase = p;
  }
  return phase;
}

cv::Mat enlarged(const ScaleImage& image, int factor) {
  double low = 0, high = 0;
  cv::Mat known = image.image == image.image;  // false where NaN
  cv::minMaxLoc(image.image, &low, &high, nullptr, nullptr, known);
  cv::Mat grey_levels, large, out;
  cv::Mat filled = image.image.clone();
  filled.setTo(low, ~known);
  filled.convertTo(grey_levels, CV_8U, 255 / std::max(high - low, 1e-300),
                   -255 * low / std::max(high - low, 1e-300));
  cv::resize(grey_levels, large, {}, factor, factor, cv::INTER_NEAREST);
  cv::cvtColor(large, out, cv::COLOR_GRAY2BGR);
  const auto place = [&](double column, double row) {
    return cv::Point2d((column + 0.5) * factor, (row + 0.5) * factor);
  };
  const auto& f = image.stripes.frequency.value;
  const double x0 = 0.5 * (image.image.cols - 1), y0 = 0.5 * (image.image.rows - 1);
  const double middle = middle_phase(image);
  const double reach = std::abs(f.x()) * x0 + std::abs(f.y()) * y0;
  for (double k = std::floor(-reach); k <= std::ceil(reach); ++k) {
    const double p = k + middle;
    const auto crossing = [&](double along) {  // where the line crosses a border
      return image.across_x() ? place(x0 + (p - f.y() * along) / f.x(), y0 + along)
                              : place(x0 + along, y0 + (p - f.x() * along) / f.y());
    };
    const double end = image.across_x() ? y0 + 0.5 : x0 + 0.5;
    cv::line(out, crossing(-end), crossing(end), green, 1, cv::LINE_AA);
  }
  for (const auto& line : image.edges.lines)
    cv::circle(out, place(line.column, line.row), 2, red, cv::FILLED, cv::LINE_AA);
  return out;
}

cv::Mat folded_plot(const ScaleImage& image, int height) {
  cv::Mat out(height, plot_width, CV_8UC3, paper);
  const auto& fit = image.stripes;
  const auto& f = fit.frequency.value;
  const cv::Size extent = image.image.size();
  const double top = 1.6 * fit.amplitude;
  const auto place = [&](double phase, double value) {
    return cv::Point(
        static_cast<int>(phase * plot_width),
        static_cast<int>((0.5 - 0.5 * std::clamp(value / top, -1.0, 1.0)) * (height - 1)));
  };
  for (int row = 0; row < extent.height; ++row)
    for (int column = 0; column < extent.width; ++column) {
      const double value = image.image.at<double>(row, column);
      if (!std::isfinite(value)) continue;
      const double p =
          f.x() * (column - 0.5 * (extent.width - 1)) + f.y() * (row - 0.5 * (extent.height - 1));
      const double flat = fit.model(column, row, extent, true);
      const double left = value - fit.model(column, row, extent) + flat;
      cv::circle(out, place(p - std::floor(p), left), 1, grey, cv::FILLED);
    }
  cv::Point last;
  for (int i = 0; i <= plot_width; ++i) {
    double value = 0;
    const double phase = static_cast<double>(i) / plot_width;
    for (std::size_t k = 0; k < fit.harmonics.size(); ++k) {
      const double angle = 2 * std::numbers::pi * fit.harmonics[k] * phase;
      const auto at = background_terms + 2 * static_cast<Eigen::Index>(k);
      value += fit.coefficients(at) * std::cos(angle) + fit.coefficients(at + 1) * std::sin(angle);
    }
    const cv::Point next = place(phase, value);
    if (i > 0) cv::line(out, last, next, green, 2, cv::LINE_AA);
    last = next;
  }
  cv::rectangle(out, {0, 0}, {plot_width - 1, height - 1}, ink);
  return out;
}

}  // namespace

cv::Mat fit_picture(const std::vector<ScaleImage>& images, const CalibratedPixel& size) {
  cv::Mat canvas;
  for (const auto& image : images) {
    const int factor = std::clamp(900 / image.image.cols, 1, 9);
    const cv::Mat left = enlarged(image, factor);
    const cv::Mat right = folded_plot(image, std::max(left.rows, 200));
    const int height = std::max(left.rows, right.rows);
    cv::Mat block(height + caption + margin, left.cols + plot_width + 3 * margin, CV_8UC3, paper);
    left.copyTo(block(cv::Rect({margin, caption}, left.size())));
    right.copyTo(block(cv::Rect({left.cols + 2 * margin, caption}, right.size())));
    const bool x = image.across_x();
    write(block,
          fmt::format("{} axis: {:.4f} +- {:.4f} um/px{}", x ? "x" : "y",
                      1e6 * (x ? size.x : size.y), 1e6 * (x ? size.u_x : size.u_y),
                      image.synthetic.empty() ? "" : "   SYNTHETIC IMAGE, no measurement"),
          {margin, 18});
    write(
        block,
        fmt::format(
            "green: middles of the lines by least squares, period {:.4f} px; red: by their edges, "
            "{:.4f} px",
            1 / image.stripes.frequency.value.norm(), 1 / image.edges.frequency.value.norm()),
        {margin, 36});
    write(block, "signal over one period: pixels, model", {left.cols + 2 * margin, 36});
    if (canvas.empty()) {
      canvas = block;
    } else {
      const int width = std::max(canvas.cols, block.cols);
      cv::copyMakeBorder(canvas, canvas, 0, 0, 0, width - canvas.cols, cv::BORDER_CONSTANT, paper);
      cv::copyMakeBorder(block, block, 0, 0, 0, width - block.cols, cv::BORDER_CONSTANT, paper);
      cv::vconcat(canvas, block, canvas);
    }
  }
  return canvas;
}

}  // namespace meltproof::imaging
