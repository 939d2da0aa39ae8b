// SPDX-License-Identifier: GPL-3.0-or-later
// What an electron beam sees of a profile: ranges of electrons and X-rays, and the blurring.
#pragma once

#include <span>
#include <vector>

namespace meltproof::validation {

/// A pure element as a target for electrons.
struct Target {
  double atomic_weight = 0;  ///< g mol-1
  double atomic_number = 0;
  double density = 0;  ///< kg m-3
};
inline constexpr Target iron{55.845, 26, 7874};
inline constexpr Target aluminium{26.982, 13, 2700};

/// Energy of the K edge of aluminium in keV, below which no Al-K X-ray is made.
inline constexpr double aluminium_k_edge = 1.5596;

/// Range of electrons in m (Kanaya & Okayama 1972): 0.0276 A E^1.67 / (Z^0.89 rho) um, with E in
/// keV and rho in g/cm3.
double kanaya_okayama_range(const Target& target, double beam_energy_kev);

/// Depth from which X-rays come, in m (Anderson & Hasler 1966): 0.064 (E^1.68 - E_c^1.68) / rho um.
/// @throws InputError if the beam's energy is not above the edge.
double anderson_hasler_range(double density, double beam_energy_kev, double edge_energy_kev);

/// Standard deviation in m of the Gaussian that stands for a generation range: the range is taken
/// as the full width at half maximum, sigma = range / (2 sqrt(2 ln 2)). A modelling choice: the
/// range is a size of the volume, its distribution within is not Gaussian.
double interaction_sigma(double range);

/// The profile seen with a Gaussian of `sigma`: values on an even grid of spacing `step` (same
/// unit). Each value is the weighted mean of the points that there are: NaN marks a place without
/// material and gives no signal, and stays NaN where it stands; the ends of the line count as such
/// places.
/// @throws InputError if step is not positive or sigma negative.
std::vector<double> convolve_gaussian(std::span<const double> values, double step, double sigma);

}  // namespace meltproof::validation
