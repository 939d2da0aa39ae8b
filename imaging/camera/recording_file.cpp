// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/recording_file.hpp"

namespace meltproof::imaging {

RecordingFile::RecordingFile(const std::filesystem::path& path, const std::string& synthetic,
                             const std::string& seen, std::size_t width, std::size_t height)
    : writer_(path, "meltproof recording"), width_(width), height_(height) {
  writer_.attribute("quantity", "counts");
  writer_.attribute("synthetic", synthetic);
  writer_.attribute("seen", seen);
}

void RecordingFile::add(const std::vector<std::uint16_t>& counts, double time,
                        const FrameTruth& truth) {
  writer_.append("frames", counts, {height_, width_}, "count",
                 "Signal of every pixel; first the uppermost row, in it first the left column.");
  times_.push_back(time);
  columns_.push_back(truth.beam_column);
  lengths_.push_back(truth.visible_length);
  depths_.push_back(truth.visible_depth);
}

void RecordingFile::describe_sensor(const CameraSettings& camera, double pixel_size) {
  writer_.write("integration_time", camera.integration_time, "s",
                "Time over which a frame collected light, centred on its time.");
  writer_.write("frame_rate", camera.frame_rate, "Hz", "Frames a second.");
  writer_.write("pixel_size", pixel_size, "m",
                "Size of a pixel on the object, both axes; 0: unknown.");
  writer_.write("saturation_count", camera.full_scale(), "count",
                "A pixel at this count is saturated.");
  writer_.write("optics/point_spread", camera.point_spread, "1",
                "Sigma of the point spread, pixels.");
}

void RecordingFile::describe_radiometry(const CameraSettings& camera, const Radiometry& r) {
  writer_.write("radiometry/band_lower", r.band_lower, "m", "Lower limit of the band.");
  writer_.write("radiometry/band_upper", r.band_upper, "m", "Upper limit of the band.");
  writer_.write("radiometry/transmission", r.transmission, "1", "Of all windows together.");
  writer_.write("radiometry/emissivity", r.emissivity, "1",
                "Of solid metal, which surrounds a melt pool.");
  writer_.write("radiometry/emissivity_liquid", camera.emissivity_liquid, "1", "Of liquid metal.");
  writer_.write("radiometry/gain", r.gain, "m2 sr W-1 s-1",
                "Counts for radiance times integration time.");
  writer_.write("radiometry/dark", r.dark, "count", "Signal without light.");
  writer_.write("radiometry/ambient_temperature", r.ambient_temperature, "K",
                "Of what metal reflects.");
  writer_.write("radiometry/window_temperature", r.window_temperature, "K", "Of the windows.");
  writer_.write("radiometry/window_emission", r.window_emission ? 1.0 : 0.0, "1",
                "1 if the windows' own radiation is in the signal.");
}

void RecordingFile::describe_scene(double scan_speed, double reference_temperature, double x,
                                   double z) {
  has_scene_ = true;
  writer_.write("scan_speed", scan_speed, "m s-1", "Of the beam along the image's columns.");
  writer_.write("truth/reference_temperature", reference_temperature, "K",
                "Liquidus of the base material: outline of the truth below.");
  writer_.write("truth/first_pixel_x", x, "m", "Centre of the first pixel in the scene.");
  writer_.write("truth/first_pixel_z", z, "m", "Centre of the first pixel in the scene, upwards.");
}

void RecordingFile::truth(const std::string& name, double value, const std::string& unit,
                          const std::string& description) {
  writer_.write("truth/" + name, value, unit, description);
}

void RecordingFile::commit(Provenance provenance) {
  writer_.write("time", times_, {times_.size()}, "s", "Middle of each frame's integration time.");
  if (has_scene_) {
    writer_.write("truth/beam_column", columns_, {columns_.size()}, "1",
                  "Image column of the beam's axis, pixels from the first pixel's centre.");
    writer_.write(
        "truth/visible_length", lengths_, {lengths_.size()}, "m",
        "Extent along the columns of the largest connected part at or above the reference "
        "temperature, in the scene before any optics; 0: none.");
    writer_.write("truth/visible_depth", depths_, {depths_.size()}, "m",
                  "The same along the rows.");
  }
  provenance.wall_time = provenance.elapsed();
  writer_.commit(provenance);
}

}  // namespace meltproof::imaging
