// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-calibrate: images of a glass scale to the size of a pixel on the object.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "base/units.hpp"
#include "imaging/calibration/picture.hpp"
#include "imaging/calibration/pixel_size.hpp"

namespace {

using namespace meltproof;

constexpr const char* about =
    "Measures the pixel size from images of a scale with equal, parallel lines: one image, or two, "
    "one "
    "across each axis. Any format of meltproof-thermography is read (TIFF, PNG, BMP, HDF5, PTW, "
    "SEQ, ...); "
    "all frames of a file are averaged. Writes a calibration (JSON) and beside it a picture of the "
    "fit "
    "(PNG).\n"
    "Example:\n"
    "  meltproof-calibrate data/scales/synthetic_across_x.h5 data/scales/synthetic_across_y.h5 \\\n"
    "    --graduation \"100 um\" --graduation-is period --output calibration.json";

double length(const std::string& option, const std::string& text) {
  try {
    // By way of micrometres, so that "100 um" is not 99.99999999999999 um in the result.
    return parse_quantity(text, "um") / 1e6;
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> paths;
  std::string graduation_text, kind, uncertainty_text, output = "calibration.json";
  Program program("meltproof-calibrate", about);
  program.app.add_option("image", paths, "Image of the scale; a second one across the other axis");
  program.app.add_option(
      "--graduation", graduation_text,
      "Graduation of the scale with its unit, for example \"100 um\" (required)");
  program.app.add_option(
      "--graduation-is", kind,
      "What the graduation means (required): \"period\", from one line to the next, or "
      "\"line-width\", the width of a line and of a gap, half a period");
  program.app.add_option("--graduation-uncertainty", uncertainty_text,
                         "Standard uncertainty of the graduation from the scale's certificate, for "
                         "example \"0.05 um\"; without it none is included");
  program.app
      .add_option("--output", output,
                  "Calibration to write; the picture gets the same name "
                  "with .png")
      ->capture_default_str();
  return program.run(argc, argv, [&] {
    Provenance provenance = begin_provenance(argc, argv);
    if (paths.empty())
      throw InputError("No image of the scale was named; see --help for an example.");
    if (graduation_text.empty())
      throw InputError(
          "--graduation is missing: state the graduation of the scale with its unit, for "
          "example --graduation \"100 um\".");
    if (kind != "period" && kind != "line-width")
      throw InputError(
          (kind.empty() ? std::string("--graduation-is is missing")
                        : "--graduation-is is \"" + kind + "\"") +
          ": state whether the graduation is the \"period\" from one line to the next or the "
          "\"line-width\" of a line and of a gap; the pixel size differs by a factor of 2.");
    imaging::Graduation graduation;
    graduation.length = length("--graduation", graduation_text);
    graduation.line_width = kind == "line-width";
    if (!uncertainty_text.empty())
      graduation.uncertainty = length("--graduation-uncertainty", uncertainty_text);

    std::vector<imaging::ScaleImage> images;
    try {
      for (const auto& path : paths) {
        images.push_back(imaging::measure_scale(std::filesystem::path(path)));
        provenance.inputs.push_back({path, images.back().sha256});
      }
    } catch (const imaging::NoStripes& nothing) {
      fmt::print(stderr, "meltproof-calibrate: {}\n", nothing.what());
      return ExitStatus::no_result;
    }
    const imaging::CalibratedPixel size = imaging::pixel_size(images, graduation);

    nlohmann::json json = imaging::calibration_json(size, images, graduation);
    provenance.wall_time = provenance.elapsed();
    json["provenance"] = provenance.json();
    const auto picture_path = std::filesystem::path(output).replace_extension(".png");
    AtomicFile picture(picture_path);
    if (!cv::imwrite(picture.temporary().string(), imaging::fit_picture(images, size)))
      throw std::runtime_error("The picture " + picture_path.string() + " could not be written.");
    write_file(output, json.dump(2) + "\n");
    picture.commit();
    if (!program.quiet()) {
      const auto line = [](const char* axis, double p, double u, bool measured) {
        fmt::print("pixel size {}: {:.4f} um, standard uncertainty {:.4f} um{}\n", axis, p * 1e6,
                   u * 1e6, measured ? "" : " (square pixels assumed)");
      };
      line("x", size.x, size.u_x, size.x_measured);
      line("y", size.y, size.u_y, size.y_measured);
      fmt::print("{}\n{}\n", output, picture_path.string());
    }
    return ExitStatus::success;
  });
}
