// SPDX-License-Identifier: GPL-3.0-or-later
// Exact solutions that the engine is compared with.
#pragma once

#include <functional>

namespace meltproof::solver {

/// A stripe of concentration 1 between z1 and z2 that diffuses, in a box [0, height] without flux
/// through its walls: C = 1/2 sum over images [erf((z - z1)/s) - erf((z - z2)/s)], s = sqrt(4 D t).
struct StripeSolution {
  double z1 = 0, z2 = 0, height = 0;  ///< m
  double operator()(double z, double spread) const;
};

/// The same stripe in a box that repeats itself every `length`.
double periodic_stripe(double z, double z1, double z2, double length, double spread);

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

/// Neumann's problem with two phases of equal density and specific heat: lambda sqrt(pi) =
/// St [exp(-l^2)/erf(l) - superheat sqrt(r) exp(-l^2/r)/erfc(l/sqrt(r))], l = lambda, r the
/// conductivity of the far phase over that of the phase at the wall; the front is at
/// 2 lambda sqrt(alpha t) with alpha at the wall. (Carslaw & Jaeger, 11.2)
/// @param superheat |T_far - T_melt| / |T_wall - T_melt|.
double neumann_lambda(double stefan, double superheat, double conductivity_ratio);

/// The temperature field of that problem.
struct NeumannSolution {
  double wall = 0, melting = 0, far = 0;             ///< K
  double diffusivity_wall = 0, diffusivity_far = 0;  ///< m2 s-1
  double lambda = 0;
  double operator()(double x, double time) const;
};

/// A Gaussian beam of 1/e2 radius `radius` on the surface z = 0 of a half space, moving along x
/// from x = 0 at t = 0, conduction only with constant properties. (Eagar & Tsai, Welding Journal 62
/// (1983) 346) Nothing is lost.
struct EagarTsai {
  double absorbed_power = 0;                 ///< W
  double radius = 0, speed = 0;              ///< m, m s-1
  double conductivity = 0, diffusivity = 0;  ///< W m-1 K-1, m2 s-1
  double start_temperature = 0;              ///< K

  /// K at (x, y, depth) in the frame of the half space; depth >= 0. GSL quadrature, relative
  /// error below 1e-8.
  double operator()(double x, double y, double depth, double time) const;

  /// Length along x, full width and depth of the region above `temperature` at `time`, m.
  struct Pool {
    double front = 0, tail = 0, width = 0, depth = 0;
  };
  Pool pool(double temperature, double time) const;
};

/// Temperature of a thin film that only evaporates: rho c h dT/dt = -q(T), by GSL's adaptive
/// Runge-Kutta. @param flux q in W m-2 of T in K; @param capacity rho c h, J m-2 K-1.
double cooling_film(const std::function<double(double)>& flux, double capacity, double start,
                    double time);

/// Two half spaces that touch at x = 0, T_left on x < 0 and T_right on x > 0 at t = 0. (Carslaw &
/// Jaeger, Conduction of Heat in Solids, 2.15)
struct ContactSolution {
  double temperature_left = 0, temperature_right = 0;    ///< K
  double conductivity_left = 0, conductivity_right = 0;  ///< W m-1 K-1
  double diffusivity_left = 0, diffusivity_right = 0;    ///< m2 s-1
  double operator()(double x, double time) const;
};

}  // namespace meltproof::solver
