// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/csv_export.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "validation/csv.hpp"
#include "validation/eds/column_words.hpp"
#include "validation/eds/exported_table.hpp"

namespace meltproof::validation {
namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::size_t find_column(const ExportedTable& table,
                        const std::function<bool(const std::string&)>& fits) {
  const auto at = std::find_if(table.header.begin(), table.header.end(),
                               [&](const std::string& header) { return fits(lower(header)); });
  return at == table.header.end() ? nowhere : static_cast<std::size_t>(at - table.header.begin());
}

double unit_of(const ExportedTable& table, const std::string& place, std::size_t column) {
  const auto unit = length_unit_named_in(table.header[column]);
  if (!unit) {
    throw InputError(fmt::format(
        "{}: the column \"{}\" has no unit of length: expected nm, um or mm in its header.", place,
        table.header[column]));
  }
  return *unit;
}

/// The way along columns x and y, or nothing if they are not there.
std::vector<double> way_along(const ExportedTable& table, const std::string& place) {
  const auto axis = [&](const std::string& name) {
    return find_column(table, [&](const std::string& header) {
      return header.starts_with(name + " ") || header.starts_with(name + "(") ||
             header.starts_with(name + "[");
    });
  };
  const std::size_t x = axis("x"), y = axis("y");
  std::vector<double> position;
  if (x == nowhere) {
    return position;
  }
  const double unit_x = unit_of(table, place, x);
  const double unit_y = y == nowhere ? 0 : unit_of(table, place, y);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    if (y == nowhere) {
      position.push_back(row[x] * unit_x);
    } else if (i == 0) {
      position.push_back(0);
    } else {
      const auto& last = table.rows[i - 1];
      position.push_back(position.back() +
                         std::hypot(unit_x * (row[x] - last[x]), unit_y * (row[y] - last[y])));
    }
  }
  return position;
}

void read_positions(const ExportedTable& table, LineScan& scan) {
  const std::string place = scan.path.string();
  const std::size_t column = find_column(table, [](const std::string& header) {
    for (const char* word : {"distance", "position", "length", "abstand"}) {
      if (header.find(word) != std::string::npos) {
        return true;
      }
    }
    return false;
  });
  if (column == nowhere) {
    scan.position = way_along(table, place);
    if (scan.position.empty()) {
      throw InputError(fmt::format(
          "{}: no column is a position: expected a header with \"Distance\" or \"Position\" and "
          "its unit.",
          place));
    }
  } else {
    const double unit = unit_of(table, place, column);
    for (const auto& row : table.rows) {
      scan.position.push_back(row[column] * unit);
    }
  }
  for (std::size_t i = 1; i < scan.position.size(); ++i) {
    if (!(scan.position[i] > scan.position[i - 1])) {
      throw InputError(fmt::format(
          "{}:{}: the position does not increase: expected the points in the order of the line.",
          place, table.first_line + i));
    }
  }
}

std::vector<double> values(const ExportedTable& table, std::size_t column, double factor) {
  std::vector<double> result;
  for (const auto& row : table.rows) {
    result.push_back(row[column] * factor);
  }
  return result;
}

/// A concentration of AlSi10Mg that the file states itself.
bool read_alloy(const ExportedTable& table, LineScan& scan) {
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const ColumnWords words = read_column_header(table.header[i]);
    if (words.role != Role::alloy && words.role != Role::alloy_uncertainty) {
      continue;
    }
    if (words.unit != "%" && words.unit != "1") {
      throw InputError(fmt::format(
          "{}: the column \"{}\" has {}: expected the mass fraction of AlSi10Mg in [%] or [1].",
          scan.path.string(), table.header[i],
          words.unit.empty() ? "no unit" : "the unit \"" + words.unit + "\""));
    }
    if (!scan.alloy) {
      scan.alloy.emplace();
    }
    auto& list = words.role == Role::alloy ? scan.alloy->fraction : scan.alloy->uncertainty;
    list = values(table, i, words.unit == "%" ? 0.01 : 1);
  }
  if (scan.alloy && scan.alloy->fraction.empty()) {
    throw InputError(fmt::format(
        "{}: there is an uncertainty of a concentration but no concentration: expected a column "
        "\"concentration [%]\".",
        scan.path.string()));
  }
  return scan.alloy.has_value();
}

std::vector<ColumnWords> understand(const ExportedTable& table, LineScan& scan) {
  const Share above = share_named_in(table.preamble);
  std::vector<ColumnWords> columns;
  std::string odd;
  for (const auto& header : table.header) {
    ColumnWords words = read_column_header(header);
    words.share = words.share == Share::none ? above : words.share;
    if (words.role == Role::fraction && words.share == Share::unknown) {
      odd = fmt::format("the column \"{}\" is in \"{}\", which is neither wt% nor at%", header,
                        words.unit);
      scan.remarks.push_back(odd + ": it is passed over.");
    }
    columns.push_back(std::move(words));
  }
  const auto has = [&](Share share) {
    return std::any_of(columns.begin(), columns.end(), [share](const ColumnWords& c) {
      return c.role == Role::fraction && c.share == share;
    });
  };
  if (!has(Share::mass) && !has(Share::atom)) {
    throw InputError(
        scan.path.string() + ": " +
        (!odd.empty() ? odd + ": export the line scan as wt% or at%."
         : has(Share::none)
             ? "neither the header nor the lines above it say whether these are wt% or at%: "
               "expected, for example, \"Al Wt%\"."
             : "no column names an element: expected, for example, \"Al Wt%\"."));
  }
  scan.of_atoms = !has(Share::mass);
  return columns;
}

void read_elements(const ExportedTable& table, const std::vector<ColumnWords>& columns,
                   LineScan& scan) {
  const Share wanted = scan.of_atoms ? Share::atom : Share::mass;
  const bool unnormalised = std::any_of(columns.begin(), columns.end(), [&](const ColumnWords& c) {
    return c.role == Role::fraction && c.share == wanted && !c.normalised;
  });
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnWords& words = columns[i];
    if (words.role == Role::fraction && words.share == wanted &&
        !(unnormalised && words.normalised)) {
      auto& fraction = scan.elements[words.element].fraction;
      if (fraction.empty()) {
        fraction = values(table, i, 0.01);
      } else {
        scan.remarks.push_back(
            fmt::format("the column \"{}\" is a second one of {}: it is passed over.",
                        table.header[i], words.element));
      }
    } else if (words.role == Role::total && words.share == wanted) {
      scan.total = values(table, i, 0.01);
    } else if (words.role == Role::counts) {
      scan.elements[words.element].counts = values(table, i, 1);
    } else if (words.role == Role::background) {
      scan.elements[words.element].background = values(table, i, 1);
    }
  }
  std::erase_if(scan.elements, [](const auto& entry) { return entry.second.fraction.empty(); });
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnWords& words = columns[i];
    const auto profile = scan.elements.find(words.element);
    if (words.role != Role::uncertainty || profile == scan.elements.end() ||
        (words.share != wanted && !words.relative && words.share != Share::none)) {
      continue;
    }
    auto u = values(table, i, 0.01 / words.coverage);
    if (words.relative) {
      std::transform(u.begin(), u.end(), profile->second.fraction.begin(), u.begin(),
                     std::multiplies<>());
    }
    profile->second.uncertainty = std::move(u);
  }
}

/// A slot of data/experiments without a point: a header, and no row of numbers yet.
bool is_empty_slot(const std::string& text) {
  for (const auto& line : lines_of(text)) {
    if (!line.starts_with('#') && !trimmed(line).empty()) {
      return lower(line).starts_with("position [") &&
             lower(line).find("concentration [") != std::string::npos &&
             lines_of(text).back() == line;
    }
  }
  return false;
}

}  // namespace

bool is_csv_export(std::string_view first_bytes) {
  return first_bytes.starts_with("\xFF\xFE") ||
         (!first_bytes.empty() && first_bytes.find('\0') == std::string_view::npos);
}

LineScan read_csv_export(const std::filesystem::path& path) {
  LineScan scan;
  scan.path = path;
  if (is_empty_slot(read_file(path))) {
    scan.empty_slot = true;
    scan.alloy.emplace();
    return scan;
  }
  const ExportedTable table = read_exported_table(path);
  std::smatch voltage;
  if (std::regex_search(table.preamble, voltage, std::regex("([0-9]+(?:[.,][0-9]+)?) *kv"))) {
    scan.voltage = number_of(voltage[1], voltage[1].str().find(',') != std::string::npos);
  }
  read_positions(table, scan);
  if (!read_alloy(table, scan)) {
    read_elements(table, understand(table, scan), scan);
  }
  check_totals(scan);
  return scan;
}

}  // namespace meltproof::validation
