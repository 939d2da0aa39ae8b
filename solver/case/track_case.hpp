// SPDX-License-Identifier: GPL-3.0-or-later
// The declared parameters of a track, and the particles that follow from them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/material.hpp"
#include "solver/case/flow_input.hpp"
#include "solver/particles/particles.hpp"
#include "solver/step/engine.hpp"

namespace meltproof::solver {

/// A single track on a plate, with or without powder: the paper's Tables 2 and 3 as defaults.
struct TrackCase {
  std::string title = "single track";
  double spacing = 10e-6, smoothing_ratio = 1, initial_temperature = 293.15;
  std::string surface = "powder";  ///< "powder" or "bare"
  std::filesystem::path bed;       ///< powder.h5

  std::filesystem::path base, additive, diffusivity_laws;
  std::string diffusivity_law;
  std::string form = "repaired";
  std::string density = "uniform";  ///< "uniform", or "own": each material's real_density
  // Inputs of the sensitivity study, as multiples of what the files hold.
  double conductivity_factor = 1;   ///< on the base material's
  double tension_slope_factor = 1;  ///< on d sigma/dT of the base material
  double additive_molar_mass = -1;  ///< kg mol-1; negative: the file's

  double power = 175, beam_radius = 40e-6, speed = 0.375, exposure = 1.04e-3;
  std::string radius_definition = "1/e2";  ///< what beam_radius means: "1/e2" or "D4sigma/2"
  double absorptivity = -1;                ///< of the base material; negative: the material's own
  std::string absorption = "constant";     ///< or "ray_traced": reflected light is followed
  double incidence_angle = 0, incidence_azimuth = 0;  ///< rad

  double before = 150e-6, behind = 150e-6, width = 400e-6, depth = 200e-6;

  bool species = true, evaporation = true, radiation = true;
  bool surface_conduction = false;
  std::string species_factor = "consistent", species_scheme = "as_printed",
              species_operator = "fourth";
  double ambient_temperature = 293.15, ambient_pressure = 101325;
  double heat_transfer_coefficient = 0;  ///< W m-2 K-1
  std::string vapour_heat = "latent";    ///< or "latent_and_sensible"

  FlowInput flow;

  double pool_temperature = 0;       ///< K, outlines the pool; 0: the base material's liquidus
  double frame_rate = 9762.5;        ///< Hz, of the snapshots
  double history_interval = 5e-6;    ///< s
  double averaging_window = 200e-6;  ///< s, before the beam goes off
  double cooling_limit = 3e-3;       ///< s after the beam goes off, at most
};

/// The declaration; `track` must outlive the input.
Input declare(TrackCase& track);

/// What a spacing makes of a bed of grains.
struct Discretisation {
  Particles particles;
  Domain domain;
  double powder_volume = 0;               ///< m3, of the grains inside the domain
  double powder_volume_error = 0;         ///< relative, of the particles that stand for them
  double additive_mass_fraction = 0;      ///< of the powder as particles
  double bed_additive_mass_fraction = 0;  ///< of the powder as spheres; 0 for a bare plate
};

/// Fills plate and grains with particles on one lattice. Eight sub-points a side measure how much
/// of a lattice cell each powder fills; the cells fullest of the additive become its particles
/// until its volume is reached, then likewise the base powder: both volumes are kept to half a
/// particle, and every particle is of one powder, as in the paper.
/// @throws InputError when the bed is missing, or too coarse a spacing leaves the beam or layer
/// unresolved.
Discretisation discretise(const TrackCase& track, const Mixture& mixture);

/// Plate and additive as the case's property tables have them, with the case's own absorptivity,
/// densities, conductivity, slope of the surface tension and molar mass.
/// @throws InputError as read_material().
Mixture read_mixture(const TrackCase& track);

/// Sentences about what the case cannot resolve well; empty if nothing is wrong.
/// @throws InputError where it could not be stable, with the number that would do.
std::vector<std::string> warnings(const TrackCase& track, const Mixture& mixture);

/// The engine's model for a track.
Model make_model(const TrackCase& track, const Domain& domain);

}  // namespace meltproof::solver
