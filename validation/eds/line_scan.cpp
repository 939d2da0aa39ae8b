// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/line_scan.hpp"

#include <algorithm>
#include <cctype>
#include <functional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/eds/composition.hpp"
#include "validation/eds/exported_table.hpp"

namespace meltproof::validation {
namespace {

bool contains(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// Metres per unit of a position, by its header; nothing if it names none.
std::optional<double> length_unit(const std::string& header) {
  std::string word;
  std::optional<double> unit;
  for (const char c : lower(header) + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
      continue;
    }
    unit = word == "nm" ? 1e-9 : word == "um" ? 1e-6 : word == "mm" ? 1e-3 : unit;
    word.clear();
  }
  return unit;
}

/// The element that a header names: its first word that is a symbol; empty if there is none.
std::string element_of(const std::string& header) {
  std::string word;
  for (const char c : header + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
    } else if (!word.empty()) {
      if (is_element(word)) {
        return word;
      }
      word.clear();
    }
  }
  return "";
}

enum class Kind { none, mass, atom };

Kind kind_of(const std::string& text) {
  if (contains(text, {"wt%", "wt.%", "wt %", "wt. %", "weight", "mass"})) {
    return Kind::mass;
  }
  return contains(text, {"at%", "at.%", "at %", "at. %", "atom"}) ? Kind::atom : Kind::none;
}

struct Column {
  std::size_t index;
  std::string header, element;
  Kind kind;
  bool total, uncertainty;
};

std::vector<Column> fraction_columns(const ExportedTable& table, std::size_t position) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const std::string words = lower(table.header[i]);
    if (i == position || contains(words, {"count", "cps", "intens"})) {
      continue;
    }
    Kind kind = kind_of(words);
    kind = kind == Kind::none ? kind_of(table.preamble) : kind;
    Column column{i,
                  table.header[i],
                  element_of(table.header[i]),
                  kind,
                  contains(words, {"total", "sum"}),
                  contains(words, {"sigma", "error", "uncert", "+/-", "std"})};
    if (!column.element.empty() || column.total) {
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

std::vector<double> share(const ExportedTable& table, std::size_t column) {
  std::vector<double> values;
  for (const auto& row : table.rows) {
    values.push_back(row[column] / 100);
  }
  return values;
}

void read_positions(const ExportedTable& table, LineScan& scan, std::size_t& column) {
  const std::string place = scan.path.string();
  const auto at = std::find_if(table.header.begin(), table.header.end(), [](const auto& header) {
    return contains(lower(header), {"distance", "position", "length"}) ||
           lower(header).starts_with("x ");
  });
  if (at == table.header.end()) {
    throw InputError(fmt::format(
        "{}: no column is a position: expected a header with \"Distance\" or \"Position\" and its "
        "unit.",
        place));
  }
  const auto unit = length_unit(*at);
  if (!unit) {
    throw InputError(fmt::format(
        "{}: the column \"{}\" has no unit: expected nm, um or mm in its header.", place, *at));
  }
  column = static_cast<std::size_t>(at - table.header.begin());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    scan.position.push_back(table.rows[i][column] * *unit);
    if (i > 0 && scan.position[i] <= scan.position[i - 1]) {
      throw InputError(fmt::format(
          "{}:{}: the position does not increase: expected the points in the order of the line.",
          place, table.first_line + i));
    }
  }
}

ConcentrationProfile profile_of(const LineScan& scan, const std::string& symbol,
                                const std::function<double(double)>& concentration) {
  const auto element = scan.elements.find(symbol);
  if (element == scan.elements.end()) {
    throw InputError(fmt::format("{}: the line scan holds no {}: expected a column \"{} wt%\".",
                                 scan.path.string(), symbol, symbol));
  }
  ConcentrationProfile result;
  result.position = scan.position;
  const double slope = concentration(1) - concentration(0);
  for (std::size_t i = 0; i < scan.position.size(); ++i) {
    const double reported = element->second.fraction[i];
    double mass = reported;
    if (scan.of_atoms) {
      ElementFractions atoms;
      for (const auto& [name, profile] : scan.elements) {
        atoms[name] = profile.fraction[i];
      }
      mass = mass_from_atom(atoms).at(symbol);
    }
    result.concentration.push_back(concentration(mass));
    if (!element->second.uncertainty.empty()) {
      // The relative uncertainty of at% is carried over to wt%.
      const double u = element->second.uncertainty[i];
      const double scale = scan.of_atoms && reported > 0 ? mass / reported : 1.0;
      result.uncertainty.push_back(u * scale * slope);
    }
  }
  return result;
}

}  // namespace

LineScan read_line_scan(const std::filesystem::path& path) {
  const ExportedTable table = read_exported_table(path);
  LineScan scan;
  scan.path = path;
  std::size_t position = 0;
  read_positions(table, scan, position);
  const auto columns = fraction_columns(table, position);
  const auto has = [&](Kind kind) {
    return std::any_of(columns.begin(), columns.end(), [kind](const Column& c) {
      return c.kind == kind && !c.element.empty() && !c.uncertainty;
    });
  };
  if (!has(Kind::mass) && !has(Kind::atom)) {
    throw InputError(
        path.string() +
        (has(Kind::none)
             ? ": neither the header nor the lines above it say whether these are wt% or at%: "
               "expected, for example, \"Al Wt%\"."
             : ": no column names an element: expected, for example, \"Al Wt%\"."));
  }
  const Kind kind = has(Kind::mass) ? Kind::mass : Kind::atom;
  scan.of_atoms = kind == Kind::atom;
  for (const auto& column : columns) {
    if (column.kind != kind) {
      continue;
    }
    if (column.total) {
      scan.total = share(table, column.index);
    } else if (column.uncertainty) {
      scan.elements[column.element].uncertainty = share(table, column.index);
    } else {
      scan.elements[column.element].fraction = share(table, column.index);
    }
  }
  std::erase_if(scan.elements, [](const auto& entry) { return entry.second.fraction.empty(); });
  if (scan.total.empty()) {
    scan.total.assign(scan.position.size(), 0);
    for (const auto& [symbol, profile] : scan.elements) {
      for (std::size_t i = 0; i < scan.total.size(); ++i) {
        scan.total[i] += profile.fraction[i];
      }
    }
  }
  for (std::size_t i = 0; i < scan.total.size(); ++i) {
    if (scan.total[i] < 0.95 || scan.total[i] > 1.05) {
      scan.flagged.push_back(i);
    }
  }
  return scan;
}

ConcentrationProfile concentration_from_aluminium(const LineScan& scan) {
  return profile_of(scan, "Al", [](double mass) { return concentration_from_aluminium(mass); });
}

ConcentrationProfile concentration_from_silicon(const LineScan& scan, double silicon_of_base) {
  return profile_of(scan, "Si", [silicon_of_base](double mass) {
    return concentration_from_silicon(mass, silicon_of_base);
  });
}

}  // namespace meltproof::validation
