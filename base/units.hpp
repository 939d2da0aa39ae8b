// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities with units at the door, SI inside.
#pragma once

#include <string>
#include <string_view>

namespace meltproof {

/// The value of `text` ("175 W", "17.6 um", "1400 degC", "0.4") expressed in `unit`.
/// @param text a number followed by a unit that udunits2 knows; the unit may only be left out when
///        `unit` is dimensionless ("1"), for which "5 %" is understood as well.
/// @param unit the wanted unit in udunits2 notation, for example "W", "kg m-3", "1".
/// @throws InputError if the text is no number with a unit, the unit is unknown, or its dimension
///         differs; the message names what was found and what was expected, without file or key.
double parse_quantity(std::string_view text, const std::string& unit);

/// `value` given in unit `from`, expressed in unit `to`. @throws InputError as parse_quantity.
double convert_unit(double value, const std::string& from, const std::string& to);

/// A number in the shortest decimal form that reads back to the same double.
std::string shortest(double value);

}  // namespace meltproof
