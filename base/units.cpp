// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/units.hpp"

#include <charconv>
#include <cstdio>
#include <memory>
#include <mutex>

#include <fmt/format.h>
#include <udunits2.h>

#include "base/error.hpp"

namespace meltproof {
namespace {

using UnitHandle = std::unique_ptr<ut_unit, decltype(&ut_free)>;

/// udunits2 keeps global state, so one system serves all and calls are serialised.
std::mutex& unit_mutex() {
  static std::mutex mutex;
  return mutex;
}

ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    return ut_read_xml(nullptr);
  }();
  if (system == nullptr) {
    throw std::runtime_error(
        "the unit database of udunits2 cannot be read: is libudunits2-data installed?");
  }
  return system;
}

UnitHandle parse_unit(const std::string& name) {
  UnitHandle unit{ut_parse(unit_system(), name.c_str(), UT_UTF8), &ut_free};
  if (!unit) {
    throw InputError(fmt::format("\"{}\" is no unit that udunits2 knows", name));
  }
  return unit;
}

/// "W" for power, "a pure number" for "1": how a unit is named in a sentence.
std::string unit_words(const std::string& unit) {
  return unit == "1" ? "a pure number" : "a quantity in " + unit;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

double convert_unit(double value, const std::string& from, const std::string& to) {
  if (from == to) {
    return value;
  }
  const std::lock_guard lock(unit_mutex());
  const UnitHandle source = parse_unit(from);
  const UnitHandle target = parse_unit(to);
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter{
      ut_get_converter(source.get(), target.get()), &cv_free};
  if (!converter) {
    throw InputError(
        fmt::format("\"{}\" has the wrong dimension: expected {}", from, unit_words(to)));
  }
  return cv_convert_double(converter.get(), value);
}

double parse_quantity(std::string_view text, const std::string& unit) {
  const std::string_view body = trimmed(text);
  double value = 0;
  // from_chars takes no leading '+', which people write.
  const std::string_view digits = body.starts_with('+') ? body.substr(1) : body;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem != std::errc()) {
    throw InputError(
        fmt::format("\"{}\" does not begin with a number: expected {}, for example \"1.5{}\"", text,
                    unit_words(unit), unit == "1" ? "" : " " + unit));
  }
  const std::string given(trimmed(
      std::string_view(end, static_cast<std::size_t>(digits.data() + digits.size() - end))));
  if (given.empty()) {
    if (unit == "1") {
      return value;
    }
    throw InputError(fmt::format("\"{}\" has no unit: expected {}, for example \"{} {}\"", text,
                                 unit_words(unit), shortest(value), unit));
  }
  return convert_unit(value, given, unit);
}

std::string shortest(double value) { return fmt::format("{}", value); }

}  // namespace meltproof
