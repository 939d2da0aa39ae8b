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

/// Density in kg m-3 of a mixture whose mass fraction `concentration` is AlSi10Mg (taken as
/// aluminium) and the rest steel (taken as iron): volumes add, 1/rho = C/rho_Al + (1 - C)/rho_Fe.
/// Beyond 0 and 1, where noise may carry C, it is that of the nearer end.
double mixture_density(double concentration);

/// The range of electrons in such a mixture: 1/(rho R) is the mean of that of the two elements,
/// weighted by mass, as energy losses per mass add. @returns m
double kanaya_okayama_range_in_mixture(double concentration, double beam_energy_kev);

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

/// The same where the matrix, and with it the width, varies along the line. The range of X-rays is
/// inverse to the density, so the volume has one width in mass per area, m(x) = int rho dx: the
/// profile is convolved with a Gaussian of `sigma_mass` over m. Steel beside aluminium is then seen
/// with a narrow flank on its own side and a wide one on the other. What is conserved: the beam
/// spends all its electrons at each place (weights add to 1: a uniform sample is seen uniform), and
/// since the kernel is symmetric in m, the mass int rho C dx stays as well.
/// @param densities kg m-3 at every point; also where there is no material, as which the beam's way
///        through it counts
/// @param sigma_mass kg m-2
/// @throws InputError as convolve_gaussian(), or if the lengths differ.
std::vector<double> convolve_in_matrix(std::span<const double> values,
                                       std::span<const double> densities, double step,
                                       double sigma_mass);

}  // namespace meltproof::validation
