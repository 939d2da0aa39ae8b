// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/settings.hpp"

namespace meltproof::imaging {

namespace {

InputTable reference_table(Settings& s) {
  InputTable table("reference",
                   "What must hold before a feature of the tail is taken for the "
                   "solidification front.");
  table
      .quantity(s.rules.prominence,
                {.name = "prominence",
                 .unit = "1",
                 .about = "least height of the feature in ln S; latent heat of steel makes about "
                          "0.5, an emissivity from 0.2 to 0.3 makes 0.4, and smooth analytic "
                          "tails are fitted with up to 0.1 where there is nothing",
                 .minimum = 0.02,
                 .maximum = 2})
      .quantity(s.rules.significance,
                {.name = "significance",
                 .unit = "1",
                 .about = "that height over its standard uncertainty; 5 as is usual for a claim "
                          "of discovery",
                 .minimum = 1,
                 .maximum = 100})
      .quantity(s.rules.flattening,
                {.name = "flattening",
                 .unit = "1",
                 .about = "least part of its slope that the signal loses within the feature; "
                          "latent heat of steel takes 0.8 and more",
                 .minimum = 0.1,
                 .maximum = 1})
      .whole(s.fewest_lines, {.name = "fewest_lines",
                              .about = "lines of pixels that must show it, the least number "
                                       "that can outvote a defect",
                              .minimum = 2,
                              .maximum = 1000})
      .quantity(s.rules.share, {.name = "share",
                                .unit = "1",
                                .about = "part of the lines across the front that must show it: "
                                         "the majority",
                                .minimum = 0.1,
                                .maximum = 1})
      .quantity(s.rules.uncertainty,
                {.name = "uncertainty",
                 .unit = "1",
                 .about = "largest half width of the length's 95 % interval, over the length; a "
                          "length that is known less well is not given as independent of the "
                          "emissivity. Give 0.0133 where all must be within 2 %, three standard "
                          "deviations: fewer lengths are given then",
                 .minimum = 1e-3,
                 .maximum = 10})
      .quantity(s.rules.freezing_heat,
                {.name = "freezing_heat",
                 .unit = "1",
                 .about = "heat that the alloy gives off from liquidus to solidus (latent heat and "
                          "what cools it through that range), over specific heat times "
                          "liquidus, 0.19 to 0.23 for 316L; `make process MATERIAL=` takes it "
                          "from the material's file; without it 0.16 to 0.48 are taken to be "
                          "as likely",
                 .minimum = 0.05,
                 .maximum = 1})
      .quantity(s.rules.u_freezing_heat,
                {.name = "u_freezing_heat",
                 .unit = "1",
                 .about = "its standard uncertainty, relative: the specific heats of solid and "
                          "liquid steel differ by as much",
                 .minimum = 0.01,
                 .maximum = 1});
  return table;
}

InputTable reading_table(Settings& s) {
  InputTable table("reading", "What a file does not say of itself; what is empty is found out.");
  table
      .text(s.reading.dataset,
            {.name = "dataset", .about = "HDF5, MATLAB: path of the array with the frames"})
      .text(s.reading.axes, {.name = "axes",
                             .about = "HDF5, MATLAB: what its indices count, f frames, h rows, w "
                                      "columns, as the file's own language writes them"})
      .text(s.reading.separator, {.name = "separator",
                                  .about = "CSV: what stands between two values",
                                  .choices = {"", "tab", "space", ",", ";", "|"}})
      .text(s.reading.decimal,
            {.name = "decimal", .about = "CSV: decimal sign", .choices = {"", ".", ","}})
      .whole(s.preamble_lines, {.name = "preamble_lines",
                                .about = "CSV: lines at the beginning without pixels; -1: found",
                                .minimum = -1,
                                .maximum = 1000000})
      .whole(s.frame_rows, {.name = "frame_rows",
                            .about = "CSV: rows of a frame where nothing separates them; 0: found",
                            .minimum = 0,
                            .maximum = 1000000})
      .text(s.reading.unit, {.name = "unit",
                             .about = "what values are whose file does not say it",
                             .choices = {"", "count", "K", "degC"}});
  return table;
}

InputTable budget_table(Settings& s) {
  BudgetSettings& b = s.budget;
  InputTable table("budget",
                   "What is known of the inputs of the uncertainty budget; standard "
                   "uncertainties.");
  table
      .quantity(
          s.point_spread,
          {.name = "point_spread",
           .unit = "1",
           .about = "sigma of the optics' Gaussian point spread in pixels; without it the blur "
                    "of the scale's edges in the calibration, then what the file says, then "
                    "0.8 px, the virtual camera's, since the paper gives none",
           .minimum = 0,
           .maximum = 10})
      .quantity(
          s.u_point_spread,
          {.name = "u_point_spread",
           .unit = "1",
           .about = "of it, in pixels; without it what the scatter of the scale's edges leaves "
                    "open, at least 0.01 px, 0.02 px of what a file says, else 0.1 px",
           .minimum = 0,
           .maximum = 10})
      .quantity(b.u_integration_time, {.name = "u_integration_time",
                                       .unit = "1",
                                       .about = "of the integration time, relative",
                                       .minimum = 0,
                                       .maximum = 1})
      .quantity(b.u_reference_temperature,
                {.name = "u_reference_temperature",
                 .unit = "K",
                 .about = "of the reference temperature: published liquidus temperatures of 316L "
                          "differ by some 10 K with composition",
                 .minimum = 0,
                 .maximum = 500})
      .quantity(b.u_emissivity,
                {.name = "u_emissivity",
                 .unit = "1",
                 .about = "of an emissivity that the level rests on, relative; say it where the "
                          "emissivity was measured. Without it half the distance, in ln, from "
                          "the farther end of what is published for liquid metals between 3 and "
                          "5 um, 0.15 to 0.5: 0.35 for an emissivity of 0.3",
                 .minimum = 0,
                 .maximum = 1})
      .quantity(b.u_transmission, {.name = "u_transmission",
                                   .unit = "1",
                                   .about = "of the windows' transmission, relative: the paper "
                                            "gives four digits of a mean over the band",
                                   .minimum = 0,
                                   .maximum = 1})
      .quantity(b.u_level, {.name = "u_level",
                            .unit = "1",
                            .about = "of a level that was given, relative to the signal above "
                                     "dark; 0 takes it as exact",
                            .minimum = 0,
                            .maximum = 1})
      .quantity(b.non_uniformity,
                {.name = "non_uniformity",
                 .unit = "1",
                 .about = "standard deviation between the gains of pixels after the camera's own "
                          "correction; makers promise some 0.2 to 0.5 %",
                 .minimum = 0,
                 .maximum = 1})
      .whole(b.draws, {.name = "draws",
                       .about = "of the Monte Carlo; 1000 fix the limits of a 95 % interval to "
                                "some 5 % of its width",
                       .minimum = 100,
                       .maximum = 1000000});
  return table;
}

}  // namespace

ReadOptions Settings::read_options() const {
  ReadOptions options = reading;
  if (preamble_lines >= 0) options.preamble_lines = static_cast<std::size_t>(preamble_lines);
  if (frame_rows > 0) options.frame_rows = static_cast<std::size_t>(frame_rows);
  return options;
}

MeasurementRequest Settings::measurement(const PixelSize& pixel, double spread,
                                         double u_spread) const {
  MeasurementRequest m;
  m.level = request();
  m.dark = dark;
  m.search = parse_reference_search(reference_signal);
  m.rules = rules;
  m.rules.fewest_lines = static_cast<std::size_t>(fewest_lines);
  m.direction = parse_scan_direction(scan_direction);
  m.pixel = pixel;
  m.budget = budget;
  m.budget.point_spread = spread;
  m.budget.u_point_spread = u_spread;
  return m;
}

Input declare(Settings& s) {
  InputTable root("thermography", "How a recording of a melt pool is read and measured.");
  root.quantity(
          s.level,
          {.name = "level",
           .unit = "1",
           .about = "signal in counts at which the pool ends; replaces the reference temperature"})
      .quantity(
          s.reference_temperature,
          {.name = "reference_temperature",
           .unit = "K",
           .about = "temperature at which the pool ends, normally the liquidus of the alloy; "
                    "without it 1683 K, the "
                    "liquidus of 316L, where the recording holds temperatures or a radiometry",
           .minimum = 200,
           .maximum = 5000})
      .quantity(s.emissivity, {.name = "emissivity",
                               .unit = "1",
                               .about = "emissivity of solid metal in the camera's band",
                               .minimum = 0.01,
                               .maximum = 1})
      .quantity(s.emissivity_liquid, {.name = "emissivity_liquid",
                                      .unit = "1",
                                      .about = "emissivity of liquid metal in the camera's band, "
                                               "where it is less than that of solid metal",
                                      .minimum = 0.01,
                                      .maximum = 1})
      .quantity(s.transmission,
                {.name = "transmission",
                 .unit = "1",
                 .about = "transmission of all windows together in the camera's band",
                 .minimum = 1e-4,
                 .maximum = 1})
      .quantity(s.frame_rate, {.name = "frame_rate",
                               .unit = "Hz",
                               .about = "frames per second, for files that hold none",
                               .minimum = 1e-6,
                               .maximum = 1e9})
      .quantity(
          s.kelvin_per_count,
          {.name = "kelvin_per_count",
           .unit = "K",
           .about = "temperature of one count, for exports with a linear scale such as 0.04 K",
           .minimum = 1e-6,
           .maximum = 1e3})
      .quantity(s.zero_count_temperature, {.name = "zero_count_temperature",
                                           .unit = "K",
                                           .about = "temperature of count 0 of that scale"})
      .quantity(s.scan_speed, {.name = "scan_speed",
                               .unit = "m s-1",
                               .about = "speed of the beam, to check the speed that is measured",
                               .minimum = 1e-9,
                               .maximum = 1e3})
      .text(s.scan_direction, {.name = "scan_direction",
                               .about = "where the beam goes in the image; y points downwards",
                               .choices = {"+x", "-x", "+y", "-y"}})
      .text(s.reference_signal,
            {.name = "reference_signal",
             .about = "whether the signal of the phase boundary is looked for in the recording: "
                      "auto uses it where it is found, unless a level or an emissivity is given; "
                      "find gives no result without it",
             .choices = {"auto", "find", "off"}})
      .quantity(s.dark, {.name = "dark",
                         .unit = "1",
                         .about = "counts without light, for files that do not hold it; without "
                                  "it nothing is looked for in bare counts",
                         .minimum = -65536,
                         .maximum = 65536})
      .file(s.spectral_response,
            {.name = "spectral_response",
             .about = "CSV table of the detector's response by wavelength, which replaces the flat "
                      "band of the file"})
      .file(s.window_spectrum,
            {.name = "window_spectrum",
             .about = "CSV table of all windows' transmission together by wavelength, used with "
                      "spectral_response instead of transmission"})
      .file(s.uniform_cold,
            {.name = "uniform_cold",
             .about = "recording of a uniform cold surface in the same window and integration "
                      "time, for the pixels' offsets; used with uniform_hot"})
      .file(s.uniform_hot, {.name = "uniform_hot",
                            .about = "recording of a uniform warmer surface, for the pixels' "
                                     "gains"})
      .table(reference_table(s))
      .table(budget_table(s))
      .table(reading_table(s))
      .file(s.calibration,
            {.name = "calibration",
             .about =
                 "calibration.json of meltproof-calibrate, for lengths in um instead of pixels"});
  return Input(std::move(root));
}

}  // namespace meltproof::imaging
