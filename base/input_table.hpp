// SPDX-License-Identifier: GPL-3.0-or-later
// What an input table consists of; only the files of the input include this.
#pragma once

#include <set>

#include <fmt/format.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/error.hpp"
#include "base/input.hpp"

namespace meltproof {

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

/// One declared key: everything else is asked of these closures, bound to the caller's variable.
struct Leaf {
  std::string name, about, unit, bounds, fallback;
  bool required = false;
  std::function<void(const toml::node&, const std::string& key, const Place&)> read;
  std::function<std::string()> print;  ///< the value in TOML; empty: not given
  nlohmann::json schema;
};

/// "a.b" from "a" and "b".
inline std::string joined(const std::string& prefix, const std::string& name) {
  return prefix.empty() ? name : prefix + "." + name;
}

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

}  // namespace meltproof
