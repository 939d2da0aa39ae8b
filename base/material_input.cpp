// SPDX-License-Identifier: GPL-3.0-or-later
// Material and diffusivity files: how they are declared, and what makes one impossible.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/material.hpp"
#include "base/provenance.hpp"
#include "base/units.hpp"

namespace meltproof {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One number of a material file with what is said about it.
struct Scalar {
  double value = 0;
  std::optional<double> uncertainty;
  std::string source, note;
};

struct ScalarKey {
  const char *name, *unit, *about;
  double Material::*target;
  double maximum = unlimited;
};
constexpr std::array scalar_keys = {
    ScalarKey{"solidus", "K", "solidus temperature", &Material::solidus},
    ScalarKey{"liquidus", "K", "liquidus temperature", &Material::liquidus},
    ScalarKey{"boiling", "K", "boiling temperature at one atmosphere", &Material::boiling},
    ScalarKey{"density", "kg m-3", "density that the solver uses", &Material::density},
    ScalarKey{"real_density", "kg m-3", "density of the solid", &Material::real_density},
    ScalarKey{"molar_mass", "kg mol-1", "molar mass of the vapour", &Material::molar_mass},
    ScalarKey{"absorptivity", "1", "at the laser's wavelength", &Material::absorptivity, 1},
    ScalarKey{"emissivity", "1", "total hemispherical", &Material::emissivity, 1},
    ScalarKey{"latent_heat_vaporisation", "J kg-1", "at the boiling temperature",
              &Material::latent_heat_vaporisation},
    ScalarKey{"sticking", "1", "share of the evaporated flux that leaves", &Material::sticking, 1}};

InputTable scalar_table(const ScalarKey& key, Scalar& target) {
  InputTable table(key.name, key.about);
  table.quantity(target.value, {"value", key.unit, key.about, true, 0, key.maximum})
      .quantity(target.uncertainty, {"uncertainty", key.unit, "standard uncertainty", false, 0})
      .text(target.source, {"source", "where the value is published", true})
      .text(target.note, {"note", "what to know about it"});
  return table;
}

/// A property as it is read: its pieces still with `join`, which takes the values at both
/// neighbours.
struct RawPiece {
  PropertyPiece piece;
  bool join = false;
};
struct RawProperty {
  Property property;
  std::deque<RawPiece> pieces;
};

void declare_pieces(InputTable& table, const std::string& unit, std::deque<RawPiece>& pieces) {
  table.tables(
      "piece", "one range of the property, in order of temperature",
      [&pieces, unit](std::size_t) {
        RawPiece& raw = pieces.emplace_back();
        PropertyPiece& piece = raw.piece;
        InputTable one("piece", "a + b T + c (1 - exp(-d / T))");
        one.quantity(piece.from, {"from", "K", "lower end", true, 0})
            .quantity(piece.to, {"to", "K", "upper end", true, 0})
            .quantity(piece.constant, {"constant", unit, "a"})
            .quantity(piece.linear, {"linear", unit + " K-1", "b"})
            .quantity(piece.exponential, {"exponential", unit, "c"})
            .quantity(piece.activation, {"activation", "K", "d"})
            .flag(raw.join, {"join", "a straight line between the neighbouring pieces"});
        return one;
      },
      true);
}

InputTable property_table(const std::string& name, const std::string& unit, RawProperty& target) {
  InputTable table(name, name + " as a function of temperature");
  target.property.unit = unit;
  table.text(target.property.source, {"source", "where it is published", true})
      .text(target.property.note, {"note", "what was repaired"})
      .quantity(target.property.floor, {"floor", unit, "smallest value returned", false, 0});
  declare_pieces(table, unit, target.pieces);
  return table;
}

InputTable printed_table(const std::string& name, const std::string& unit, RawProperty& target) {
  InputTable table(name, name + " as the source prints it");
  target.property.unit = unit;
  target.property.floor = -unlimited;
  table.text(target.property.note, {"wrong", "what is wrong with the printed form", true});
  declare_pieces(table, unit, target.pieces);
  return table;
}

/// Refuses ranges that are empty, leave gaps or overlap. @param begin where the first must begin.
template <class Range>
void check_ranges(const std::vector<Range>& ranges, double begin, const std::string& where) {
  if (ranges.empty()) {
    throw InputError(where + ".piece: it has no element: expected at least one range");
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i].from != begin || !(ranges[i].to > ranges[i].from)) {
      throw InputError(fmt::format(
          "{}.piece[{}]: it reaches from {} K to {} K: expected it to begin at {} K and to rise",
          where, i, shortest(ranges[i].from), shortest(ranges[i].to), shortest(begin)));
    }
    begin = ranges[i].to;
  }
}

/// The finished property. @param jumps whether it may be discontinuous (printed forms).
Property finished(RawProperty& raw, const std::string& where, bool jumps) {
  auto& pieces = raw.property.pieces;
  for (const RawPiece& one : raw.pieces) {
    pieces.push_back(one.piece);
  }
  check_ranges(pieces, pieces.empty() ? 0 : pieces.front().from, where);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!raw.pieces[i].join) {
      continue;
    }
    if (i == 0 || i + 1 == pieces.size() || raw.pieces[i + 1].join) {
      throw InputError(fmt::format(
          "{}.piece[{}]: a joining piece needs a piece with a formula on each side", where, i));
    }
    PropertyPiece& piece = pieces[i];
    const double low = pieces[i - 1](piece.from);
    piece.linear = (pieces[i + 1](piece.to) - low) / (piece.to - piece.from);
    piece.constant = low - piece.linear * piece.from;
  }
  for (std::size_t i = 1; i < pieces.size() && !jumps; ++i) {
    const double at = pieces[i].from, left = pieces[i - 1](at), right = pieces[i](at);
    if (std::abs(right - left) > 1e-9 * std::max(std::abs(left), std::abs(right))) {
      throw InputError(fmt::format(
          "{}.piece[{}]: the property jumps from {} to {} {} at {} K: expected a continuous one; "
          "adjust a constant or write join = true",
          where, i, shortest(left), shortest(right), raw.property.unit, shortest(at)));
    }
  }
  return std::move(raw.property);
}

/// The enthalpy as it is read: slopes from the temperature at which it is zero.
struct RawEnthalpy {
  struct Slope {
    double from = 0, to = 0, slope = 0;
  };
  double reference = 298.15;
  std::string source, note;
  std::deque<Slope> slopes;
};

InputTable enthalpy_table(RawEnthalpy& target) {
  InputTable table("enthalpy",
                   "specific enthalpy by its slopes, zero at the reference temperature");
  table.quantity(target.reference, {"reference_temperature", "K", "where it is zero", true, 0})
      .text(target.source, {"source", "where it is published", true})
      .text(target.note, {"note", "what was repaired"})
      .tables(
          "piece", "one range, in order of temperature",
          [&target](std::size_t) {
            auto& piece = target.slopes.emplace_back();
            InputTable one("piece", "a range of constant slope");
            one.quantity(piece.from, {"from", "K", "lower end", true, 0})
                .quantity(piece.to, {"to", "K", "upper end", true, 0})
                .quantity(piece.slope,
                          {"slope", "J kg-1 K-1", "dh/dT, specific and latent heat", true, 1.0});
            return one;
          },
          true);
  return table;
}

PiecewiseLinear finished(const RawEnthalpy& raw, const std::string& where) {
  check_ranges(std::vector(raw.slopes.begin(), raw.slopes.end()), raw.reference, where);
  PiecewiseLinear h{{raw.reference}, {0}};
  for (const auto& piece : raw.slopes) {
    h.knots.push_back(piece.to);
    h.values.push_back(h.values.back() + piece.slope * (piece.to - piece.from));
  }
  return h;
}

}  // namespace

Material read_material(const std::filesystem::path& path, Form form) {
  Material m;
  std::array<Scalar, scalar_keys.size()> scalars;
  RawEnthalpy enthalpy;
  RawProperty conductivity, viscosity, surface_tension, printed_enthalpy, printed_heat,
      printed_conductivity, printed_viscosity, printed_tension;
  bool has_real_density = false, has_printed = false;

  InputTable printed("as_printed", "what the source prints, kept beside the repaired forms");
  printed
      .quantity(m.printed.molar_mass, {"molar_mass", "kg mol-1", "molar mass as printed", true, 0})
      .table(printed_table("enthalpy", "J kg-1", printed_enthalpy))
      .table(printed_table("specific_heat", "J kg-1 K-1", printed_heat))
      .table(printed_table("conductivity", "W m-1 K-1", printed_conductivity))
      .table(printed_table("viscosity", "Pa s", printed_viscosity))
      .table(printed_table("surface_tension", "N m-1", printed_tension));

  InputTable root("material", "One material of the suite.");
  root.text(m.name, {"name", "its name", true})
      .text(m.source, {"source", "where its values come from unless said otherwise", true});
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    const bool optional = scalar_keys[i].target == &Material::real_density;
    root.table(scalar_table(scalar_keys[i], scalars[i]), optional ? &has_real_density : nullptr);
  }
  root.table(enthalpy_table(enthalpy))
      .table(property_table("conductivity", "W m-1 K-1", conductivity))
      .table(property_table("viscosity", "Pa s", viscosity))
      .table(property_table("surface_tension", "N m-1", surface_tension))
      .table(std::move(printed), &has_printed);
  Input input(std::move(root));
  input.read(path);
  m.checksum = sha256_file(path);

  for (std::size_t i = 0; i < scalars.size(); ++i) {
    m.*scalar_keys[i].target = scalars[i].value;
    if (scalars[i].uncertainty) {
      m.uncertainty[scalar_keys[i].name] = *scalars[i].uncertainty;
    }
  }
  if (!has_real_density) {
    m.real_density = m.density;
  }
  if (!(m.solidus < m.liquidus && m.liquidus < m.boiling)) {
    throw InputError(
        fmt::format("{}: solidus {} K, liquidus {} K and boiling {} K must rise in this order",
                    path.string(), shortest(m.solidus), shortest(m.liquidus), shortest(m.boiling)));
  }
  const auto where = [&path](const char* key) { return path.string() + ": " + key; };
  m.enthalpy = finished(enthalpy, where("enthalpy"));
  m.conductivity = finished(conductivity, where("conductivity"), false);
  m.viscosity = finished(viscosity, where("viscosity"), false);
  m.surface_tension = finished(surface_tension, where("surface_tension"), false);
  if (!has_printed) {
    if (form == Form::as_printed) {
      throw InputError(
          fmt::format("{}: as_printed: there are no forms as printed in this file: expected form = "
                      "\"repaired\"",
                      path.string()));
    }
    return m;
  }
  m.printed.enthalpy = finished(printed_enthalpy, where("as_printed.enthalpy"), true);
  m.printed.specific_heat = finished(printed_heat, where("as_printed.specific_heat"), true);
  m.printed.conductivity = finished(printed_conductivity, where("as_printed.conductivity"), true);
  m.printed.viscosity = finished(printed_viscosity, where("as_printed.viscosity"), true);
  m.printed.surface_tension = finished(printed_tension, where("as_printed.surface_tension"), true);
  if (form == Form::as_printed) {
    m.conductivity = m.printed.conductivity;
    m.viscosity = m.printed.viscosity;
    m.surface_tension = m.printed.surface_tension;
    m.molar_mass = m.printed.molar_mass;
  }
  return m;
}

Diffusivity read_diffusivity(const std::filesystem::path& path, const std::string& law) {
  struct Law {
    Diffusivity value;
    std::optional<double> uncertainty;
  };
  std::string chosen;
  std::deque<Law> laws;
  InputTable root("diffusivity", "Laws of the diffusivity of the additive in the base.");
  root.text(chosen, {"default", "the law used when none is named", true})
      .tables(
          "law", "one law, D = prefactor exp(-activation / T)",
          [&laws](std::size_t) {
            Law& one = laws.emplace_back();
            InputTable table("law", "one law");
            table.text(one.value.name, {"name", "its name", true})
                .quantity(one.value.prefactor, {"prefactor", "m2 s-1", "prefactor", true, 0})
                .quantity(one.uncertainty, {"uncertainty", "m2 s-1", "of the prefactor", false, 0})
                .quantity(one.value.activation_temperature,
                          {"activation", "K", "activation energy over R", true, 0})
                .quantity(one.value.from, {"from", "K", "lowest temperature measured", true, 0})
                .quantity(one.value.to, {"to", "K", "highest temperature measured", true, 0})
                .text(one.value.source, {"source", "where it is published", true})
                .text(one.value.note, {"note", "what to know about it"});
            return table;
          },
          true);
  Input input(std::move(root));
  input.read(path);
  if (!law.empty()) {
    chosen = law;
  }
  std::vector<std::string> names;
  for (const Law& one : laws) {
    if (one.value.name == chosen) {
      return one.value;
    }
    names.push_back(one.value.name);
  }
  throw InputError(fmt::format("{}: there is no diffusivity law \"{}\": expected one of {}",
                               path.string(), chosen, fmt::join(names, ", ")));
}

}  // namespace meltproof
