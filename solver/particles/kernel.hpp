// SPDX-License-Identifier: GPL-3.0-or-later
// The quintic spline and the pair geometry that every term is written in.
#pragma once

#include <numbers>
#include <stdexcept>

#include "solver/particles/lanes.hpp"

namespace meltproof::solver {

/// **Quintic spline** W(r) = a_d / h^d [(3-q)^5 - 6 (2-q)^5 + 15 (1-q)^5], q = r/h, each bracket
/// only while positive; support 3 h. a_1 = 1/120, a_2 = 7/(478 pi), a_3 = 1/(120 pi). (Morris et
/// al. 1997)
struct QuinticSpline {
  double smoothing_length = 0;    ///< h, m
  double normalisation = 0;       ///< a_d / h^d, m^-d
  double inverse_length = 0;      ///< 1/h, 1/m
  double regularisation = 0;      ///< (0.1 h)^2, m2: keeps F finite for particles that meet
  double second_moment = 0;       ///< <r^2> = int W r^2 dV, m2
  double operator_scale = 1;      ///< s in F, see set_lattice_moments()
  double operator_curvature = 0;  ///< k in F, m^-2

  /// @param h smoothing length in m; @param dimensions 1, 2 or 3.
  QuinticSpline(double h, int dimensions)
      : smoothing_length(h), inverse_length(1 / h), regularisation(0.01 * h * h) {
    const double pi = std::numbers::pi;
    switch (dimensions) {
      case 1:
        normalisation = 1 / (120 * h);
        second_moment = h * h / 2;
        break;
      case 2:
        normalisation = 7 / (478 * pi * h * h);
        second_moment = h * h * 2771 / 2868;
        break;
      case 3:
        normalisation = 1 / (120 * pi * h * h * h);
        second_moment = h * h * 7 / 5;
        break;
      default:
        throw std::logic_error("a kernel has one, two or three dimensions");
    }
  }

  double support() const { return 3 * smoothing_length; }

  /// W in m^-d at the distance r in m.
  template <class T>
  T value(const T& r) const {
    const T q = r * inverse_length;
    return normalisation *
           (fifth(positive_part(T(3.0) - q)) - 6.0 * fifth(positive_part(T(2.0) - q)) +
            15.0 * fifth(positive_part(T(1.0) - q)));
  }

  /// dW/dr in m^-(d+1), never positive.
  template <class T>
  T slope(const T& r) const {
    const T q = r * inverse_length;
    return (-5.0 * normalisation * inverse_length) *
           (fourth(positive_part(T(3.0) - q)) - 6.0 * fourth(positive_part(T(2.0) - q)) +
            15.0 * fourth(positive_part(T(1.0) - q)));
  }

  /// F = s (1 - k r^2) (r_ij . grad_i W) / (r^2 + (0.1 h)^2) in m^-(d+2); with s = 1 and k = 0 the
  /// form of Cleary & Monaghan (1999).
  template <class T>
  T gradient_factor(const T& r_squared) const {
    const T r = square_root(r_squared);
    return operator_scale * (1.0 - operator_curvature * r_squared) * r * slope(r) /
           (r_squared + regularisation);
  }

 private:
  template <class T>
  static T fourth(const T& x) {
    const T square = x * x;
    return square * square;
  }
  template <class T>
  static T fifth(const T& x) {
    return fourth(x) * x;
  }
};

/// Which moments of F are set to their exact values on the undisturbed cubic lattice.
enum class LatticeMoments {
  none,  ///< F as it is: the Laplacian of x^2 is 1.99 at h = spacing in three dimensions (errata 1)
  second,  ///< -sum_j V F x^2 = 1: the Laplacian of x^2 is exactly 2
  fourth,  ///< and sum_j V F x^4 = 0: the leading error of the Laplacian vanishes
};

/// Sets operator_scale and operator_curvature of `kernel` for a lattice of the given spacing. Both
/// are constants, so the exchange of a pair stays antisymmetric and nothing is lost. With the
/// fourth moment F changes sign beyond some 1.7 spacings, so a jump can overshoot: 0.3 % of it at
/// most is measured.
void set_lattice_moments(QuinticSpline& kernel, double spacing, int dimensions,
                         LatticeMoments moments);

/// The kernel of a lattice: h = smoothing_ratio times spacing, with those moments set.
QuinticSpline lattice_kernel(double spacing, double smoothing_ratio, int dimensions,
                             LatticeMoments moments);

}  // namespace meltproof::solver
