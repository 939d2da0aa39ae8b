// SPDX-License-Identifier: GPL-3.0-or-later
// TOML input with units. A parameter is declared once (name, unit, default, bounds, description);
// that declaration reads the file, refuses what is unknown or out of bounds, and yields the JSON
// Schema, the reference page and the resolved input that goes into provenance.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace meltproof {

/// How a number with a unit is declared. Bounds are in the declared unit and inclusive.
struct Quantity {
  std::string name;   ///< TOML key
  std::string unit;   ///< udunits2; the value in the program is in this unit; "1" for a pure number
  std::string about;  ///< one sentence for the reference page, with the source where there is one
  bool required = false;  ///< otherwise the bound variable's value at declaration is the default
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// How a text, a choice, a path, a flag or a whole number is declared.
struct Entry {
  std::string name;
  std::string about;
  bool required = false;
  std::vector<std::string> choices = {};  ///< texts only: the allowed values; empty: any
  long long minimum = std::numeric_limits<long long>::min();  ///< whole numbers only, inclusive
  long long maximum = std::numeric_limits<long long>::max();
};

/// One TOML table: its parameters bound to variables, its sub-tables and arrays of tables. The
/// bound variables must outlive the table.
class InputTable {
 public:
  InputTable(std::string name, std::string about);
  InputTable(InputTable&&) noexcept;
  InputTable& operator=(InputTable&&) noexcept;
  ~InputTable();

  /// Declares a number with a unit (or a pure number, unit "1").
  InputTable& quantity(double& target, Quantity declaration);
  /// Declares a number that may be left out altogether; shown without default.
  InputTable& quantity(std::optional<double>& target, Quantity declaration);
  /// Declares a list of numbers with one unit: `["1 um", "2 um"]` or, for unit "1", `[1, 2.5]`.
  InputTable& quantities(std::vector<double>& target, Quantity declaration);
  InputTable& whole(long long& target, Entry declaration);
  InputTable& flag(bool& target, Entry declaration);
  InputTable& text(std::string& target, Entry declaration);
  InputTable& texts(std::vector<std::string>& target, Entry declaration);
  /// Declares a file, given relative to the folder of the input file. It must exist once resolved,
  /// unless it is left out (empty).
  InputTable& file(std::filesystem::path& target, Entry declaration);

  /// Declares a sub-table; `present`, if given, is set to whether the file holds it.
  InputTable& table(InputTable declaration, bool* present = nullptr);
  /// Declares an array of tables. For each element `make(index)` returns the declaration bound to
  /// the element's own variables (append to a container with stable addresses, such as std::deque).
  InputTable& tables(std::string name, std::string about,
                     std::function<InputTable(std::size_t)> make, bool required = false);

  const std::string& name() const;

 private:
  friend class Input;
  struct Body;
  std::unique_ptr<Body> body_;
};

/// The whole input of a program: a root table and what can be made of its declaration.
class Input {
 public:
  explicit Input(InputTable root);
  Input(Input&&) noexcept;
  ~Input();

  /// Reads `path` into the bound variables. `overrides` are "table.key=value" texts that replace
  /// what the file says, with the value in TOML notation or bare (`laser.power=200 W`).
  /// @throws InputError naming file, line and key for a missing file, a syntax error, an unknown
  /// key,
  ///         a wrong unit or type, a value out of bounds, a missing required key.
  void read(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
  /// The same from text; `origin` stands for the file's name in messages.
  void read_text(const std::string& text, const std::string& origin);

  /// The values now in the bound variables as TOML with units: the resolved input.
  std::string resolved() const;
  /// JSON Schema (draft 2020-12) of the declaration.
  nlohmann::json schema() const;
  /// The reference page in Markdown: key, unit, default, bounds, description.
  std::string reference() const;
  /// Files that the last read() depended on: the input itself and every declared file that was
  /// given.
  const std::vector<std::filesystem::path>& files() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meltproof
