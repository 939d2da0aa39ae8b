// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of a result as JSON: what is not known is null.
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include <nlohmann/json.hpp>

namespace meltproof::validation {

inline nlohmann::json number_json(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

inline nlohmann::json number_json(const std::optional<double>& value) {
  return value ? number_json(*value) : nlohmann::json();
}

inline nlohmann::json numbers_json(std::span<const double> values, double scale = 1) {
  auto list = nlohmann::json::array();
  for (const double value : values) {
    list.push_back(number_json(scale * value));
  }
  return list;
}

/// Lengths in um.
inline nlohmann::json micrometres_json(std::span<const double> lengths) {
  return numbers_json(lengths, 1e6);
}

/// A list of `length` entries, or as many nulls where nothing is known.
inline nlohmann::json filled_json(std::span<const double> values, std::size_t length) {
  return values.empty() ? nlohmann::json(length, nlohmann::json()) : numbers_json(values);
}

}  // namespace meltproof::validation
