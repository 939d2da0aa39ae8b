// SPDX-License-Identifier: GPL-3.0-or-later
// What a powder bed is asked for, and what makes it impossible.
#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/units.hpp"
#include "solver/powder/powder_bed.hpp"

namespace meltproof::solver {
namespace {

InputTable grade_table(const std::string& name, const std::string& about, PowderGrade& grade,
                       const std::string& experiment) {
  InputTable table(name, about);
  table
      .quantity(grade.size.d50, {"d50", "m",
                                 "median diameter; the simulation of the paper takes 13.7 um "
                                 "(Section 3.2), its experiment " +
                                     experiment,
                                 false, 1e-7, 1e-3})
      .quantity(grade.size.d10,
                {"d10", "m", "10 % diameter; with d90 it sets the width", false, 1e-7, 1e-3})
      .quantity(grade.size.d90, {"d90", "m", "90 % diameter", false, 1e-7, 1e-3})
      .quantity(
          grade.size.geometric_deviation,
          {"geometric_deviation", "1",
           "geometric standard deviation if d10 and d90 are left out; 1 for a single size. The "
           "paper gives none: an assumption",
           false, 1, 3})
      .quantity(
          grade.size.truncation,
          {"truncation", "1",
           "geometric standard deviations kept on each side of d50; an assumption, 2 keep 95 %",
           false, 0.5, 5})
      .flag(grade.size.by_volume,
            {"by_volume",
             "d10, d50, d90 are of the volume, as laser diffraction reports; otherwise of "
             "the number"})
      .quantity(grade.density, {"density", "kg m-3",
                                "for the blend by mass; as in the solver, the paper's one density "
                                "(Table 3)",
                                false, 100, 25000});
  return table;
}

}  // namespace

InputTable powder_table(PowderSettings& s) {
  InputTable box("box", "The box: x along the scan, y across, z up from the plate.");
  box.quantity(s.length_x, {"length_x", "m", "extent along the scan", false, 1e-6, 1})
      .quantity(s.length_y, {"length_y", "m", "extent across the scan", false, 1e-6, 1})
      .quantity(s.origin_x, {"origin_x", "m", "x of the lower corner"})
      .quantity(s.origin_y, {"origin_y", "m", "y of the lower corner"})
      .quantity(s.layer_height,
                {"layer_height", "m", "powder layer thickness (Table 2)", false, 1e-6, 1})
      .flag(s.periodic, {"periodic", "periodic lateral sides instead of walls"})
      .text(s.blade,
            {"blade",
             "which spheres the blade takes: those whose centre, or whose top, is above the "
             "layer",
             false,
             {"centre", "top"}});
  InputTable root("powder", "A powder bed by drop and roll (Zhou et al. 2009).");
  root.whole(s.seed, {"seed", "of the random numbers", false, {}, 0})
      .quantity(s.additive_mass_fraction,
                {"additive_mass_fraction", "1",
                 "share of the additive in the blend by mass; the paper studies 0, 1 and 5 %",
                 false, 0, 1})
      .table(std::move(box))
      .table(grade_table("base", "The base powder.", s.base, "15.4 um for 316L"))
      .table(grade_table("additive", "The additive powder.", s.additive, "11.3 um for AlSi10Mg"));
  return root;
}

void check(const PowderSettings& s) {
  double largest = 0;
  if (s.additive_mass_fraction < 1) {
    largest = SizeDistribution(s.base.size, "base").largest();
  }
  if (s.additive_mass_fraction > 0) {
    largest = std::max(largest, SizeDistribution(s.additive.size, "additive").largest());
  }
  const double shortest_side = std::min(s.length_x, s.length_y);
  const double needed = s.periodic ? 2 * largest : largest;
  const auto um = [](double length) { return shortest(std::round(length * 1e8) / 1e2) + " um"; };
  if (shortest_side < needed) {
    throw InputError(fmt::format(
        "box.{}: the box is {} wide, but its largest sphere is {}: expected at least {}{}",
        s.length_x <= s.length_y ? "length_x" : "length_y", um(shortest_side), um(largest),
        um(needed), s.periodic ? ", twice that in a periodic box" : ""));
  }
  if (s.layer_height < largest / 2 && s.blade == "centre") {
    // Even a sphere on the plate has its centre above such a layer; only smaller ones would stay.
    throw InputError(
        fmt::format("box.layer_height: {} is less than the radius {} of the largest sphere, so the "
                    "blade would sort "
                    "by size: expected at least {}",
                    um(s.layer_height), um(largest / 2), um(largest / 2)));
  }
}

}  // namespace meltproof::solver
