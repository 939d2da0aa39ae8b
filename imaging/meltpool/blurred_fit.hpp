// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares of a blurred model with a smooth field and a front: the machinery of
// tail_model.hpp.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "imaging/meltpool/tail_model.hpp"

namespace meltproof::imaging::blurred_fit {

inline constexpr int along_order = 4, across_order = 4;  // of the polynomial
inline constexpr int terms = (along_order + 1) * (across_order + 1);
inline constexpr int parameters = terms + 5;
inline constexpr int theta_star = terms, ratio = terms + 1, interval = terms + 2,
                     variance = terms + 3, cap = terms + 4;
inline constexpr int fine = 3;           // rows of the model a line: the front bends within a pixel
inline constexpr double edge_reach = 3;  // px, at the leading edge and at the sides
inline constexpr double reach = 7;       // px along a line on either side of the start, in the tail

/// Coefficients of the polynomial (powers of y within powers of x), then what TailLaw holds, then
/// by how much the variance of the blur is larger than that of the patch, px^2, and ln(S - dark)
/// that no metal exceeds, since it boils there.
using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

/// Which parameters besides the polynomial a fit may change.
struct Freedom {
  bool theta_star = false, ratio = false, interval = false, variance = false, cap = false;
};

/// What is known of the parameters before a fit: independent normal distributions.
struct Prior {
  Vector mean = Vector::Zero();
  Vector weight = Vector::Zero();  ///< 1 / u^2; 0: nothing is known
  void know(int parameter, double value, double u) {
    mean(parameter) = value;
    weight(parameter) = 1 / (u * u);
  }
};

/// The part of the stack that is fitted, and the model's own finer grid around it.
struct Patch {
  std::size_t column = 0, line = 0;  // of the stack, first
  int columns = 0, lines = 0;
  int margin_columns = 0, margin_rows = 0;
  double centre_column = 0, centre_line = 0;
  bool even = false;     // a side view: the surface is at centre_line
  double scale = 6;      // px, makes the polynomial's arguments of order one
  double brightest = 0;  // ln S of the brightest place, as it is blurred
  Blur blur;             // px
  Prior prior;
  double narrowest = 0, widest = 0;    // intervals that a shoulder may have
  double to_beam = 0, half_width = 0;  // px, of the pool from the start: how fast it may change
  double steepness = steepness_of_steel, u_steepness = 0;
  std::vector<double> value, weight;  // lines * columns; weight 0: not compared
  std::vector<double> smooth;         // the same values over half a pixel: where to begin
  std::vector<int> crossing;          // of every line, column where it falls to the start
  std::vector<double> mask;           // of every row of the model: part of it that is metal

  int width() const { return columns + 2 * margin_columns; }
  int height() const { return lines * fine + 2 * margin_rows; }
  double x(double model_column) const {
    return (static_cast<double>(column) + model_column - margin_columns - centre_column) /
           Stack::samples / scale;
  }
  double row(int model_row) const {  // in lines of the stack
    return static_cast<double>(line) + (model_row - margin_rows - 0.5 * (fine - 1)) / fine;
  }
  double y(double stack_line) const { return (stack_line - centre_line) / scale; }
  /// The model's row in the middle of a line of the patch.
  int middle(int patch_line) const { return margin_rows + patch_line * fine + fine / 2; }
  /// Square of the standard deviations of the blur after its variance has changed.
  Eigen::Vector2d variances(double change) const {
    return {blur.along * blur.along + change, blur.across * blur.across + change};
  }
};

/// Whether the polynomial has this power of y. In a side view only y^2 and y^4 are used, since the
/// pool is the upper half's mirror image below the plate's surface.
inline bool has_term(const Patch& patch, int power_of_y) {
  return !patch.even || power_of_y % 2 == 0;
}

/// Which end of the pool is fitted.
enum class End { tail, leading };

/// The blur with what a stack's columns add by their width.
Blur with_columns(const Blur& blur);

/// The part of the stack within reach of the place where each line falls to `start` (ln(S - dark)):
/// seven pixels in the tail, without the hottest part under the beam; three at the leading edge.
/// For the leading edge the stack must be reversed along its lines.
std::optional<Patch> make_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start, End end);

/// Makes it known that a tail's field changes over the pool's own size: heat conducted from the
/// beam makes a field that varies along the scan over the way back to the beam and across it over
/// the pool's half width (Cauchy's estimate of the coefficients of a power series). What is curved
/// more is noise.
void know_smoothness(Patch& tail);

/// The part of the stack within three pixels of where it falls to `start` across the scan, at its
/// widest. @param side +1 towards higher lines, -1 towards lower ones.
std::optional<Patch> make_side_patch(const Stack& stack, double dark, const Blur& blur,
                                     const PlateEdge& edge, double start, int side);

/// The smooth field at the polynomial's arguments, and its change with x and with y.
struct Field {
  double theta = 0, by_x = 0, by_y = 0;
};
Field field_at(const Patch& patch, const Vector& p, double x, double y);
/// Change of theta there with every parameter.
Vector terms_at(const Patch& patch, double x, double y);
TailLaw law_of(const Patch& patch, const Vector& p);

/// Model, its derivatives, and what of the normal equations each line gives.
struct Linearised {
  std::vector<Matrix> normal;  ///< a line; lower triangle
  std::vector<Vector> gradient;
  std::vector<double> chi_squared;
  std::vector<double> blurred;  ///< lines * columns, signal above dark of the model
  double prior = 0;             ///< chi-squared of what is known beforehand
  double total() const;
};
Linearised linearise(const Patch& patch, const Vector& p, bool derivatives);

/// ln(S - dark) of the blurred model at a place.
double blurred_log_signal(const Patch& patch, const Vector& p, double x, double stack_line);

/// Parameters within the bounds of the model.
Vector bounded(const Patch& patch, Vector p, const Freedom& free);

/// One damped step of Gauss and Newton.
Vector solve(const Patch& patch, Matrix normal, Vector gradient, const Vector& p, double damping,
             const Freedom& free);

/// Covariance of the free parameters at a minimum, to second order; zero for the others.
Matrix covariance(const Patch& patch, const Linearised& at, const Freedom& free);

/// Change of the free parameters at a minimum for one unit of a parameter that is not free, to
/// first order.
Vector response(const Patch& patch, const Linearised& at, const Freedom& free, int parameter);

/// Least squares by Levenberg and Marquardt.
Vector minimise(const Patch& patch, Vector p, const Freedom& free, int steps);

/// Where the fit begins: a front of this law (its signal is set) where every line falls to the
/// start, and the polynomial through what is left of ln S.
Vector first_guess(const Patch& patch, const TailLaw& law);

/// Sum over lines.
template <class T>
T sum(const std::vector<T>& v) {
  T total = v.front();
  for (std::size_t i = 1; i < v.size(); ++i) total += v[i];
  return total;
}

/// A place: the polynomial's argument along the scan, and the line with its fraction.
struct Place {
  double x = 0, row = 0;
};
/// Outermost place where theta falls to `level`, over the patch's own rows of metal.
std::optional<Place> outermost(const Patch& patch, const Vector& p, const PlateEdge& edge,
                               double level);
/// The same across the scan, over the patch's own columns. @param side as of make_side_patch().
std::optional<Place> widest_place(const Patch& patch, const Vector& p, double level, int side);
/// Pixels along a line of the stack.
double along_line(const Patch& patch, const Place& place);

}  // namespace meltproof::imaging::blurred_fit
