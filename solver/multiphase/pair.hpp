// SPDX-License-Identifier: GPL-3.0-or-later
// What every pass of the closed flow does with a pair first: its geometry, in two or three
// dimensions.
#pragma once

#include <array>

#include "solver/particles/ghosts.hpp"
#include "solver/particles/kernel.hpp"
#include "solver/particles/neighbours.hpp"

namespace meltproof::solver {

/// A vector whose components are numbers or lanes.
template <int D, class T>
using Components = std::array<T, D>;

template <int D, class T>
T dot(const Components<D, T>& a, const Components<D, T>& b) {
  T sum = a[0] * b[0];
  for (std::size_t d = 1; d < D; ++d) {
    sum += a[d] * b[d];
  }
  return sum;
}

/// r_ij = r_i - r_j in m, and its length.
template <int D, class T>
struct PairGeometry {
  Components<D, T> r;
  T squared, distance;

  PairGeometry(const Components<D, T>& at_i, const Components<D, T>& at_j) {
    for (std::size_t d = 0; d < D; ++d) {
      r[d] = at_i[d] - at_j[d];
    }
    squared = dot<D>(r, r);
    distance = square_root(squared);
  }

  /// s in grad_i W = s r_ij, m^-(d+2), never positive.
  T gradient(const QuinticSpline& kernel) const {
    // The floor only keeps two particles in one place from dividing by zero.
    return kernel.slope(distance) / larger(distance, T(1e-9 * kernel.smoothing_length));
  }
};

/// Three fields of a record as one vector; the third is left out in two dimensions.
template <class Record>
using VectorField = std::array<double Record::*, 3>;

template <int D, class Record>
Components<D, Lane> gather(const Record* records, const std::uint32_t* index,
                           const VectorField<Record>& field) {
  Components<D, Lane> result;
  for (std::size_t d = 0; d < D; ++d) {
    result[d] = gather(records, index, field[d]);
  }
  return result;
}

/// The same particle in every lane.
template <int D, class Record>
Components<D, Lane> spread(const Record& record, const VectorField<Record>& field) {
  Components<D, Lane> result;
  for (std::size_t d = 0; d < D; ++d) {
    result[d] = record.*field[d];
  }
  return result;
}

template <class Record>
void set(Record& record, const VectorField<Record>& field, const Vector& value) {
  for (std::size_t d = 0; d < 3; ++d) {
    record.*field[d] = value[d];
  }
}

template <class Record>
Vector get(const Record& record, const VectorField<Record>& field) {
  return {record.*field[0], record.*field[1], record.*field[2]};
}

}  // namespace meltproof::solver
