// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/provenance.hpp"
#include "base/units.hpp"
#include "validation/csv.hpp"

namespace meltproof::validation {
namespace {

void check_header(const DataFile& file, const std::vector<std::string>& header) {
  const std::string place = file.path.string();
  std::vector<ColumnHeader> found(header.size());
  std::transform(header.begin(), header.end(), found.begin(), parse_header);
  for (const auto& column : file.columns) {
    const auto at = std::find_if(found.begin(), found.end(),
                                 [&](const ColumnHeader& h) { return h.name == column.name; });
    if (at == found.end()) {
      throw InputError(fmt::format(
          "{}: dataset.toml declares a column \"{}\" that the header does not have: {}.", place,
          column.name, fmt::join(header, ", ")));
    }
    const std::string expected = column.is_text() ? "" : column.unit;
    if (at->unit != expected) {
      const auto shown = [](const std::string& unit) {
        return unit.empty() ? std::string("no unit") : "[" + unit + "]";
      };
      throw InputError(
          fmt::format("{}: column \"{}\" has {} in the header where dataset.toml declares {}.",
                      place, column.name, shown(at->unit), shown(expected)));
    }
    const auto index = static_cast<std::size_t>(at - found.begin());
    if (index >= file.columns.size() || file.columns[index].name != column.name) {
      throw InputError(
          fmt::format("{}: column \"{}\" stands at another place in the header than in "
                      "dataset.toml: write both in the same order.",
                      place, column.name));
    }
  }
  if (found.size() != file.columns.size()) {
    throw InputError(fmt::format("{}: the header has {} columns, dataset.toml declares {}.", place,
                                 found.size(), file.columns.size()));
  }
}

void read_table(DataFile& file) {
  const std::string place = file.path.string();
  bool has_header = false;
  std::size_t number = 0;
  for (const auto& line : lines_of(read_file(file.path))) {
    ++number;
    if (trimmed(line).empty() || line.starts_with('#')) {
      continue;
    }
    const auto cells = split_cells(line, ',');
    if (!has_header) {
      check_header(file, cells);
      has_header = true;
      continue;
    }
    if (cells.size() != file.columns.size()) {
      throw InputError(fmt::format("{}:{}: found {} cells where the header has {}.", place, number,
                                   cells.size(), file.columns.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      auto& column = file.columns[i];
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!column.is_text() && !cells[i].empty()) {
        const auto parsed = number_of(cells[i]);
        if (!parsed || !std::isfinite(*parsed)) {
          throw InputError(fmt::format("{}:{}: \"{}\" in column \"{}\" is no number.", place,
                                       number, cells[i], column.name));
        }
        value = *parsed;
      }
      column.cells.push_back(cells[i]);
      column.numbers.push_back(value);
    }
  }
  if (!has_header) {
    throw InputError(fmt::format("{}: there is no header line.", place));
  }
}

/// A slot that waits for its numbers must not hold some: the columns with a declared uncertainty
/// are the measured ones.
void check_pending(const DataFile& file) {
  if (file.obtained != "pending") {
    return;
  }
  for (const auto& column : file.columns) {
    const bool filled = std::any_of(column.numbers.begin(), column.numbers.end(),
                                    [](double value) { return !std::isnan(value); });
    if (!column.uncertainty.empty() && filled) {
      throw InputError(fmt::format(
          "{}: column \"{}\" holds values although dataset.toml says \"pending\": say how they "
          "were obtained (measured or digitised).",
          file.path.string(), column.name));
    }
  }
}

void read_data_file(DataFile& file, const std::filesystem::path& folder) {
  file.path = folder / file.name;
  const std::string place = (folder / "dataset.toml").string();
  if (!std::filesystem::is_regular_file(file.path)) {
    throw InputError(fmt::format(
        "{}: the file {} that it names is missing: restore it, or take its [[file]] table out.",
        place, file.path.string()));
  }
  const std::string found = sha256_file(file.path);
  if (found != file.sha256) {
    throw InputError(fmt::format(
        "{}: its SHA-256 is {}, dataset.toml has {}: the numbers are not those that were checked "
        "in. Restore the file, or, if the change is meant, renew the checksum.",
        file.path.string(), found, file.sha256));
  }
  for (const auto& column : file.columns) {
    if (!column.is_text()) {
      // Equal names convert without a look at the unit, hence the second, equivalent one.
      try {
        convert_unit(1.0, column.unit, column.unit + " 1");
      } catch (const InputError& problem) {
        throw InputError(fmt::format("{}: column \"{}\" of {}: {}.", place, column.name, file.name,
                                     problem.what()));
      }
    }
    if (!column.uncertainty.empty()) {
      file.column(column.uncertainty);
    }
  }
  read_table(file);
  check_pending(file);
}

}  // namespace

const DataColumn& DataFile::column(const std::string& wanted) const {
  std::vector<std::string> names;
  for (const auto& column : columns) {
    if (column.name == wanted) {
      return column;
    }
    names.push_back(column.name);
  }
  throw InputError(fmt::format("{}: there is no column \"{}\"; there are {}.", path.string(),
                               wanted, fmt::join(names, ", ")));
}

std::size_t DataFile::row(const std::vector<std::string>& conditions) const {
  std::vector<std::size_t> matches;
  for (std::size_t i = 0; i < rows(); ++i) {
    const bool all = std::all_of(conditions.begin(), conditions.end(), [&](const auto& condition) {
      const auto equals = condition.find('=');
      if (equals == std::string::npos) {
        throw InputError(
            fmt::format("the row selector \"{}\" is none: expected \"column = value\"", condition));
      }
      const auto& where = column(trimmed(condition.substr(0, equals)));
      const std::string value = trimmed(condition.substr(equals + 1));
      if (where.is_text()) {
        return where.cells[i] == value;
      }
      const auto number = number_of(value);
      return number && *number == where.numbers[i];
    });
    if (all) {
      matches.push_back(i);
    }
  }
  if (matches.size() != 1) {
    throw InputError(fmt::format("{}: {} rows match \"{}\": expected exactly one.", path.string(),
                                 matches.size(), fmt::join(conditions, ", ")));
  }
  return matches.front();
}

const DataFile& Campaign::file(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& candidate : files) {
    if (candidate.name == name) {
      return candidate;
    }
    names.push_back(candidate.name);
  }
  throw InputError(fmt::format("{}: it declares no file \"{}\"; it has {}.",
                               (folder / "dataset.toml").string(), name, fmt::join(names, ", ")));
}

std::vector<std::filesystem::path> Campaign::paths() const {
  std::vector<std::filesystem::path> paths = {folder / "dataset.toml"};
  for (const auto& file : files) {
    paths.push_back(file.path);
  }
  return paths;
}

Campaign read_campaign(const std::filesystem::path& folder) {
  Campaign campaign;
  campaign.folder = folder;
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(fmt::format("there is no campaign {}: expected a folder with dataset.toml.",
                                 folder.string()));
  }
  campaign_input(campaign).read(folder / "dataset.toml");
  for (auto& file : campaign.files) {
    read_data_file(file, folder);
  }
  return campaign;
}

Datum datum(const DataFile& file, const std::string& column, std::size_t row) {
  const auto& values = file.column(column);
  Datum result;
  result.unit = values.unit;
  if (values.is_text()) {
    throw InputError(
        fmt::format("{}: column \"{}\" holds labels, not numbers.", file.path.string(), column));
  }
  if (std::isnan(values.numbers.at(row))) {
    return result;
  }
  result.value = values.numbers[row];
  double square = 0;
  bool known = false;
  if (!values.uncertainty.empty()) {
    const auto& with = file.column(values.uncertainty);
    if (!std::isnan(with.numbers[row])) {
      square += std::pow(convert_unit(with.numbers[row], with.unit, values.unit), 2);
      known = true;
    }
  }
  if (values.relative_uncertainty) {
    square += std::pow(*values.relative_uncertainty * *result.value, 2);
    known = true;
  }
  if (known) {
    result.uncertainty = std::sqrt(square);
  }
  return result;
}

}  // namespace meltproof::validation
