// SPDX-License-Identifier: GPL-3.0-or-later
// Exact and published solutions of flows.
#pragma once

#include <array>
#include <vector>

namespace meltproof::solver {

/// One layer of a flow between plates.
struct ShearLayer {
  double thickness = 0;  ///< m
  double viscosity = 0;  ///< Pa s
  double force = 0;      ///< along the plates, N m-3
};

/// Steady flow of one or two layers between plates: the lower stands, the upper moves. Couette,
/// Poiseuille and their two-fluid forms. u'' = -force/viscosity in each layer; u and the stress are
/// continuous.
class ShearFlow {
 public:
  ShearFlow(std::vector<ShearLayer> layers, double upper_speed);
  /// Speed along the plates at the height y, m s-1.
  double operator()(double y) const;

 private:
  std::vector<ShearLayer> layers_;
  std::vector<double> stress_, speed_;  // at the foot of each layer
};

/// Rate of decay of the speed of a Taylor-Green vortex in a unit box with four vortices: -8 pi^2/Re
/// times U/L, so that u = exp(b t). (Taylor & Green 1937)
double taylor_green_rate(double reynolds);

/// Speeds on the middle lines of a cavity whose lid moves with 1. (Ghia, Ghia & Shin 1982, Tables I
/// and II) @throws InputError unless reynolds is 100 or 1000.
struct CavityReference {
  std::vector<double> y, u;  ///< u on the vertical line x = 1/2, walls left out
  std::vector<double> x, v;  ///< v on the horizontal line y = 1/2, walls left out
};
CavityReference cavity_reference(double reynolds);

/// Speed of a spherical drop that its surface tension, falling with temperature, drives towards the
/// hot side, inertia and convected heat negligible: U = 2 |sigma_T| |grad T| R / [(2 mu + 3 mu_d)
/// (2 + k_d/k)], mu and k of the fluid around, mu_d and k_d of the drop. Equal properties: 2/15.
/// (Young, Goldstein & Block 1959)
double migration_speed(double tension_slope, double temperature_gradient, double radius,
                       double viscosity, double viscosity_drop, double conductivity,
                       double conductivity_drop);

}  // namespace meltproof::solver
