// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/input.hpp"

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/input_table.hpp"

namespace meltproof {

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
