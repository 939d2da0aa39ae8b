// SPDX-License-Identifier: GPL-3.0-or-later
// Exact solutions that the engine is compared with.
#pragma once

namespace meltproof::solver {

/// A stripe of concentration 1 between z1 and z2 that diffuses, in a box [0, height] without flux
/// through its walls: C = 1/2 sum over images [erf((z - z1)/s) - erf((z - z2)/s)], s = sqrt(4 D t).
struct StripeSolution {
  double z1 = 0, z2 = 0, height = 0;  ///< m
  double operator()(double z, double spread) const;
};

/// The paper's Eqs. 9 and 10: two half-space solutions that meet at z0 = (z1 + z2)/2. They solve
/// the stripe only while s is small against its width (paper errata 4).
double printed_stripe(double z, double z1, double z2, double spread);

/// Stefan problem with one phase: lambda exp(lambda^2) erf(lambda) = St/sqrt(pi); the front is at
/// 2 lambda sqrt(alpha t). @param stefan St = c (T_wall - T_melt)/L, positive.
double stefan_lambda(double stefan);

/// Temperature in the melt at x, T_wall - (T_wall - T_melt) erf(x/(2 sqrt(alpha t)))/erf(lambda);
/// T_melt behind the front.
double stefan_temperature(double x, double time, double diffusivity, double lambda, double wall,
                          double melting);

/// Two half spaces that touch at x = 0, T_left on x < 0 and T_right on x > 0 at t = 0. (Carslaw &
/// Jaeger, Conduction of Heat in Solids, 2.15)
struct ContactSolution {
  double temperature_left = 0, temperature_right = 0;    ///< K
  double conductivity_left = 0, conductivity_right = 0;  ///< W m-1 K-1
  double diffusivity_left = 0, diffusivity_right = 0;    ///< m2 s-1
  double operator()(double x, double time) const;
};

}  // namespace meltproof::solver
