// SPDX-License-Identifier: GPL-3.0-or-later
// A table of parameters: reading with refusal of what is unknown, and what can be made of the
// declaration.
#include "base/input_table.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace meltproof {
namespace {

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

}  // namespace

InputTable::InputTable(std::string name, std::string about) : body_(std::make_unique<Body>()) {
  body_->name = std::move(name);
  body_->about = std::move(about);
}
InputTable::InputTable(InputTable&&) noexcept = default;
InputTable& InputTable::operator=(InputTable&&) noexcept = default;
InputTable::~InputTable() = default;
const std::string& InputTable::name() const { return body_->name; }

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

}  // namespace meltproof
