// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_case.hpp"

namespace meltproof::solver {

namespace {

void scale(Property& property, double factor) {
  for (PropertyPiece& piece : property.pieces) {
    piece.constant *= factor;
    piece.linear *= factor;
    piece.exponential *= factor;
  }
  property.floor *= factor;
}

/// Turns the curve about its value at the first temperature of its table.
void scale_slope(Property& property, double factor) {
  const double kept = property.pieces.front()(property.pieces.front().from);
  for (PropertyPiece& piece : property.pieces) {
    piece.constant = kept + factor * (piece.constant - kept);
    piece.linear *= factor;
    piece.exponential *= factor;
  }
}

}  // namespace

Mixture read_mixture(const TrackCase& t) {
  const Form form = t.form == "as_printed" ? Form::as_printed : Form::repaired;
  Material base = read_material(t.base, form);
  if (t.absorptivity >= 0) {
    base.absorptivity = t.absorptivity;
  }
  Material additive = read_material(t.additive, form);
  if (t.density == "own") {
    base.density = base.real_density;
    additive.density = additive.real_density;
  }
  // A factor of one leaves every bit as it was.
  scale(base.conductivity, t.conductivity_factor);
  if (t.tension_slope_factor != 1) {
    scale_slope(base.surface_tension, t.tension_slope_factor);
  }
  if (t.additive_molar_mass >= 0) {
    additive.molar_mass = t.additive_molar_mass;
  }
  return {base, additive};
}

}  // namespace meltproof::solver
