// SPDX-License-Identifier: GPL-3.0-or-later
// A powder bed: spheres of two materials at rest on the plate, ready for the solver.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/provenance.hpp"
#include "solver/powder/drop_and_roll.hpp"
#include "solver/powder/size_distribution.hpp"

namespace meltproof::solver {

/// One powder of the blend.
struct PowderGrade {
  SizeSettings size;
  double density = 7763;  ///< kg m-3; the paper neglects its variation
};

/// Everything that determines a bed.
struct PowderSettings {
  double length_x = 600e-6, length_y = 240e-6;  ///< m, x along the scan
  double origin_x = 0, origin_y = 0;            ///< m, lower corner
  double layer_height = 20e-6;                  ///< m
  bool periodic = false;                        ///< lateral sides; otherwise walls
  /// Which spheres the blade takes: those whose centre, or whose top, is above the layer.
  std::string blade = "centre";
  double additive_mass_fraction = 0;  ///< 1
  PowderGrade base, additive;
  long long seed = 1;
};

/// The spheres that stay in the layer, and what is reported of them.
struct PowderBed {
  std::vector<Sphere> spheres;               ///< in the box's coordinates with its origin added, m
  std::vector<std::array<int, 3>> supports;  ///< of each: indices of spheres or Support
  std::vector<std::int32_t> material;        ///< 0 base, 1 additive
  std::vector<std::int32_t> coordination;    ///< touching spheres; floor and walls not counted
  Eigen::Vector3d lower{0, 0, 0}, upper{0, 0, 0};  ///< m; z from 0 to the layer height
  double packing_density = 0;         ///< 1, sphere volume between z = 0 and the layer height
  double mean_coordination = 0;       ///< 1
  double additive_mass_fraction = 0;  ///< 1, of the spheres that stay
  double d10 = 0, d50 = 0, d90 = 0;   ///< m, by volume, of the spheres that stay
  long long dropped = 0;              ///< spheres that came to rest before the blade
  long long dropped_again = 0;        ///< spheres dropped anew from an edge of balance
};

/// Declares the settings as the input of meltproof-powder.
InputTable powder_table(PowderSettings& settings);

/// Refuses what no bed can be made of. @throws InputError naming the key.
void check(const PowderSettings& settings);

/// Makes a bed; the same settings give the same bytes. @param progress called with the share of the
/// layer that is filled, 0 to 1, if given. @throws InputError as check().
PowderBed generate(const PowderSettings& settings,
                   const std::function<void(double)>& progress = {});

/// The part of a sphere's volume between two heights, m3.
double sphere_volume_between(const Sphere& sphere, double low, double high);

/// Writes a bed as an artifact "meltproof powder bed".
void write_powder_bed(const std::filesystem::path& path, const PowderBed& bed,
                      const Provenance& provenance);

}  // namespace meltproof::solver
