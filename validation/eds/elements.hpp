// SPDX-License-Identifier: GPL-3.0-or-later
// The elements that steels and aluminium alloys hold: number, atomic weight, K line, K edge.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meltproof::validation {

struct Element {
  std::string symbol;
  int number = 0;
  double atomic_weight = 0;       ///< g mol-1, IUPAC 2021, abridged
  std::optional<double> k_alpha;  ///< energy of the K-alpha-1 line, keV (Bearden 1967)
  std::optional<double> k_edge;   ///< keV (Bearden & Burr 1967)
};

/// All of them, by number.
const std::vector<Element>& elements();

/// Whether the symbol ("Al") is known here.
bool is_element(std::string_view symbol);
/// @throws InputError for an unknown symbol.
const Element& element(std::string_view symbol);
/// The element of an atomic number; nullptr if it is not known here.
const Element* element_of_number(int number);
/// Standard atomic weight in g/mol. @throws InputError for an unknown symbol.
double atomic_weight(const std::string& symbol);

/// The element that a header names: its first word that is a symbol, also with the letter of a
/// line behind it ("AlK", "FeK"); empty if there is none.
std::string element_named_in(std::string_view header);

}  // namespace meltproof::validation
