// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/settings.hpp"

#include <utility>

#include "base/error.hpp"

namespace meltproof::imaging {
namespace {

InputTable sensor(CameraSettings& c) {
  InputTable table("sensor", "The detector and how it is read.");
  table
      .whole(c.width, {.name = "width",
                       .about = "Image width in pixels (paper: 96).",
                       .minimum = 4,
                       .maximum = 4096})
      .whole(c.height, {.name = "height",
                        .about = "Image height in pixels (paper: 40).",
                        .minimum = 4,
                        .maximum = 4096})
      .quantity(c.frame_rate, {.name = "frame_rate",
                               .unit = "Hz",
                               .about = "Frames a second (paper: 9762.5 Hz).",
                               .minimum = 1e-3})
      .quantity(c.integration_time,
                {.name = "integration_time",
                 .unit = "s",
                 .about = "Time over which a frame collects light. Not given by the paper; it "
                          "blurs the moving pool by speed times time.",
                 .minimum = 1e-9,
                 .maximum = 1})
      .whole(c.bits, {.name = "bits",
                      .about = "Bits of a count (paper's camera: 14).",
                      .minimum = 1,
                      .maximum = 16})
      .quantity(c.dark, {.name = "dark",
                         .unit = "1",
                         .about = "Counts without light. Not given by the paper.",
                         .minimum = 0,
                         .maximum = 65535})
      .quantity(c.saturation_temperature,
                {.name = "saturation_temperature",
                 .unit = "K",
                 .about = "Temperature of liquid metal at which the counts are full; sets the "
                          "gain, which the paper does not give.",
                 .minimum = 300,
                 .maximum = 20000})
      .quantity(c.full_well,
                {.name = "full_well",
                 .unit = "1",
                 .about = "Electrons at full counts; sets the shot noise. Not given by the paper.",
                 .minimum = 1})
      .quantity(
          c.read_noise,
          {.name = "read_noise",
           .unit = "1",
           .about = "Noise of reading a pixel, counts, standard deviation. Not given by the paper.",
           .minimum = 0});
  return table;
}

InputTable optics(CameraSettings& c) {
  InputTable table("optics", "Lens, filters and windows.");
  table
      .quantity(c.pixel_size, {.name = "pixel_size",
                               .unit = "m",
                               .about = "Size of a pixel on the object (paper: 17.6 um).",
                               .minimum = 1e-9})
      .quantity(c.band_lower, {.name = "band_lower",
                               .unit = "m",
                               .about = "Lower limit of the band (paper: 3 um).",
                               .minimum = 1e-7})
      .quantity(c.band_upper, {.name = "band_upper",
                               .unit = "m",
                               .about = "Upper limit of the band (paper: 5 um).",
                               .minimum = 1e-7})
      .quantity(c.transmission,
                {.name = "transmission",
                 .unit = "1",
                 .about = "Of all windows together (paper: ZnS 0.7257 times glass ceramic 0.4313).",
                 .minimum = 1e-6,
                 .maximum = 1})
      .quantity(c.point_spread,
                {.name = "point_spread",
                 .unit = "1",
                 .about = "Sigma of the Gaussian point spread in pixels. Not given by the paper.",
                 .minimum = 0,
                 .maximum = 20})
      .whole(c.supersampling, {.name = "supersampling",
                               .about = "Points per pixel and axis at which the scene is sampled.",
                               .minimum = 1,
                               .maximum = 32});
  return table;
}

InputTable surface(CameraSettings& c) {
  InputTable table("surface", "How the metal radiates, and its surroundings.");
  table
      .quantity(
          c.emissivity_liquid,
          {.name = "emissivity_liquid",
           .unit = "1",
           .about = "Of liquid metal in the band; between liquid and solid by liquid fraction.",
           .minimum = 1e-3,
           .maximum = 1})
      .quantity(c.emissivity_solid, {.name = "emissivity_solid",
                                     .unit = "1",
                                     .about = "Of solid metal in the band.",
                                     .minimum = 1e-3,
                                     .maximum = 1})
      .quantity(
          c.ambient_temperature,
          {.name = "ambient_temperature",
           .unit = "K",
           .about = "Of what the metal reflects, and of what is seen where there is no metal.",
           .minimum = 0,
           .maximum = 2000})
      .flag(c.window_emission,
            {.name = "window_emission", .about = "Whether the windows' own radiation is added."})
      .quantity(c.window_temperature, {.name = "window_temperature",
                                       .unit = "K",
                                       .about = "Of the windows.",
                                       .minimum = 0,
                                       .maximum = 2000});
  return table;
}

InputTable view(CameraSettings& c) {
  InputTable table("view",
                   "Where the camera looks: image columns along x, rows downwards along z.");
  table
      .quantity(c.section,
                {.name = "section",
                 .unit = "m",
                 .about = "y of the plane at or behind which the first metal is seen. The paper's "
                          "beam runs along the edge of the plate, so that the camera sees the "
                          "pool's cross-section: by default the track's centre line y = 0."})
      .text(c.look, {.name = "look",
                     .about = "Direction in which the camera looks. With \"-y\" the scan direction "
                              "points to the left.",
                     .choices = {"+y", "-y"}})
      .quantity(c.surface_row, {.name = "surface_row",
                                .unit = "1",
                                .about = "Image row in which the plate's surface z = 0 lies.",
                                .minimum = -1e4,
                                .maximum = 1e4})
      .quantity(
          c.centre,
          {.name = "centre",
           .unit = "m",
           .about = "x at the middle of the image; by default the middle of the beam's way."});
  return table;
}

InputTable rosenthal(RosenthalSettings& r) {
  InputTable table("rosenthal",
                   "An analytic pool for --rosenthal: a point source moving on a half-space.");
  table
      .quantity(r.initial_temperature,
                {.name = "initial_temperature", .unit = "K", .about = "Far away.", .minimum = 1})
      .quantity(r.absorbed_power, {.name = "absorbed_power",
                                   .unit = "W",
                                   .about = "Power that enters the metal.",
                                   .minimum = 1e-6})
      .quantity(
          r.conductivity,
          {.name = "conductivity", .unit = "W m-1 K-1", .about = "Of the metal.", .minimum = 1e-6})
      .quantity(
          r.diffusivity,
          {.name = "diffusivity", .unit = "m2 s-1", .about = "Of the metal.", .minimum = 1e-12})
      .quantity(r.scan_speed, {.name = "scan_speed",
                               .unit = "m s-1",
                               .about = "Of the source (paper: 0.375 m/s).",
                               .minimum = 1e-6})
      .quantity(r.reference_temperature, {.name = "reference_temperature",
                                          .unit = "K",
                                          .about = "Liquid at and above it.",
                                          .minimum = 1})
      .quantity(r.peak_temperature,
                {.name = "peak_temperature",
                 .unit = "K",
                 .about = "At which the infinite temperature of the point source is cut off.",
                 .minimum = 1})
      .whole(r.frames, {.name = "frames",
                        .about = "Number of frames; the source enters at the first.",
                        .minimum = 1,
                        .maximum = 1000000})
      .text(r.view,
            {.name = "view",
             .about = "What is seen: the section y = 0 from the side, or the surface from above.",
             .choices = {"side", "top"}});
  return table;
}

InputTable scale_table(ScaleScene& s) {
  InputTable table("scale", "A synthetic image of a glass scale for --scale.");
  table
      .quantity(
          s.period,
          {.name = "period", .unit = "m", .about = "From one line to the next.", .minimum = 1e-9})
      .quantity(s.line_width,
                {.name = "line_width", .unit = "m", .about = "Width of a line.", .minimum = 1e-9})
      .quantity(s.angle, {.name = "angle",
                          .unit = "rad",
                          .about = "Of the direction across the lines against the image's columns "
                                   "axis; write \"2 degrees\"."})
      .quantity(s.phase, {.name = "phase",
                          .unit = "1",
                          .about = "Of a line's centre against the image's, in periods."})
      .quantity(s.glass, {.name = "glass", .unit = "1", .about = "Counts between the lines."})
      .quantity(s.contrast,
                {.name = "contrast", .unit = "1", .about = "Counts of a line above the glass."})
      .quantity(s.vignette, {.name = "vignette",
                             .unit = "1",
                             .about = "Relative fall of the signal from the middle to a corner.",
                             .minimum = 0,
                             .maximum = 1})
      .quantity(s.noise, {.name = "noise",
                          .unit = "1",
                          .about = "Standard deviation of a pixel, counts.",
                          .minimum = 0});
  return table;
}

}  // namespace

Input declare_settings(CameraSettings& camera, RosenthalSettings& r, ScaleScene& scale) {
  InputTable root("camera",
                  "Settings of meltproof-camera. Everything has a default; where the paper gives "
                  "no value, the description says so.");
  root.table(sensor(camera))
      .table(optics(camera))
      .table(surface(camera))
      .table(view(camera))
      .table(rosenthal(r))
      .table(scale_table(scale));
  return Input(std::move(root));
}

Radiometry camera_radiometry(const CameraSettings& camera) {
  Radiometry r;
  r.band_lower = camera.band_lower;
  r.band_upper = camera.band_upper;
  r.transmission = camera.transmission;
  r.emissivity = camera.emissivity_solid;
  r.dark = camera.dark;
  r.ambient_temperature = camera.ambient_temperature;
  r.window_temperature = camera.window_temperature;
  r.window_emission = camera.window_emission;
  r.integration_time = camera.integration_time;
  r.gain = 1;
  const double light = signal(r, camera.saturation_temperature, camera.emissivity_liquid) - r.dark;
  const double span = camera.full_scale() - camera.dark;
  if (!(span > 0))
    throw InputError(
        "sensor.dark leaves no counts for light: it must be below the largest count that "
        "sensor.bits allows.");
  r.gain = span / light;
  return r;
}

}  // namespace meltproof::imaging
