// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares of a blurred model with a smooth field and a front: the machinery of
// tail_model.hpp.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <opencv2/core.hpp>

#include "imaging/meltpool/tail_model.hpp"

namespace meltproof::imaging::blurred_fit {

inline constexpr int along_order = 4, across_order = 4;  // of the polynomial
inline constexpr int terms = (along_order + 1) * (across_order + 1);
inline constexpr int parameters = terms + 3;
inline constexpr int theta_star = terms, rise = terms + 1, interval = terms + 2;
inline constexpr int fine = 3;  // rows of the model a line: the front bends within a pixel
inline constexpr double softness =
    0.03;  // of theta, rounds the corners of F by a quarter of a pixel
inline constexpr double leading_reach = 3;  // px
inline constexpr double reach = 7;          // px along a line on either side of the start
inline constexpr double narrowest = 0.02, widest = 1.2;  // interval of theta

/// Coefficients of the polynomial (powers of y within powers of x), then theta*, rise, interval.
using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

/// The part of the stack that is fitted, and the model's own finer grid around it.
struct Patch {
  std::size_t column = 0, line = 0;  // of the stack, first
  int columns = 0, lines = 0;
  int margin_columns = 0, margin_rows = 0;
  double centre_column = 0, centre_line = 0;
  bool even = false;                  // a side view: the surface is at centre_line
  double scale = 6;                   // px, makes the polynomial's arguments of order one
  double highest = 0;                 // ln S that the polynomial may reach in the margins
  cv::Mat along, across;              // kernels
  std::vector<double> value, weight;  // lines * columns; weight 0: not compared
  std::vector<double> smooth;         // the same values over half a pixel: where to begin
  std::vector<int> crossing;          // of every line, column where it falls to the start
  std::vector<double> mask;           // of every row of the model: part of it that is metal

  int width() const { return columns + 2 * margin_columns; }
  int height() const { return lines * fine + 2 * margin_rows; }
  double x(int model_column) const {
    return (static_cast<double>(column) + model_column - margin_columns - centre_column) /
           Stack::samples / scale;
  }
  double row(int model_row) const {  // in lines of the stack
    return static_cast<double>(line) + (model_row - margin_rows - 0.5 * (fine - 1)) / fine;
  }
  double y(int model_row) const { return (row(model_row) - centre_line) / scale; }
};

/// Which end of the pool is fitted.
enum class End { tail, leading };

/// The part of the stack within reach of the place where each line falls to `start` (ln(S - dark)):
/// seven pixels in the tail, without the hottest part under the beam; three at the leading edge.
/// For the leading edge the stack must be reversed along its lines.
std::optional<Patch> make_patch(const Stack& stack, double dark, const Blur& blur,
                                const PlateEdge& edge, double start, End end);

/// The smooth field at the polynomial's arguments.
double theta_at(const Patch& patch, const Vector& p, double x, double y);

/// Model, its derivatives, and what of the normal equations each line gives.
struct Linearised {
  std::vector<Matrix> normal;  ///< a line; lower triangle
  std::vector<Vector> gradient;
  std::vector<double> chi_squared;
  cv::Mat blurred;  ///< signal above dark on the fine grid
  double total() const;
};
Linearised linearise(const Patch& patch, const Vector& p, bool derivatives);

/// Parameters within the bounds of the model; without a front its height is zero.
Vector bounded(Vector p, bool with_front);

/// One damped step of Gauss and Newton.
Vector solve(Matrix normal, const Vector& gradient, double damping, bool with_front,
             bool fixed_interval = false);

/// Least squares by Levenberg and Marquardt.
Vector minimise(const Patch& patch, Vector p, bool with_front, int steps);

/// Where the fit begins: a front of this height and interval where every line falls to the start,
/// and the polynomial through what is left of ln S.
Vector first_guess(const Patch& patch, double height, double width);

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
/// Pixels along a line of the stack.
double along_line(const Patch& patch, const Place& place);

}  // namespace meltproof::imaging::blurred_fit
