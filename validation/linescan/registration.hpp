// SPDX-License-Identifier: GPL-3.0-or-later
// Lays a measured profile over a simulated one: the origin of a line scan is not known exactly.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "validation/metrics/curve.hpp"

namespace meltproof::validation {

/// A feature that both lines show, instead of the best fit.
struct Landmark {
  /// Where each profile crosses one level most steeply, halfway between the smallest and the
  /// largest measured value; otherwise the places below.
  bool half_height = true;
  double simulated = 0;  ///< m along the simulated line
  double measured = 0;   ///< m along the measured one
};

/// What may be fitted. The vertical scale never is.
struct RegistrationBounds {
  double shift = 0;                       ///< largest shift either way, m; 0: none is fitted
  bool reversible = false;                ///< the line may have been scanned from its other end
  std::optional<Landmark> landmark = {};  ///< sets the shift, which still must keep to its bound
};

struct Registration {
  double shift = 0;              ///< m; the simulated profile is read at measured position + shift
  bool reversed = false;         ///< the simulated profile is read from its end
  std::size_t fitted = 0;        ///< number of fitted parameters: shift and direction
  bool by_landmark = false;      ///< the shift is that of a landmark; it counts as fitted
  CurveMetrics before, after;    ///< on the same points, without and with the registration
  std::vector<double> position;  ///< m, measured points that were compared
  std::vector<double> simulated, measured;  ///< at these points, registered
  std::vector<double> simulated_before;     ///< at these points, before registration
  std::vector<std::size_t> index;           ///< of these points among the measured ones
  std::vector<double> place;                ///< m, where the simulated line is read for them
};

/// The shift (and direction) within `bounds` of the smallest RMSE. Compared are those measured
/// points that lie on the simulated profile, and on material, for every allowed shift: so no shift
/// is rewarded for losing points.
/// @param uncertainty of the measured values; empty if unknown
/// @param leave_out indices of measured points that are not to be compared
/// @throws InputError if fewer than three points can be compared, a landmark is not found, or it
/// asks for more shift than allowed.
Registration register_profiles(std::span<const double> simulated_position,
                               std::span<const double> simulated,
                               std::span<const double> measured_position,
                               std::span<const double> measured,
                               std::span<const double> uncertainty,
                               std::span<const std::size_t> leave_out,
                               const RegistrationBounds& bounds);

}  // namespace meltproof::validation
