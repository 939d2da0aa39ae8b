// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/line_options.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "validation/csv.hpp"
#include "validation/eds/elements.hpp"

namespace meltproof::validation {
namespace {

/// The value of an option, with the option named in what is refused.
double quantity(const std::string& option, const std::string& text, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const InputError& problem) {
    throw InputError(fmt::format("{}: {}", option, problem.what()));
  }
}

double not_negative(const std::string& option, const std::string& text, const std::string& unit) {
  const double value = quantity(option, text, unit);
  if (!(value >= 0)) {
    throw InputError(fmt::format("{}: {} is less than nothing.", option, text));
  }
  return value;
}

std::optional<double> if_given(const std::string& option, const std::string& text,
                               const std::string& unit) {
  return text.empty() ? std::nullopt : std::optional(not_negative(option, text, unit));
}

/// Lengths "200 um, 40 um".
std::vector<double> lengths(const std::string& option, const std::string& text, std::size_t count,
                            const std::string& example) {
  std::vector<double> values;
  for (const auto& part : split_cells(text, ',')) {
    values.push_back(quantity(option, part, "m"));
  }
  if (values.size() != count) {
    throw InputError(fmt::format("{}: \"{}\" holds {} lengths: expected {}, for example \"{}\".",
                                 option, text, values.size(), count, example));
  }
  return values;
}

Point point(const std::string& option, const std::string& text) {
  const auto values = lengths(option, text, 3, "200 um, 40 um, -5 um");
  return {values[0], values[1], values[2]};
}

/// Mass fractions "Fe 66 %, Cr 17 %, ...".
ElementFractions composition(const std::string& text) {
  ElementFractions result;
  double sum = 0;
  for (const auto& part : split_cells(text, ',')) {
    const auto blank = part.find(' ');
    const std::string symbol = part.substr(0, blank);
    if (blank == std::string::npos || !is_element(symbol)) {
      throw InputError(fmt::format(
          "--base: \"{}\" is no element and its share: expected, for example, \"Fe 66 %, Cr 17 %, "
          "Ni 12 %, Mo 2.5 %, Mn 1.5 %, Si 0.5 %\".",
          part));
    }
    result[symbol] = not_negative("--base", trimmed(part.substr(blank)), "1");
    sum += result[symbol];
  }
  if (!(sum > 0.95 && sum < 1.05)) {
    throw InputError(
        fmt::format("--base: the shares add to {:.4g} %: expected a whole composition, near 100 %.",
                    100 * sum));
  }
  return result;
}

Estimate estimate(const TypedLine& typed) {
  return typed.element == "Si"    ? Estimate::silicon
         : typed.element == "all" ? Estimate::least_squares
                                  : Estimate::aluminium;
}

/// The steel that the additive went into, from --base, --base-silicon or neither.
void understand_base(const TypedLine& typed, ElementFractions& base, bool& given) {
  if (!typed.base.empty()) {
    base = composition(typed.base);
    given = true;
  }
  if (!typed.silicon.empty()) {
    base["Si"] = not_negative("--base-silicon", typed.silicon, "1");
    given = true;
  }
  if (typed.element == "Si" && !given) {
    throw InputError(
        "--element Si needs the silicon of the steel: add, for example, --base-silicon \"0.5 "
        "%\" as measured away from the track.");
  }
}

ScanOptions scan_options(const TypedLine& typed) {
  ScanOptions options;
  options.point_spacing = if_given("--point-spacing", typed.point_spacing, "m");
  if (typed.map_start.empty() != typed.map_end.empty()) {
    throw InputError("a line through a map has two ends: give both --map-start and --map-end.");
  }
  if (!typed.map_start.empty()) {
    const auto start = lengths("--map-start", typed.map_start, 2, "10 um, 25 um");
    const auto end = lengths("--map-end", typed.map_end, 2, "10 um, 45 um");
    options.map_line = ScanOptions::MapLine{
        {start[0], start[1]}, {end[0], end[1]}, not_negative("--map-width", typed.map_width, "m")};
  }
  return options;
}

void understand_line(const TypedLine& typed, LineRequest& request) {
  if (typed.grain.empty() == (typed.start.empty() || typed.end.empty())) {
    throw InputError(
        "which line? Expected either --grain depth, --grain lateral, or both --start and --end.");
  }
  if (!typed.grain.empty()) {
    request.grain = typed.grain == "depth" ? Direction::depth : Direction::lateral;
  } else {
    request.start = point("--start", typed.start);
    request.end = point("--end", typed.end);
  }
  request.length = quantity("--length", typed.length, "m");
  if (!(request.length > 0)) {
    throw InputError(fmt::format("--length: {} is no length of a line.", typed.length));
  }
  request.step = quantity("--step", typed.step, "m");
  request.width = not_negative("--width", typed.width, "m");
  request.depth = if_given("--depth", typed.depth, "m");
  request.beam = typed.beam;
}

void understand_registration(const TypedLine& typed, RegistrationBounds& bounds) {
  bounds.shift = not_negative("--shift", typed.shift, "m");
  bounds.reversible = typed.reversible;
  if (typed.landmark.empty()) {
    return;
  }
  bounds.landmark.emplace();
  if (typed.landmark != "half-height") {
    const auto places = lengths("--landmark", typed.landmark, 2, "3.2 um, 1.7 um");
    bounds.landmark = Landmark{false, places[0], places[1]};
  }
}

}  // namespace

LineRequest understand(const TypedLine& typed) {
  if (typed.run.empty()) {
    throw InputError(
        "which run? Expected run.h5 of meltproof-solve, or --spectrum FILE to see what a file "
        "holds.");
  }
  LineRequest request;
  request.run = typed.run;
  understand_line(typed, request);
  request.voltage = quantity("--voltage", typed.voltage, "kV");
  request.matrix = typed.matrix == "iron"        ? Matrix::iron
                   : typed.matrix == "aluminium" ? Matrix::aluminium
                                                 : Matrix::local;
  request.sigma = if_given("--interaction", typed.sigma, "m");
  request.measured = typed.measured;
  request.options = scan_options(typed);
  request.from = estimate(typed);
  understand_base(typed, request.base, request.base_given);
  understand_registration(typed, request.bounds);
  request.numerical = if_given("--numerical", typed.numerical, "1");
  request.systematic = if_given("--systematic", typed.systematic, "1");
  return request;
}

MeasuredRequest understand_spectrum(const TypedLine& typed) {
  MeasuredRequest request;
  request.path = typed.spectrum;
  TypedLine any = typed;
  any.element = "Al";  // all estimates are shown
  understand_base(any, request.base, request.base_given);
  return request;
}

std::string line_scan_help() {
  return "Samples the concentration of AlSi10Mg in the solidified track of a run, in a strip as "
         "wide\n"
         "as the scan and as deep as the X-rays come from, blurs it as the electron beam does, "
         "and\n"
         "compares it with a measured line scan. Without one the result says \"pending\".\n\n"
         "  meltproof-linescan run.h5 --grain depth --output linescan_depth.json\n\n"
         "Your own file goes to --measured; its format is found by its content:\n\n"
         "  CSV of AZtec, Esprit or EDAX: columns \"Distance (um)\", \"Al Wt%\", \"Al Wt% Sigma\", "
         "...\n"
         "    meltproof-linescan run.h5 --grain depth --measured scan.csv --shift \"2 um\"\n"
         "  H5OINA, a line scan or a map of AZtec (quantified):\n"
         "    ... --measured line.h5oina\n"
         "    ... --measured map.h5oina --map-start \"10 um, 5 um\" --map-end \"10 um, 25 um\"\n"
         "        --map-width \"2 um\"\n"
         "  maps as TIFF or HDF5, one element each, described in a small file map.toml:\n"
         "    unit = \"wt%\"            pixel_size = \"0.2 um\"      (one key a line)\n"
         "    [[element]]             symbol = \"Al\"              file = \"al.tif\"\n"
         "    percent_per_count = 0.01 (integers)   dataset = \"maps/Al\" (HDF5)   sigma_file = "
         "...\n"
         "    ... --measured map.toml --map-start ... --map-end ...\n"
         "  Bruker SPX, spectra with a quantification as points of a line:\n"
         "    ... --measured points.csv      (header \"file,position [um]\", one spectrum a row)\n"
         "    ... --measured folder/ --point-spacing \"0.5 um\"\n"
         "  a concentration of AlSi10Mg itself: CSV with \"position [um],concentration [%],\n"
         "    concentration_u [%]\", as in data/experiments\n"
         "  EMSA/MAS (.msa) holds a spectrum, no composition. What any file holds:\n"
         "    meltproof-linescan --spectrum file.msa";
}

void add_line_options(CLI::App& app, TypedLine& typed) {
  app.add_option("run", typed.run, "run.h5 of meltproof-solve");
  app.add_option("-o,--output", typed.output, "where the result goes (JSON)")
      ->capture_default_str();
  app.add_option(
      "--spectrum", typed.spectrum,
      "print what a file of an EDS program holds, with counts and their noise, and stop");
  const std::string where = "Which line";
  app.add_option("--grain", typed.grain,
                 "line through the molten additive grain nearest to the pool's edge")
      ->check(CLI::IsMember({"depth", "lateral"}))
      ->group(where);
  app.add_option("--start", typed.start, "first point of a line, \"x, y, z\" with units")
      ->group(where);
  app.add_option("--end", typed.end, "last point of a line")->group(where);
  app.add_option("--length", typed.length, "of the line through a grain")
      ->capture_default_str()
      ->group(where);
  app.add_option("--step", typed.step, "distance of the samples")
      ->capture_default_str()
      ->group(where);
  const std::string beam = "What the beam sees";
  app.add_option("--width", typed.width, "of the scan, across the line; \"0 um\" for none")
      ->capture_default_str()
      ->group(beam);
  app.add_option("--depth", typed.depth, "of the strip; default the range of the X-rays")
      ->group(beam);
  app.add_option(
         "--beam", typed.beam,
         "axis along which the beam enters the section: x, -x, y, ...; default the one most "
         "across the line")
      ->group(beam);
  app.add_option("--voltage", typed.voltage, "of the electron beam")
      ->capture_default_str()
      ->group(beam);
  app.add_option("--matrix", typed.matrix,
                 "what the electrons run through: what stands there, or one metal")
      ->check(CLI::IsMember({"local", "iron", "aluminium"}))
      ->capture_default_str()
      ->group(beam);
  app.add_option("--interaction", typed.sigma,
                 "standard deviation of the interaction volume, \"0 um\" for none; default from "
                 "the range of the X-rays in the matrix")
      ->group(beam);
  const std::string file = "The measurement";
  app.add_option("--measured", typed.measured, "measured line scan, see above")->group(file);
  app.add_option("--element", typed.element,
                 "that the compared concentration is taken from; all: least squares. The result "
                 "holds every one that the scan allows")
      ->check(CLI::IsMember({"Al", "Si", "all"}))
      ->capture_default_str()
      ->group(file);
  app.add_option("--base", typed.base,
                 "composition of the steel, \"Fe 66 %, Cr 17 %, ...\"; default nominal 316L")
      ->group(file);
  app.add_option("--base-silicon", typed.silicon, "silicon in the steel, for --element Si")
      ->group(file);
  app.add_option("--map-start", typed.map_start,
                 "first point of a line through a map, \"x, y\" from the first pixel, y down")
      ->group(file);
  app.add_option("--map-end", typed.map_end, "last point of it")->group(file);
  app.add_option("--map-width", typed.map_width, "averaged across the line through a map")
      ->capture_default_str()
      ->group(file);
  app.add_option("--point-spacing", typed.point_spacing, "between the spectra of a folder")
      ->group(file);
  const std::string comparison = "The comparison";
  app.add_option("--shift", typed.shift, "largest shift that registration may fit")
      ->capture_default_str()
      ->group(comparison);
  app.add_flag("--reversible", typed.reversible, "registration may also turn the line round")
      ->group(comparison);
  app.add_option("--landmark", typed.landmark,
                 "shift by a feature instead of the best fit: half-height, or its place on the "
                 "simulated and on the measured line, \"3.2 um, 1.7 um\"")
      ->group(comparison);
  app.add_option("--numerical", typed.numerical,
                 "standard uncertainty of the simulated concentration, \"1 %\"; default from the "
                 "spacing and the slope")
      ->group(comparison);
  app.add_option("--systematic", typed.systematic,
                 "relative standard uncertainty of the quantification that all points share")
      ->group(comparison);
}

}  // namespace meltproof::validation
