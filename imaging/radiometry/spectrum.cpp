// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/radiometry/spectrum.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "imaging/radiometry/planck.hpp"

namespace meltproof::imaging {
namespace {

std::string stripped(std::string text) {
  const auto first = text.find_first_not_of(" \t\r\""), last = text.find_last_not_of(" \t\r\"");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

/// What a unit in brackets makes of a number.
double factor_of(const std::string& column,
                 const std::vector<std::pair<std::string, double>>& units,
                 const std::string& file) {
  for (const auto& [unit, factor] : units)
    if (column.find("[" + unit + "]") != std::string::npos) return factor;
  std::string known;
  for (const auto& [unit, factor] : units) known += (known.empty() ? "[" : ", [") + unit + "]";
  throw InputError(
      fmt::format("{}: the column \"{}\" names no unit that is known; expected one of {}.", file,
                  column, known));
}

double number(const std::string& text, const std::string& file, std::size_t line) {
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
    throw InputError(
        fmt::format("{}, line {}: \"{}\" is no number; expected two numbers separated "
                    "by a comma.",
                    file, line, text));
  return value;
}

}  // namespace

Spectrum::Spectrum(std::vector<double> wavelength, std::vector<double> value,
                   const std::string& origin)
    : wavelength_(std::move(wavelength)), value_(std::move(value)) {
  if (wavelength_.size() < 2 || wavelength_.size() != value_.size())
    throw InputError(fmt::format("{}: a spectrum needs two points or more, found {}.", origin,
                                 std::min(wavelength_.size(), value_.size())));
  double largest = 0;
  for (std::size_t i = 0; i < value_.size(); ++i) {
    if (!(wavelength_[i] > 0) || (i > 0 && !(wavelength_[i] > wavelength_[i - 1])))
      throw InputError(
          fmt::format("{}: the wavelengths must be positive and increase; point {} is "
                      "at {:.6g} um.",
                      origin, i + 1, wavelength_[i] * 1e6));
    if (!(value_[i] >= 0) || !std::isfinite(value_[i]))
      throw InputError(fmt::format("{}: the value at {:.6g} um is {:.6g}; expected zero or more.",
                                   origin, wavelength_[i] * 1e6, value_[i]));
    largest = std::max(largest, value_[i]);
  }
  if (!(largest > 0))
    throw InputError(fmt::format("{}: all values are zero, so nothing would be seen.", origin));
}

double Spectrum::at(double wavelength) const {
  if (wavelength < lower() || wavelength > upper()) return 0;
  const auto after = std::upper_bound(wavelength_.begin(), wavelength_.end(), wavelength);
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      after - wavelength_.begin(), 1, static_cast<std::ptrdiff_t>(wavelength_.size()) - 1));
  const double t = (wavelength - wavelength_[i - 1]) / (wavelength_[i] - wavelength_[i - 1]);
  return (1 - t) * value_[i - 1] + t * value_[i];
}

Spectrum read_spectrum(const std::filesystem::path& path) {
  std::istringstream text(read_file(path));
  std::string line, header;
  std::vector<double> wavelength, value;
  double to_metres = 0, to_one = 0;
  for (std::size_t n = 1; std::getline(text, line); ++n) {
    line = stripped(line);
    if (line.empty() || line[0] == '#') continue;
    const auto comma = line.find(',');
    if (comma == std::string::npos)
      throw InputError(
          fmt::format("{}, line {}: found \"{}\"; expected two columns separated by a "
                      "comma.",
                      path.string(), n, line));
    const std::string first = stripped(line.substr(0, comma)),
                      second = stripped(line.substr(comma + 1));
    if (to_metres == 0) {
      to_metres = factor_of(first, {{"um", 1e-6}, {"nm", 1e-9}, {"m", 1}}, path.string());
      to_one = factor_of(second, {{"1", 1}, {"%", 0.01}}, path.string());
      continue;
    }
    wavelength.push_back(to_metres * number(first, path.string(), n));
    value.push_back(to_one * number(second, path.string(), n));
  }
  return {std::move(wavelength), std::move(value), path.string()};
}

Spectrum product(const std::vector<Spectrum>& spectra) {
  double lower = 0, upper = std::numeric_limits<double>::infinity();
  std::vector<double> points;
  for (const auto& s : spectra) {
    lower = std::max(lower, s.lower());
    upper = std::min(upper, s.upper());
    points.insert(points.end(), s.wavelength().begin(), s.wavelength().end());
  }
  if (spectra.empty() || !(upper > lower))
    throw InputError("The spectra of detector and windows have no wavelengths in common.");
  std::erase_if(points, [&](double p) { return p < lower || p > upper; });
  points.push_back(lower);
  points.push_back(upper);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  // A product of straight lines is a parabola; ten pieces of it are straight to a thousandth.
  std::vector<double> wavelength, value;
  constexpr int pieces = 10;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < (i + 1 < points.size() ? pieces : 1); ++k) {
      const double step = i + 1 < points.size() ? (points[i + 1] - points[i]) / pieces : 0;
      wavelength.push_back(points[i] + k * step);
      double w = 1;
      for (const auto& s : spectra) w *= s.at(wavelength.back());
      value.push_back(w);
    }
  return {std::move(wavelength), std::move(value), "the product of the spectra"};
}

double weighted_radiance(const Spectrum& weight, double temperature) {
  if (!(temperature > 0)) return 0;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < weight.wavelength().size(); ++i)
    sum += planck_integral(weight.wavelength()[i], weight.wavelength()[i + 1], 1 / temperature,
                           [&](double lambda) { return weight.at(lambda); });
  return sum;
}

double weighted_temperature(const Spectrum& weight, double radiance) {
  if (!(radiance > 0) || !std::isfinite(radiance)) return std::numeric_limits<double>::quiet_NaN();
  // ln L is nearly a straight line of 1/T: secants converge in a few steps from anywhere.
  double u = 1 / 1000.0, v = 1 / 1500.0;
  double fu = std::log(weighted_radiance(weight, 1 / u) / radiance),
         fv = std::log(weighted_radiance(weight, 1 / v) / radiance);
  for (int i = 0; i < 100 && fu != fv && std::abs(v - u) > 1e-14 * v; ++i) {
    double next = v - fv * (v - u) / (fv - fu);
    next = std::clamp(next, 0.2 * v, 5 * v);
    u = v;
    fu = fv;
    v = next;
    fv = std::log(weighted_radiance(weight, 1 / v) / radiance);
  }
  return 1 / v;
}

double effective_transmission(const Spectrum& response, const Spectrum& window,
                              double temperature) {
  return weighted_radiance(product({response, window}), temperature) /
         weighted_radiance(response, temperature);
}

}  // namespace meltproof::imaging
