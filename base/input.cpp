// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/input.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/units.hpp"

namespace meltproof {
namespace {

/// Where a value stands, for messages and for paths relative to the file.
struct Place {
  std::string origin;            ///< file name as the user gave it
  std::filesystem::path folder;  ///< that relative paths start from
  std::set<std::string> overridden;
  std::vector<std::filesystem::path>* files = nullptr;

  [[noreturn]] void refuse(const std::string& key, const toml::node* node,
                           const std::string& what) const {
    if (overridden.contains(key)) {
      throw InputError(fmt::format("--set {}: {}", key, what));
    }
    const auto line = node != nullptr ? node->source().begin.line : 0;
    throw InputError(line > 0 ? fmt::format("{}:{}: {}: {}", origin, line, key, what)
                              : fmt::format("{}: {}: {}", origin, key, what));
  }
};

std::string joined(const std::string& prefix, const std::string& name) {
  return prefix.empty() ? name : prefix + "." + name;
}

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

/// The number of single-letter edits between two names, to suggest the key that was meant.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
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

/// One declared key: everything else is asked of these closures, bound to the caller's variable.
struct Leaf {
  std::string name, about, unit, bounds, fallback;
  bool required = false;
  std::function<void(const toml::node&, const std::string& key, const Place&)> read;
  std::function<std::string()> print;  ///< the value in TOML; empty: not given
  nlohmann::json schema;
};

}  // namespace

struct InputTable::Body {
  struct Sub {
    InputTable table;
    bool* present;
  };
  struct Many {
    std::string name, about;
    std::function<InputTable(std::size_t)> make;
    bool required;
    std::vector<InputTable> made;
  };
  std::string name, about;
  std::vector<Leaf> leaves;
  std::vector<Sub> subs;
  std::vector<Many> arrays;

  InputTable& add(InputTable& self, Leaf leaf) {
    leaf.fallback = leaf.required || !leaf.print ? "" : leaf.print();
    leaves.push_back(std::move(leaf));
    return self;
  }
  void read(const toml::table& node, const std::string& prefix, const Place& place);
  void print(std::string& out, const std::string& prefix) const;
  nlohmann::json schema() const;
  void reference(std::string& out, const std::string& prefix) const;
  std::vector<std::string> known() const;
};

InputTable::InputTable(std::string name, std::string about) : body_(std::make_unique<Body>()) {
  body_->name = std::move(name);
  body_->about = std::move(about);
}
InputTable::InputTable(InputTable&&) noexcept = default;
InputTable& InputTable::operator=(InputTable&&) noexcept = default;
InputTable::~InputTable() = default;
const std::string& InputTable::name() const { return body_->name; }

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

InputTable& InputTable::table(InputTable declaration, bool* present) {
  body_->subs.push_back({std::move(declaration), present});
  return *this;
}

InputTable& InputTable::tables(std::string name, std::string about,
                               std::function<InputTable(std::size_t)> make, bool required) {
  body_->arrays.push_back({std::move(name), std::move(about), std::move(make), required, {}});
  return *this;
}

std::vector<std::string> InputTable::Body::known() const {
  std::vector<std::string> names;
  for (const auto& leaf : leaves) {
    names.push_back(leaf.name);
  }
  for (const auto& sub : subs) {
    names.push_back(sub.table.name());
  }
  for (const auto& many : arrays) {
    names.push_back(many.name);
  }
  return names;
}

void InputTable::Body::read(const toml::table& node, const std::string& prefix,
                            const Place& place) {
  const auto names = known();
  for (const auto& [key, value] : node) {
    const std::string given(key.str());
    if (std::find(names.begin(), names.end(), given) == names.end()) {
      const auto nearest =
          std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
            return edit_distance(a, given) < edit_distance(b, given);
          });
      const bool close =
          nearest != names.end() && edit_distance(*nearest, given) <= 1 + given.size() / 3;
      place.refuse(joined(prefix, given), &value,
                   close ? fmt::format("unknown key; did you mean \"{}\"?", *nearest)
                         : fmt::format("unknown key; known here: {}", fmt::join(names, ", ")));
    }
  }
  for (const auto& leaf : leaves) {
    const toml::node* value = node.get(leaf.name);
    const std::string key = joined(prefix, leaf.name);
    if (value != nullptr) {
      leaf.read(*value, key, place);
    } else if (leaf.required) {
      place.refuse(key, &node, fmt::format("this key is missing: {} ({})", leaf.about, leaf.unit));
    }
  }
  for (auto& sub : subs) {
    const toml::node* value = node.get(sub.table.name());
    const std::string key = joined(prefix, sub.table.name());
    if (value != nullptr && !value->is_table()) {
      place.refuse(key, value, fmt::format("expected a table [{}]", key));
    }
    if (sub.present != nullptr) {
      *sub.present = value != nullptr;
    }
    // An optional table that is absent asks for nothing; any other one may still miss required
    // keys.
    static const toml::table empty;
    if (value != nullptr || sub.present == nullptr) {
      sub.table.body_->read(value != nullptr ? *value->as_table() : empty, key, place);
    }
  }
  for (auto& many : arrays) {
    const toml::node* value = node.get(many.name);
    const std::string key = joined(prefix, many.name);
    many.made.clear();
    if (value == nullptr) {
      if (many.required) {
        place.refuse(key, &node,
                     fmt::format("at least one [[{}]] is missing: {}", key, many.about));
      }
      continue;
    }
    const auto* list = value->as_array();
    if (list == nullptr || !(list->empty() || list->is_homogeneous<toml::table>())) {
      place.refuse(key, value, fmt::format("expected an array of tables [[{}]]", key));
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      many.made.push_back(many.make(i));
      many.made.back().body_->read(*list->get(i)->as_table(), fmt::format("{}[{}]", key, i), place);
    }
  }
}

void InputTable::Body::print(std::string& out, const std::string& prefix) const {
  for (const auto& leaf : leaves) {
    const std::string value = leaf.print();
    if (!value.empty()) {
      out += fmt::format("{} = {}\n", leaf.name, value);
    }
  }
  for (const auto& sub : subs) {
    if (sub.present == nullptr || *sub.present) {
      const std::string key = joined(prefix, sub.table.name());
      out += fmt::format("\n[{}]\n", key);
      sub.table.body_->print(out, key);
    }
  }
  for (const auto& many : arrays) {
    const std::string key = joined(prefix, many.name);
    for (const auto& item : many.made) {
      out += fmt::format("\n[[{}]]\n", key);
      item.body_->print(out, key);
    }
  }
}

nlohmann::json InputTable::Body::schema() const {
  nlohmann::json properties = nlohmann::json::object(), required = nlohmann::json::array();
  for (const auto& leaf : leaves) {
    auto entry = leaf.schema;
    entry["description"] = leaf.about;
    if (!leaf.fallback.empty()) {
      entry["x-default"] = leaf.fallback;
    }
    if (!leaf.bounds.empty()) {
      entry["x-bounds"] = leaf.bounds;
    }
    properties[leaf.name] = entry;
    if (leaf.required) {
      required.push_back(leaf.name);
    }
  }
  for (const auto& sub : subs) {
    properties[sub.table.name()] = sub.table.body_->schema();
  }
  for (const auto& many : arrays) {
    properties[many.name] = {
        {"type", "array"}, {"description", many.about}, {"items", many.make(0).body_->schema()}};
    if (many.required) {
      required.push_back(many.name);
    }
  }
  return {{"type", "object"},
          {"description", about},
          {"properties", properties},
          {"required", required},
          {"additionalProperties", false}};
}

void InputTable::Body::reference(std::string& out, const std::string& prefix) const {
  out += fmt::format("\n{} {}\n\n{}\n", prefix.empty() ? "#" : "##",
                     prefix.empty() ? name : "`[" + prefix + "]`", about);
  if (!leaves.empty()) {
    out += "\n| key | unit | default | allowed | meaning |\n|---|---|---|---|---|\n";
  }
  for (const auto& leaf : leaves) {
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", leaf.name, leaf.unit,
                       leaf.required           ? "required"
                       : leaf.fallback.empty() ? "-"
                                               : "`" + leaf.fallback + "`",
                       leaf.bounds, leaf.about);
  }
  for (const auto& sub : subs) {
    sub.table.body_->reference(out, joined(prefix, sub.table.name()));
  }
  for (const auto& many : arrays) {
    many.make(0).body_->reference(out, joined(prefix, many.name));
  }
}

struct Input::State {
  InputTable root;
  std::vector<std::filesystem::path> files;

  void read(const std::string& text, Place place, const std::vector<std::string>& overrides);
};

void Input::State::read(const std::string& text, Place place,
                        const std::vector<std::string>& overrides) {
  toml::table table;
  try {
    table = toml::parse(text, place.origin);
  } catch (const toml::parse_error& problem) {
    throw InputError(fmt::format("{}:{}: this is not TOML: {}", place.origin,
                                 problem.source().begin.line, problem.description()));
  }
  for (const auto& override : overrides) {
    const auto equals = override.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(
          fmt::format("--set {}: expected KEY=VALUE, for example laser.power=\"200 W\"", override));
    }
    const std::string key = override.substr(0, equals), value = override.substr(equals + 1);
    toml::table* at = &table;
    std::size_t begin = 0;
    for (auto dot = key.find('.'); dot != std::string::npos;
         begin = dot + 1, dot = key.find('.', begin)) {
      const std::string part = key.substr(begin, dot - begin);
      at->insert(part, toml::table{});
      at = at->get(part)->as_table();
      if (at == nullptr) {
        throw InputError(
            fmt::format("--set {}: {} is not a table in {}", override, part, place.origin));
      }
    }
    // The shell has eaten the quotes of laser.power="200 W", so what is no TOML value is a text.
    const std::string last = key.substr(begin);
    try {
      auto parsed = toml::parse("value = " + value);
      at->insert_or_assign(last, *parsed.get("value"));
    } catch (const toml::parse_error&) {
      at->insert_or_assign(last, value);
    }
    place.overridden.insert(key);
  }
  place.files = &files;
  root.body_->read(table, "", place);
}

Input::Input(InputTable root) : state_(new State{std::move(root), {}}) {}
Input::Input(Input&&) noexcept = default;
Input::~Input() = default;

void Input::read(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  const std::string text = read_file(path);
  state_->files = {path};
  state_->read(text, {path.string(), path.parent_path(), {}, nullptr}, overrides);
}

void Input::read_text(const std::string& text, const std::string& origin) {
  state_->files.clear();
  state_->read(text, {origin, {}, {}, nullptr}, {});
}

std::string Input::resolved() const {
  std::string out;
  state_->root.body_->print(out, "");
  return out;
}

nlohmann::json Input::schema() const {
  auto schema = state_->root.body_->schema();
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = state_->root.name();
  return schema;
}

std::string Input::reference() const {
  std::string out;
  state_->root.body_->reference(out, "");
  return out.substr(1);
}

const std::vector<std::filesystem::path>& Input::files() const { return state_->files; }

}  // namespace meltproof
