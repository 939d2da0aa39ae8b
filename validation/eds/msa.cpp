// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/msa.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/csv.hpp"
#include "validation/eds/exported_table.hpp"

namespace meltproof::validation {
namespace {

constexpr std::size_t most_channels = 1 << 20;

/// The header by keyword in lower case without "-UNITS" behind it, and where the data begin.
struct Header {
  std::string place;
  std::map<std::string, std::string> values;
  std::size_t data = 0;  ///< index of the first line of data

  std::string text(const std::string& key) const {
    const auto at = values.find(key);
    return at == values.end() ? "" : at->second;
  }
  std::optional<double> number(const std::string& key) const {
    const std::string found = text(key);
    if (found.empty()) {
      return std::nullopt;
    }
    const auto value = number_of(found);
    if (!value || !std::isfinite(*value)) {
      throw InputError(
          fmt::format("{}: #{} is \"{}\": expected a number.", place, upper(key), found));
    }
    return value;
  }
  double required(const std::string& key) const {
    const auto value = number(key);
    if (!value) {
      throw InputError(fmt::format(
          "{}: the keyword #{} is missing, without which the spectrum has no scale: export it "
          "again as EMSA/MAS.",
          place, upper(key)));
    }
    return *value;
  }
  static std::string upper(std::string key) {
    for (char& c : key) {
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return key;
  }
};

Header read_header(const std::vector<std::string>& lines, const std::string& place) {
  Header header;
  header.place = place;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const auto colon = line.find(':');
    if (!line.starts_with('#') || colon == std::string::npos) {
      throw InputError(
          fmt::format("{}:{}: \"{}\" stands before #SPECTRUM and is no line \"#KEYWORD : value\".",
                      place, i + 1, line.substr(0, 40)));
    }
    // A keyword may name its unit: "#BEAMKV   -kV: 20".
    std::string key = lower(line.substr(1, colon - 1));
    key = trimmed(key.substr(0, key.find('-')));
    if (key == "spectrum") {
      header.data = i + 1;
      return header;
    }
    header.values.try_emplace(key, trimmed(line.substr(colon + 1)));
  }
  throw InputError(fmt::format("{}: the file ends before #SPECTRUM: it is cut off.", place));
}

std::vector<double> read_values(const std::vector<std::string>& lines, const Header& header) {
  std::vector<double> values;
  for (std::size_t i = header.data; i < lines.size(); ++i) {
    if (lower(lines[i]).starts_with("#endofdata")) {
      return values;
    }
    std::string cell;
    for (const char c : lines[i] + " ") {
      if (c != ',' && c != ' ' && c != '\t' && c != ';') {
        cell += c;
        continue;
      }
      if (cell.empty()) {
        continue;  // lines end in a comma, and commas stand beside blanks
      }
      const auto value = number_of(cell);
      if (!value || !std::isfinite(*value)) {
        throw InputError(
            fmt::format("{}:{}: \"{}\" is no number: expected counts.", header.place, i + 1, cell));
      }
      values.push_back(*value);
      cell.clear();
    }
    if (values.size() > 2 * most_channels) {
      throw InputError(fmt::format("{}: more than {} channels: this is no spectrum.", header.place,
                                   most_channels));
    }
  }
  throw InputError(
      fmt::format("{}: the file ends without #ENDOFDATA after {} values: it is cut off.",
                  header.place, values.size()));
}

}  // namespace

bool is_msa(std::string_view first_bytes) {
  const std::string start = lower(std::string(first_bytes.substr(0, 200)));
  return trimmed(start).starts_with("#format") && start.find("emsa") != std::string::npos;
}

Spectrum read_msa(const std::filesystem::path& path) {
  const auto lines = lines_of(read_file(path));
  const Header header = read_header(lines, path.string());
  const std::string unit = lower(header.text("xunits")), type = lower(header.text("datatype"));
  Spectrum spectrum;
  spectrum.path = path;
  spectrum.title = header.text("title");
  spectrum.voltage = header.number("beamkv");
  spectrum.livetime = header.number("livetime");
  double scale = 0;
  if (unit == "ev") {
    scale = 1e-3;
  } else if (unit == "kev") {
    scale = 1;
  } else if (unit == "um" || unit == "nm" || unit == "mm" || unit == "micron") {
    spectrum.along_a_line = true;
    scale = unit == "nm" ? 1e-9 : unit == "mm" ? 1e-3 : 1e-6;
  } else {
    throw InputError(fmt::format(
        "{}: #XUNITS is \"{}\": expected eV or keV for a spectrum, or um or nm for a line.",
        path.string(), header.text("xunits")));
  }
  if (type != "y" && type != "xy") {
    throw InputError(fmt::format("{}: #DATATYPE is \"{}\": expected Y or XY.", path.string(),
                                 header.text("datatype")));
  }
  const auto values = read_values(lines, header);
  const double points = header.required("npoints");
  const std::size_t found = type == "y" ? values.size() : values.size() / 2;
  if (points != static_cast<double>(found) || (type == "xy" && values.size() % 2 != 0) ||
      found < 2) {
    throw InputError(
        fmt::format("{}: #NPOINTS announces {} channels and {} values follow: the file is damaged.",
                    path.string(), points, values.size()));
  }
  if (type == "y") {
    spectrum.counts = values;
    spectrum.channel_width = scale * header.required("xperchan");
    spectrum.first_energy = scale * header.required("offset");
  } else {
    spectrum.first_energy = scale * values[0];
    spectrum.channel_width =
        scale * (values[values.size() - 2] - values[0]) / static_cast<double>(found - 1);
    for (std::size_t i = 0; i < found; ++i) {
      const double expected = spectrum.energy(i);
      if (!(std::abs(scale * values[2 * i] - expected) <= 0.5 * spectrum.channel_width)) {
        throw InputError(
            fmt::format("{}: the energies are not evenly spaced (channel {} at {} {}).",
                        path.string(), i, values[2 * i], header.text("xunits")));
      }
      spectrum.counts.push_back(values[2 * i + 1]);
    }
  }
  if (!(spectrum.channel_width > 0)) {
    throw InputError(fmt::format("{}: channels of {} {} cannot be: expected a positive #XPERCHAN.",
                                 path.string(), spectrum.channel_width / scale,
                                 header.text("xunits")));
  }
  return spectrum;
}

}  // namespace meltproof::validation
