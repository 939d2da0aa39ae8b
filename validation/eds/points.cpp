// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/points.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "validation/csv.hpp"
#include "validation/eds/exported_table.hpp"
#include "validation/eds/spx.hpp"

namespace meltproof::validation {
namespace {

struct Point {
  std::filesystem::path file;
  double position = 0;
};

LineScan line_of(const std::filesystem::path& path, const std::vector<Point>& points) {
  LineScan scan;
  scan.path = path;
  std::vector<PointComposition> compositions;
  for (const auto& point : points) {
    const auto content = read_spx(point.file);
    if (!content.composition) {
      throw InputError(fmt::format(
          "{}: the spectrum was saved without a quantification: quantify it in Esprit and save it "
          "again.",
          point.file.string()));
    }
    if (!scan.position.empty() && !(point.position > scan.position.back())) {
      throw InputError(fmt::format(
          "{}: {} stands at {:.4g} um, not beyond the point before it: expected the points in the "
          "order of the line.",
          path.string(), point.file.filename().string(), 1e6 * point.position));
    }
    scan.position.push_back(point.position);
    compositions.push_back(*content.composition);
    for (const auto& [symbol, value] : compositions.back().mass) {
      scan.elements[symbol];
    }
  }
  for (auto& [symbol, profile] : scan.elements) {
    const bool counted = std::all_of(
        compositions.begin(), compositions.end(),
        [&, &name = symbol](const PointComposition& p) { return p.counts.contains(name); });
    for (const auto& point : compositions) {
      // An element that a spectrum was not quantified for was not found in it.
      const auto at = point.mass.find(symbol);
      profile.fraction.push_back(at == point.mass.end() ? 0 : at->second);
      if (counted) {
        profile.counts.push_back(point.counts.at(symbol));
        profile.background.push_back(point.background.at(symbol));
      }
    }
  }
  for (const auto& point : points) {
    if (point.file != path) {
      scan.sources.push_back(point.file);
    }
  }
  scan.voltage = compositions.front().voltage;
  check_totals(scan);
  return scan;
}

/// The digits of a name as one number, so that point 10 follows point 9.
std::pair<std::string, unsigned long long> natural(const std::filesystem::path& path) {
  std::string letters, digits;
  for (const char c : path.stem().string()) {
    (std::isdigit(static_cast<unsigned char>(c)) != 0 ? digits : letters) += c;
  }
  return {letters, digits.empty() ? 0 : std::stoull(digits.substr(0, 18))};
}

}  // namespace

bool is_point_list(std::string_view first_bytes) {
  for (const auto& line : lines_of(std::string(first_bytes))) {
    if (!line.starts_with('#') && !trimmed(line).empty()) {
      const auto cells = split_cells(lower(line), ',');
      return cells.size() == 2 && cells[0] == "file" && cells[1].starts_with("position");
    }
  }
  return false;
}

LineScan read_point_list(const std::filesystem::path& path) {
  const auto lines = lines_of(read_file(path));
  std::vector<Point> points;
  std::string unit;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with('#') || trimmed(lines[i]).empty()) {
      continue;
    }
    const auto cells = split_cells(lines[i], ',');
    if (unit.empty()) {
      unit = parse_header(cells.back()).unit;
      if (unit.empty()) {
        throw InputError(fmt::format(
            "{}:{}: the position has no unit: expected the header \"file,position [um]\".",
            path.string(), i + 1));
      }
      continue;
    }
    const auto position = cells.size() == 2 ? number_of(cells[1]) : std::nullopt;
    if (!position) {
      throw InputError(fmt::format("{}:{}: \"{}\" is no file and its position.", path.string(),
                                   i + 1, lines[i].substr(0, 60)));
    }
    points.push_back({path.parent_path() / cells[0], convert_unit(*position, unit, "m")});
  }
  if (points.empty()) {
    throw InputError(fmt::format("{}: it names no spectrum.", path.string()));
  }
  return line_of(path, points);
}

std::vector<std::filesystem::path> spectra_of_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && lower(entry.path().extension().string()) == ".spx") {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    throw InputError(fmt::format("{}: the folder holds no spectrum (.spx).", folder.string()));
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return natural(a) < natural(b); });
  return files;
}

LineScan read_point_folder(const std::filesystem::path& folder, double spacing) {
  if (!(spacing > 0)) {
    throw InputError(fmt::format("{}: points {} um apart are no line: expected a positive spacing.",
                                 folder.string(), 1e6 * spacing));
  }
  std::vector<Point> points;
  for (const auto& file : spectra_of_folder(folder)) {
    points.push_back({file, spacing * static_cast<double>(points.size())});
  }
  return line_of(folder, points);
}

LineScan read_single_point(const std::filesystem::path& path) { return line_of(path, {{path, 0}}); }

}  // namespace meltproof::validation
