// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic passages of an analytic pool through the image, kept in memory: many scenes of known
// truth for tests and studies, exposed once and moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "imaging/camera/noise.hpp"
#include "imaging/camera/rosenthal.hpp"
#include "imaging/camera/scene.hpp"

namespace meltproof::imaging {

/// What the tail of an analytic pool shows of solidification. Rosenthal's field is read as a scaled
/// enthalpy Theta = H / c (K); temperature follows from it with the latent heat released evenly
/// between liquidus (the source's reference temperature) and solidus. This is no solution of the
/// heat equation with a phase change, but a tail with a shoulder whose front is known exactly.
struct Solidification {
  double latent_heat = 0;  ///< K, latent heat over specific heat, L / c; 0: none
  double interval = 50;    ///< K, liquidus minus solidus; used with latent heat only
};

/// A small bright body in flight (spatter) or a cloud that stands above the pool (plume), added to
/// the signal.
struct Bright {
  double column = 0, row = 0;              ///< px at the first frame
  double column_speed = 0, row_speed = 0;  ///< px a frame
  double radius = 1;                       ///< px, sigma of its Gaussian
  double signal = 0;                       ///< counts above dark at its middle
  std::size_t first = 0, last = 0;         ///< frames in which it is seen, inclusive
};

/// One passage: the camera, the pool and what disturbs it.
struct PassageSettings {
  CameraSettings camera;
  RosenthalSettings source;
  Solidification solidification;
  double start = 0;            ///< px, image column of the source at the first frame
  std::vector<Bright> bright;  ///< spatter and plume
  double read_noise = 0;       ///< counts, standard deviation
  double non_uniformity = 0;   ///< 1, standard deviation of the pixels' gains
  std::uint64_t seed = 1;      ///< of noise and gains
};

/// The frames of a passage and what is true of it.
struct FilmedPassage {
  std::vector<std::vector<float>> frames;  ///< each height * width, counts, row-major, unrounded
  double length = 0, depth = 0;            ///< m, exact size of the pool (depth: width from above)
  double step = 0;                         ///< px the pool moves between frames
  double liquid_signal = 0;  ///< counts of liquid metal at the reference temperature, with dark
  double solid_signal = 0;   ///< counts of solid metal there
};

/// Temperature and emissivity of a pool whose source is at u = 0, as rosenthal_field(), with
/// solidification: the emissivity goes from solid to liquid with the liquid fraction, abruptly
/// where no latent heat is released.
std::function<RayHit(double, double)> solidifying_field(const PassageSettings& settings);

/// Films a pool that keeps its shape: it is exposed once on the fine grid with point spread, motion
/// and pixels' areas, and every frame is that picture at its own sub-pixel place (cubic
/// interpolation, 1/8 px apart). @throws InputError as rosenthal_pool().
FilmedPassage film_passage(const PassageSettings& settings);

}  // namespace meltproof::imaging
