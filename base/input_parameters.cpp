// SPDX-License-Identifier: GPL-3.0-or-later
// How each kind of parameter is read, printed and described.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/input_table.hpp"
#include "base/units.hpp"

namespace meltproof {
namespace {

std::string toml_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c == '\n' ? ' ' : c;
  }
  return result + "\"";
}

std::string printed_quantity(double value, const std::string& unit) {
  return unit == "1" ? shortest(value) : toml_text(shortest(value) + " " + unit);
}

std::string bounds_words(const Quantity& q) {
  const bool low = std::isfinite(q.minimum), high = std::isfinite(q.maximum);
  if (low && high) {
    return fmt::format("{} to {}", shortest(q.minimum), shortest(q.maximum));
  }
  return low ? "at least " + shortest(q.minimum) : high ? "at most " + shortest(q.maximum) : "";
}

double read_quantity(const toml::node& node, const std::string& key, const Quantity& q,
                     const Place& place) {
  double value = 0;
  if (const auto text = node.value<std::string>()) {
    try {
      value = parse_quantity(*text, q.unit);
    } catch (const InputError& problem) {
      place.refuse(key, &node, problem.what());
    }
  } else if (node.is_number()) {
    value = node.value<double>().value_or(0);
    if (q.unit != "1") {
      place.refuse(
          key, &node,
          fmt::format("{} has no unit: write it as text with its unit, for example \"{} {}\"",
                      shortest(value), shortest(value), q.unit));
    }
  } else {
    place.refuse(key, &node,
                 "expected a number with its unit as text, for example \"1 " + q.unit + "\"");
  }
  if (!(value >= q.minimum && value <= q.maximum)) {
    place.refuse(
        key, &node,
        fmt::format("{} {} is out of bounds: expected {} {}", shortest(value),
                    q.unit == "1" ? "" : q.unit, bounds_words(q), q.unit == "1" ? "" : q.unit));
  }
  return value;
}

nlohmann::json quantity_schema(const Quantity& q) {
  if (q.unit != "1") {
    return {{"type", "string"}, {"x-unit", q.unit}};
  }
  nlohmann::json number = {{"type", nlohmann::json::array({"number", "string"})}};
  if (std::isfinite(q.minimum)) {
    number["minimum"] = q.minimum;
  }
  if (std::isfinite(q.maximum)) {
    number["maximum"] = q.maximum;
  }
  return number;
}

}  // namespace

InputTable& InputTable::quantity(double& target, Quantity q) {
  return body_->add(*this,
                    {.name = q.name,
                     .about = q.about,
                     .unit = q.unit,
                     .bounds = bounds_words(q),
                     .fallback = "",
                     .required = q.required,
                     .read = [&target, q](const toml::node& n, const std::string& key,
                                          const Place& p) { target = read_quantity(n, key, q, p); },
                     .print = [&target, q] { return printed_quantity(target, q.unit); },
                     .schema = quantity_schema(q)});
}

InputTable& InputTable::quantity(std::optional<double>& target, Quantity q) {
  return body_->add(
      *this, {.name = q.name,
              .about = q.about,
              .unit = q.unit,
              .bounds = bounds_words(q),
              .fallback = "",
              .required = q.required,
              .read = [&target, q](const toml::node& n, const std::string& key,
                                   const Place& p) { target = read_quantity(n, key, q, p); },
              .print = [&target, q] { return target ? printed_quantity(*target, q.unit) : ""; },
              .schema = quantity_schema(q)});
}

InputTable& InputTable::quantities(std::vector<double>& target, Quantity q) {
  auto read = [&target, q](const toml::node& n, const std::string& key, const Place& p) {
    const auto* list = n.as_array();
    if (list == nullptr) {
      p.refuse(key, &n, "expected a list, for example [" + printed_quantity(1, q.unit) + "]");
    }
    std::vector<double> values;
    for (const auto& item : *list) {
      values.push_back(read_quantity(item, fmt::format("{}[{}]", key, values.size()), q, p));
    }
    target = std::move(values);
  };
  auto print = [&target, q] {
    std::vector<std::string> items;
    for (const double value : target) {
      items.push_back(printed_quantity(value, q.unit));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
  };
  return body_->add(*this, {.name = q.name,
                            .about = q.about,
                            .unit = "list of " + q.unit,
                            .bounds = bounds_words(q),
                            .fallback = "",
                            .required = q.required,
                            .read = read,
                            .print = print,
                            .schema = {{"type", "array"}, {"items", quantity_schema(q)}}});
}

InputTable& InputTable::whole(long long& target, Entry e) {
  auto read = [&target, e](const toml::node& n, const std::string& key, const Place& p) {
    const auto value = n.is_integer() ? n.value<std::int64_t>() : std::nullopt;
    if (!value) {
      p.refuse(key, &n, "expected a whole number");
    }
    if (*value < e.minimum || *value > e.maximum) {
      p.refuse(key, &n,
               fmt::format("{} is out of bounds: expected {} to {}", *value, e.minimum, e.maximum));
    }
    target = *value;
  };
  std::string bounds;
  if (e.minimum != std::numeric_limits<long long>::min()) {
    bounds = fmt::format("at least {}", e.minimum);
  }
  return body_->add(*this, {.name = e.name,
                            .about = e.about,
                            .unit = "whole number",
                            .bounds = bounds,
                            .fallback = "",
                            .required = e.required,
                            .read = read,
                            .print = [&target] { return fmt::format("{}", target); },
                            .schema = {{"type", "integer"}}});
}

InputTable& InputTable::flag(bool& target, Entry e) {
  auto read = [&target](const toml::node& n, const std::string& key, const Place& p) {
    if (!n.is_boolean()) {
      p.refuse(key, &n, "expected true or false");
    }
    target = n.value<bool>().value_or(false);
  };
  return body_->add(*this, {.name = e.name,
                            .about = e.about,
                            .unit = "true/false",
                            .bounds = "",
                            .fallback = "",
                            .required = e.required,
                            .read = read,
                            .print = [&target] { return std::string(target ? "true" : "false"); },
                            .schema = {{"type", "boolean"}}});
}

InputTable& InputTable::text(std::string& target, Entry e) {
  auto read = [&target, e](const toml::node& n, const std::string& key, const Place& p) {
    const auto value = n.value<std::string>();
    if (!n.is_string() || !value) {
      p.refuse(key, &n, "expected a text in quotes");
    }
    if (!e.choices.empty() &&
        std::find(e.choices.begin(), e.choices.end(), *value) == e.choices.end()) {
      p.refuse(
          key, &n,
          fmt::format("\"{}\" is none of the choices: {}", *value, fmt::join(e.choices, ", ")));
    }
    target = *value;
  };
  nlohmann::json schema = {{"type", "string"}};
  if (!e.choices.empty()) {
    schema["enum"] = e.choices;
  }
  return body_->add(*this, {.name = e.name,
                            .about = e.about,
                            .unit = "text",
                            .bounds = fmt::format("{}", fmt::join(e.choices, ", ")),
                            .fallback = "",
                            .required = e.required,
                            .read = read,
                            .print = [&target] { return toml_text(target); },
                            .schema = schema});
}

InputTable& InputTable::texts(std::vector<std::string>& target, Entry e) {
  auto read = [&target, e](const toml::node& n, const std::string& key, const Place& p) {
    const auto* list = n.as_array();
    if (list == nullptr) {
      p.refuse(key, &n, "expected a list of texts, for example [\"a\", \"b\"]");
    }
    std::vector<std::string> values;
    for (const auto& item : *list) {
      if (!item.is_string()) {
        p.refuse(key, &item, "expected a list of texts, for example [\"a\", \"b\"]");
      }
      values.push_back(item.value<std::string>().value_or(""));
    }
    target = std::move(values);
  };
  auto print = [&target] {
    std::vector<std::string> items;
    for (const auto& value : target) {
      items.push_back(toml_text(value));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
  };
  nlohmann::json schema = {{"type", "array"}};
  schema["items"] = nlohmann::json{{"type", "string"}};
  return body_->add(*this, {.name = e.name,
                            .about = e.about,
                            .unit = "list of texts",
                            .bounds = "",
                            .fallback = "",
                            .required = e.required,
                            .read = read,
                            .print = print,
                            .schema = schema});
}

InputTable& InputTable::file(std::filesystem::path& target, Entry e) {
  auto read = [&target](const toml::node& n, const std::string& key, const Place& p) {
    const auto value = n.value<std::string>();
    if (!n.is_string() || !value) {
      p.refuse(key, &n, "expected a file name in quotes");
    }
    target.clear();
    if (value->empty()) {
      return;
    }
    // What stands in the file is relative to it; what was typed is relative to where it was typed.
    const std::filesystem::path given =
        p.overridden.contains(key) ? std::filesystem::path(*value) : p.folder / *value;
    if (!std::filesystem::is_regular_file(given)) {
      p.refuse(
          key, &n,
          fmt::format(
              "there is no file {}: expected an existing file{}", given.string(),
              p.overridden.contains(key) ? "" : ", named relative to the folder of the input"));
    }
    target = given.lexically_normal();
    if (p.files != nullptr) {
      p.files->push_back(target);
    }
  };
  return body_->add(*this, {.name = e.name,
                            .about = e.about,
                            .unit = "file",
                            .bounds = "",
                            .fallback = "",
                            .required = e.required,
                            .read = read,
                            .print = [&target] { return toml_text(target.string()); },
                            .schema = {{"type", "string"}}});
}

}  // namespace meltproof
