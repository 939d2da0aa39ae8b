// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/elements.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

constexpr std::nullopt_t none = std::nullopt;

const Element* find(std::string_view symbol) {
  const auto& all = elements();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Element& e) { return e.symbol == symbol; });
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

const std::vector<Element>& elements() {
  static const std::vector<Element> all = {
      {"H", 1, 1.008, none, none},        {"B", 5, 10.81, none, none},
      {"C", 6, 12.011, 0.277, 0.2838},    {"N", 7, 14.007, 0.3924, none},
      {"O", 8, 15.999, 0.5249, 0.532},    {"F", 9, 18.998, 0.6768, none},
      {"Na", 11, 22.990, 1.0410, 1.0721}, {"Mg", 12, 24.305, 1.2536, 1.3050},
      {"Al", 13, 26.982, 1.4867, 1.5596}, {"Si", 14, 28.085, 1.7400, 1.8389},
      {"P", 15, 30.974, 2.0137, 2.1455},  {"S", 16, 32.06, 2.3078, 2.4720},
      {"Cl", 17, 35.45, 2.6224, 2.8224},  {"K", 19, 39.098, 3.3138, 3.6074},
      {"Ca", 20, 40.078, 3.6917, 4.0381}, {"Ti", 22, 47.867, 4.5108, 4.9664},
      {"V", 23, 50.942, 4.9522, 5.4651},  {"Cr", 24, 51.996, 5.4147, 5.9892},
      {"Mn", 25, 54.938, 5.8988, 6.5390}, {"Fe", 26, 55.845, 6.4038, 7.1120},
      {"Co", 27, 58.933, 6.9303, 7.7089}, {"Ni", 28, 58.693, 7.4782, 8.3328},
      {"Cu", 29, 63.546, 8.0478, 8.9789}, {"Zn", 30, 65.38, 8.6389, 9.6586},
      {"Zr", 40, 91.224, none, none},     {"Nb", 41, 92.906, none, none},
      {"Mo", 42, 95.95, none, none},      {"Sn", 50, 118.71, none, none},
      {"Ta", 73, 180.95, none, none},     {"W", 74, 183.84, none, none},
  };
  return all;
}

bool is_element(std::string_view symbol) { return find(symbol) != nullptr; }

const Element& element(std::string_view symbol) {
  const Element* found = find(symbol);
  if (found == nullptr) {
    throw InputError(fmt::format(
        "\"{}\" is no element whose atomic weight is known here: expected a symbol such as Al.",
        symbol));
  }
  return *found;
}

const Element* element_of_number(int number) {
  const auto& all = elements();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Element& e) { return e.number == number; });
  return at == all.end() ? nullptr : &*at;
}

double atomic_weight(const std::string& symbol) { return element(symbol).atomic_weight; }

std::string element_named_in(std::string_view header) {
  std::string word;
  for (const char c : std::string(header) + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
      continue;
    }
    if (is_element(word)) {
      return word;
    }
    const bool line = word.size() > 1 && std::string_view("KLM").find(word.back()) < 3;
    if (line && is_element(word.substr(0, word.size() - 1))) {
      return word.substr(0, word.size() - 1);
    }
    word.clear();
  }
  return "";
}

}  // namespace meltproof::validation
