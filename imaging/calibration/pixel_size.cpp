// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/calibration/pixel_size.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/error.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

/// What the two models leave of a noise-free image of ideal lines, relative: the bound that the
/// tests hold them to.
constexpr double model_uncertainty = 2e-5;
/// Certified scales are a hundred times better; more than this is no scale, or not only a scale.
constexpr double most_inequality = 0.03;
constexpr double degree = std::numbers::pi / 180;

/// Relative uncertainty of a length anywhere in an image whose period changes by `drift` across it;
/// none is claimed for a drift that noise explains.
double drift_uncertainty(const StripeFit& fit) {
  return std::abs(fit.drift) > 2 * fit.drift_uncertainty
             ? std::abs(fit.drift) / (2 * std::sqrt(3.0))
             : 0.0;
}

double total(const std::vector<BudgetEntry>& budget, double BudgetEntry::*axis) {
  double sum = 0;
  for (const auto& entry : budget) sum += entry.*axis * (entry.*axis);
  return std::sqrt(sum);
}

}  // namespace

bool ScaleImage::across_x() const {
  return std::abs(stripes.frequency.value.x()) >= std::abs(stripes.frequency.value.y());
}

double ScaleImage::angle() const {
  const auto& f = stripes.frequency.value;
  return across_x() ? std::atan2(f.y(), f.x()) : -std::atan2(f.x(), f.y());
}

double relative_uncertainty(const Frequency& f) {
  const Eigen::Vector2d direction = f.value.normalized();
  return std::sqrt(direction.dot(f.covariance * direction)) / f.value.norm();
}

ScaleImage measure_scale(const cv::Mat& image, const std::string& name) {
  ScaleImage out;
  out.name = name;
  out.image = image;
  out.coarse = coarse_frequency(flatten(image));
  out.stripes = fit_stripes(image, out.coarse);
  out.edges = fit_edges(image, out.coarse);
  const double first = 1 / out.stripes.frequency.value.norm();
  const double second = 1 / out.edges.frequency.value.norm();
  const double u = std::hypot(relative_uncertainty(out.stripes.frequency),
                              relative_uncertainty(out.edges.frequency), model_uncertainty);
  out.disagreement = std::abs(second / first - 1) / u;
  if (!(out.disagreement <= 3))
    throw InputError(fmt::format(
        "{}: the period of the stripes is {:.4f} px by least squares and {:.4f} px by their edges, "
        "{:.1f} "
        "standard uncertainties apart; expected at most 3. The lines are not equal and parallel in "
        "this image (dust, distortion, reflections or motion); take another image or crop it.",
        name, first, second, out.disagreement));
  const double inequality = out.edges.inequality / second;
  if (!(inequality <= most_inequality))
    throw InputError(
        fmt::format("{}: the lines lie {:.1f} % of a period (rms) off equal distances; expected at "
                    "most {:.0f} %. Dust, "
                    "motion or distortion; take another image or crop it.",
                    name, 100 * inequality, 100 * most_inequality));
  return out;
}

ScaleImage measure_scale(const std::filesystem::path& path) {
  const Recording recording = open_recording(path);
  const auto& header = recording.header();
  const cv::Size extent(static_cast<int>(header.width), static_cast<int>(header.height));
  cv::Mat mean(extent, CV_64F, cv::Scalar(0)), count = mean.clone();
  auto* const sum_of = mean.ptr<double>();
  auto* const count_of = count.ptr<double>();
  Frame frame;
  for (std::size_t index = 0; index < header.frames; ++index) {
    recording.read(index, frame);
    for (std::size_t i = 0; i < frame.values.size(); ++i)
      if (frame.status[i] == PixelStatus::good)
        sum_of[i] += double{frame.values[i]}, count_of[i] += 1;
  }
  // 0/0 becomes NaN: a pixel that was never good is known to be missing.
  for (std::size_t i = 0; i < mean.total(); ++i) sum_of[i] /= count_of[i];
  ScaleImage out;
  try {
    out = measure_scale(mean, path.string());
  } catch (const NoStripes& error) {
    throw NoStripes(path.string() + ": " + error.what());
  }
  out.sha256 = header.sha256;
  out.synthetic = header.synthetic;
  out.frames = static_cast<int>(header.frames);
  return out;
}

CalibratedPixel pixel_size(const std::vector<ScaleImage>& images, const Graduation& graduation) {
  if (images.empty() || images.size() > 2)
    throw InputError(
        fmt::format("A calibration takes one image of the scale, or two, one per axis; "
                    "found {}.",
                    images.size()));
  if (!(graduation.length > 0) || !(graduation.uncertainty >= 0))
    throw InputError(
        "The graduation of the scale must be a positive length and its uncertainty not "
        "negative.");
  if (images.size() == 2 && images[0].across_x() == images[1].across_x())
    throw InputError(
        fmt::format("{} and {} both show lines across the {} axis of the image; turn the "
                    "scale by 90 degrees for one of them.",
                    images[0].name, images[1].name, images[0].across_x() ? "x" : "y"));
  for (const auto& image : images) {
    const double duty = image.edges.line_width;
    if (graduation.line_width && std::abs(duty - 0.5) > 0.1)
      throw InputError(
          fmt::format("{}: a line takes {:.2f} of a period, so lines and gaps differ and the line "
                      "width does not "
                      "give the period; state the period of the scale with --graduation-is period.",
                      image.name, duty));
  }

  CalibratedPixel size;
  const double period = graduation.period();
  double fit_x = 0, fit_y = 0;
  if (images.size() == 1) {
    const auto& f = images[0].stripes.frequency;
    size.x = size.y = period * f.value.norm();
    fit_x = fit_y = relative_uncertainty(f);
    (images[0].across_x() ? size.x_measured : size.y_measured) = true;
  } else {
    // Linear in v = (1/px^2, 1/py^2): M v = 1/period^2 with M the squared frequencies.
    Eigen::Matrix2d m;
    Eigen::Vector2d variance;
    for (int i = 0; i < 2; ++i)
      m.row(i) =
          images[static_cast<std::size_t>(i)].stripes.frequency.value.cwiseAbs2().transpose();
    const Eigen::Matrix2d inverse = m.inverse();
    const Eigen::Vector2d v = inverse * Eigen::Vector2d::Constant(1 / (period * period));
    if (!(v.minCoeff() > 0))
      throw InputError(
          "The two images of the scale do not describe one camera: their frequencies give "
          "no pixel size. Check that both were taken with the same optics.");
    for (int i = 0; i < 2; ++i) {
      const auto& f = images[static_cast<std::size_t>(i)].stripes.frequency;
      const Eigen::Vector2d gradient = 2 * f.value.cwiseProduct(v);
      variance(i) = gradient.dot(f.covariance * gradient);
    }
    const Eigen::Matrix2d covariance = inverse * variance.asDiagonal() * inverse.transpose();
    size.x = 1 / std::sqrt(v(0));
    size.y = 1 / std::sqrt(v(1));
    fit_x = 0.5 * std::sqrt(covariance(0, 0)) / v(0);
    fit_y = 0.5 * std::sqrt(covariance(1, 1)) / v(1);
    size.x_measured = size.y_measured = true;
  }
  const auto per_axis = [&](const std::string& source, const auto& relative) {
    BudgetEntry entry{source, relative(images.front()), relative(images.front())};
    if (images.size() == 2) (images[1].across_x() ? entry.x : entry.y) = relative(images[1]);
    return entry;
  };
  const double certificate = graduation.uncertainty / graduation.length;
  size.budget = {
      {"fit of the stripes (noise)", fit_x, fit_y},
      {"model of the stripes", model_uncertainty, model_uncertainty},
      per_axis("drift of the period over the image (tilt)",
               [](const ScaleImage& image) { return drift_uncertainty(image.stripes); }),
      per_axis("unequal distances of the lines",
               [](const ScaleImage& image) { return image.edges.inequality_uncertainty; }),
      {"certificate of the scale", certificate, certificate}};
  size.u_x = size.x * total(size.budget, &BudgetEntry::x);
  size.u_y = size.y * total(size.budget, &BudgetEntry::y);
  return size;
}

nlohmann::json calibration_json(const CalibratedPixel& size, const std::vector<ScaleImage>& images,
                                const Graduation& graduation) {
  using nlohmann::json;
  json out;
  out["pixel_size_x_um"] = size.x * 1e6;
  out["pixel_size_y_um"] = size.y * 1e6;
  out["u_pixel_size_x_um"] = size.u_x * 1e6;
  out["u_pixel_size_y_um"] = size.u_y * 1e6;
  out["x_is"] = "image columns";
  out["y_is"] = "image rows";
  out["ratio_y_to_x"] = size.y / size.x;
  out["angle_deg"] = images.at(0).angle() / degree;
  out["axes_measured"] = json::array();
  if (size.x_measured) out["axes_measured"].push_back("x");
  if (size.y_measured) out["axes_measured"].push_back("y");
  out["assumption"] = size.x_measured && size.y_measured
                          ? ""
                          : "square pixels: only one axis was measured, and an oblique view would "
                            "not be noticed";
  out["graduation"] = {{"length_um", graduation.length * 1e6},
                       {"u_length_um", graduation.uncertainty * 1e6},
                       {"is", graduation.line_width ? "line-width" : "period"},
                       {"period_um", graduation.period() * 1e6}};
  if (graduation.uncertainty == 0)
    out["graduation"]["note"] = "no uncertainty of the scale was given, so none is included";
  out["budget"] = json::array();
  for (const auto& entry : size.budget)
    out["budget"].push_back(
        {{"source", entry.source}, {"relative_x", entry.x}, {"relative_y", entry.y}});
  bool synthetic = false;
  out["images"] = json::array();
  for (const auto& image : images) {
    const auto& stripes = image.stripes;
    const auto& edges = image.edges;
    const double period = 1 / stripes.frequency.value.norm();
    const double edge_period = 1 / edges.frequency.value.norm();
    synthetic = synthetic || !image.synthetic.empty();
    out["images"].push_back(
        {{"path", image.name},
         {"sha256", image.sha256},
         {"synthetic", image.synthetic},
         {"width", image.image.cols},
         {"height", image.image.rows},
         {"frames_averaged", image.frames},
         {"axis", image.across_x() ? "x" : "y"},
         {"angle_deg", image.angle() / degree},
         {"coarse_period_px", 1 / image.coarse.norm()},
         {"period_px", period},
         {"u_period_px", period * relative_uncertainty(stripes.frequency)},
         {"edge_period_px", edge_period},
         {"u_edge_period_px", edge_period * relative_uncertainty(edges.frequency)},
         {"disagreement_sigma", image.disagreement},
         {"drift", stripes.drift},
         {"u_drift", stripes.drift_uncertainty},
         {"harmonics", stripes.harmonics},
         {"amplitude", stripes.amplitude},
         {"residual", stripes.residual},
         {"residual_correlation", stripes.correlation},
         {"excluded_pixels", stripes.excluded},
         {"line_width_periods", edges.line_width},
         {"edge_blur_px", edges.blur},
         {"u_edge_blur_px", edges.u_blur},
         {"edge_residual_px", edges.residual},
         {"inequality_px", edges.inequality},
         {"line_positions", edges.lines.size()}});
  }
  out["synthetic"] = synthetic;
  return out;
}

}  // namespace meltproof::imaging
