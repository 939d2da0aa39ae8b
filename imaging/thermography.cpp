// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-thermography: from an infrared recording to the melt pool's dimensions.
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core/version.hpp>

#include "base/atomic_file.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "imaging/meltpool/pictures.hpp"
#include "imaging/meltpool/report.hpp"
#include "imaging/meltpool/report_parameters.hpp"
#include "imaging/meltpool/settings.hpp"
#include "imaging/recording/formats.hpp"

using namespace meltproof;
using namespace meltproof::imaging;

namespace {

/// Options of the command line that are keys of the settings too.
const std::vector<std::pair<std::string, std::string>> shared_options = {
    {"calibration", "calibration.json of meltproof-calibrate, for lengths in um"},
    {"level", "signal in counts at which the pool ends"},
    {"reference-temperature", "temperature at which the pool ends, as \"1683 K\""},
    {"freezing-heat",
     "heat of freezing over specific heat times liquidus, 0.19 to 0.23 for 316L; narrows the "
     "length "
     "that the recording itself shows ([reference] freezing_heat)"},
    {"emissivity", "emissivity of solid metal in the camera's band"},
    {"emissivity-liquid", "emissivity of liquid metal, where it is less"},
    {"transmission", "transmission of the windows, as 0.313 or \"31.3 %\""},
    {"frame-rate", "frames per second, as \"9762.5 Hz\", for files that hold none"},
    {"kelvin-per-count", "as \"0.04 K\", for exports with a linear temperature scale"},
    {"scan-speed", "speed of the beam, as \"0.375 m/s\", to check the measured one"},
    {"reference-signal", "look for the phase boundary in the recording: auto, find or off"},
    {"dark", "counts without light, for files that do not hold it"},
    {"scan-direction", "where the beam goes in the image: +x, -x, +y, -y"}};

/// The key of the settings that an option stands for.
std::string key_of(std::string option) {
  std::replace(option.begin(), option.end(), '-', '_');
  return option == "freezing_heat" ? "reference." + option : option;
}

/// The settings file, where there is one, with what was typed in front of it.
void read_settings(Input& input, const std::string& path,
                   const std::map<std::string, std::string>& given) {
  std::vector<std::string> overrides;
  std::string text;
  for (const auto& [name, value] : given) {
    if (value.empty()) continue;
    const std::string key = key_of(name);
    overrides.push_back(key + "=" + value);
    const bool bare = value.find_first_not_of("0123456789.eE+-") == std::string::npos &&
                      value.find_first_of("0123456789") != std::string::npos;
    text += key + " = " + (bare ? value : "'" + value + "'") + "\n";
  }
  if (path.empty())
    input.read_text(text, "command line");
  else
    input.read(path, overrides);
}

/// Writes every file under a temporary name first, so that a full disk leaves nothing half-written.
void write_all(const std::filesystem::path& folder,
               const std::map<std::string, std::string>& files) {
  std::vector<std::unique_ptr<AtomicFile>> written;
  for (const auto& [name, content] : files) {
    written.push_back(std::make_unique<AtomicFile>(folder / name));
    write_file(written.back()->temporary(), content);
  }
  for (const auto& file : written) file->commit();
}

}  // namespace

int main(int argc, char** argv) {
  Program program(
      "meltproof-thermography",
      "Reads an infrared recording and measures the melt pool in it. It reads PTW, SEQ, FFF, "
      "CSQ,\nradiometric JPEG, SFMOV with its .inc, IRB, TIFF, BMP, PNG, HDF5, MATLAB, "
      "CSV, and folders\nof one file a frame.\n"
      "Example: meltproof-thermography track.ptw --output results --level 8000");
  std::string recording_path, output, settings_path;
  program.app.add_option("recording", recording_path, "the camera's file, or a folder of frames")
      ->required();
  program.app
      .add_option("-o,--output", output, "folder for summary.json, frames.csv and the pictures")
      ->required();
  program.app.add_option("--settings", settings_path,
                         "TOML file with the same keys as the options below");
  bool film = false;
  program.app.add_flag("--film", film,
                       "write film.png as well, annotated frames one below the other");
  std::map<std::string, std::string> given;
  for (const auto& [name, about] : shared_options)
    program.app.add_option("--" + name, given[name], about);

  return program.run(argc, argv, [&] {
    Provenance provenance = begin_provenance(argc, argv);
    provenance.libraries["OpenCV"] = CV_VERSION;
    Settings settings;
    Input input = declare(settings);
    read_settings(input, settings_path, given);
    provenance.resolved_input = input.resolved();

    const Recording recording =
        apply(settings, open_recording(recording_path, settings.read_options()));
    const auto& header = recording.header();
    provenance.inputs.push_back({recording_path, header.sha256});
    // Of a folder the checksum covers the files already.
    if (!std::filesystem::is_directory(recording_path))
      for (const auto& file : header.companions) provenance.add_input(file);
    for (const auto& file : input.files()) provenance.add_input(file);
    PixelSize pixel{header.pixel_size, header.pixel_size, 0, 0};
    if (!settings.calibration.empty()) pixel = read_pixel_size(settings.calibration);

    const PointSpread spread = point_spread_of(settings, header);
    const Measurement measurement =
        measure_recording(recording, settings.measurement(pixel, spread.sigma, spread.u));
    const Analysis& analysis = measurement.analysis;
    std::map<std::string, std::string> files = {
        {"frames.csv", frames_table(recording, analysis)},
        {"annotated.png", annotated_picture(recording, analysis, pixel)},
        {"contact_sheet.png", contact_sheet(recording, analysis)}};
    const std::string tail = tail_table(measurement, pixel);
    if (!tail.empty()) files["tail.csv"] = tail;
    FilmStrip strip;
    if (film) strip = film_strip(recording, analysis);
    if (film) files["film.png"] = strip.png;
    provenance.wall_time = provenance.elapsed();
    nlohmann::json json = summary(recording, measurement, pixel, settings, provenance);
    json["parameters"] = parameters_json(header, settings, pixel, spread);
    if (film) json["film_frames"] = strip.frames;
    files["summary.json"] = json.dump(2) + "\n";
    write_all(output, files);
    if (!program.quiet()) fmt::print("{}Written to {}.\n", spoken(recording, measurement), output);
    if (header.frames_lost > 0) return ExitStatus::truncated;
    return analysis.found ? ExitStatus::success : ExitStatus::no_result;
  });
}
