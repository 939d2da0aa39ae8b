// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/bench/single_loop.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace meltproof::solver {
namespace {

NeighbourList padded(const NeighbourList& list) {
  NeighbourList result;
  result.void_index = list.void_index;
  result.reach = list.reach;
  for (std::size_t i = 0; i < list.last.size(); ++i) {
    result.first.push_back(list_place(result.index.size()));
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      if (list.index[k] != list.void_index) {
        result.index.push_back(list.index[k]);
      }
    }
    while ((result.index.size() - result.first.back()) % single_count != 0) {
      result.index.push_back(list.void_index);
    }
    result.last.push_back(list_place(result.index.size()));
  }
  result.first.push_back(list_place(result.index.size()));
  return result;
}

/// Not in fixed point: what is needed as it is.
PairFields<float> rounded(const PairFields<double>& r, double h) {
  const auto f = [](double value) { return static_cast<float>(value); };
  return {.volume = f(r.volume / (h * h * h)),
          .vx = f(r.vx),
          .vy = f(r.vy),
          .vz = f(r.vz),
          .density = f(r.density),
          // Beside viscous stress, which is a velocity over a step here, pressure carries a step.
          .pressure = f(r.pressure * h * SingleBlock::place_step),
          .viscosity = f(r.viscosity),
          .conductivity = f(r.conductivity),
          .diffusivity = f(r.diffusivity)};
}

}  // namespace

SingleBlock to_single(const PairBlock& block) {
  const double h = block.kernel.smoothing_length;
  SingleBlock single;
  single.h = h;
  single.list = padded(block.list);
  const std::size_t n = block.size();
  Vector lower{1e30, 1e30, 1e30}, upper{-1e30, -1e30, -1e30};
  for (std::size_t i = 0; i < n; ++i) {
    const PairFields<double>& r = block.records[i];
    const Vector at{r.x, r.y, r.z};
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], at[d]);
      upper[d] = std::max(upper[d], at[d]);
    }
  }
  // Half of the range is for particles, so that the void, half a range away, is far from all.
  const double range = 0x1p32 * SingleBlock::place_step;
  for (std::size_t d = 0; d < 3; ++d) {
    if (upper[d] - lower[d] > range / 2 * h) {
      throw InputError("the block spans more smoothing lengths than its fixed point can tell");
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const PairFields<double>& r = block.records[i];
    PairFields<float> s = rounded(r, h);
    const auto place = [&](double x, std::size_t d) {
      return fixed_point((x - (lower[d] + upper[d]) / 2) / h, SingleBlock::place_step);
    };
    s.x = place(r.x, 0);
    s.y = place(r.y, 1);
    s.z = place(r.z, 2);
    s.temperature = fixed_point(r.temperature, SingleBlock::temperature_step);
    s.concentration = fixed_point(r.concentration, SingleBlock::concentration_step);
    single.records.push_back(s);
  }
  PairFields<float> none;
  none.x = none.y = none.z = fixed_point(range / 2, SingleBlock::place_step);
  single.records.push_back(none);
  return single;
}

/// Differences stay in the steps of their fixed points, so distances are in steps of h while
/// volumes are in h^3, and what is summed up is off by powers of two, which come last: W' is that
/// of h = 1, W'/r and F are a step's share of it.
void five_terms_single(const SingleBlock& block, std::vector<PairRates>& rates) {
  constexpr double steps = 1 / SingleBlock::place_step;
  QuinticSpline kernel(steps, 3);
  kernel.normalisation *= steps * steps * steps * steps;
  const double h = block.h;
  const PairFields<float>* all = block.records.data();
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const PairFields<float>& r = all[i];
    const auto d = [](float value) { return SingleLane(static_cast<double>(value)); };
    // What is in fixed point enters as differences, own less other's, so its own is zero.
    const PairFields<SingleLane> own{.x = 0.0,
                                     .y = 0.0,
                                     .z = 0.0,
                                     .volume = d(r.volume),
                                     .vx = d(r.vx),
                                     .vy = d(r.vy),
                                     .vz = d(r.vz),
                                     .density = d(r.density),
                                     .pressure = d(r.pressure),
                                     .viscosity = d(r.viscosity),
                                     .temperature = 0.0,
                                     .conductivity = d(r.conductivity),
                                     .concentration = 0.0,
                                     .diffusivity = d(r.diffusivity)};
    const SingleLane square = own.volume * own.volume;
    PairSums<SingleLane> sums;
    for (std::size_t k = block.list.first[i]; k < block.list.last[i]; k += single_count) {
      PairFields<SingleLane> other = gather_single(all, &block.list.index[k]);
      other.x = fixed_steps(r.x, other.x);
      other.y = fixed_steps(r.y, other.y);
      other.z = fixed_steps(r.z, other.z);
      other.temperature = fixed_steps(r.temperature, other.temperature);
      other.concentration = fixed_steps(r.concentration, other.concentration);
      add_pair(sums, own, square, other, kernel);
    }
    rates[i] = {static_cast<double>(r.density) * sum_lanes(sums.compression) / h,
                sum_lanes(sums.fx) * steps * h,
                sum_lanes(sums.fy) * steps * h,
                sum_lanes(sums.fz) * steps * h,
                sum_lanes(sums.power) * steps * SingleBlock::temperature_step / (h * h),
                sum_lanes(sums.concentration) * steps * SingleBlock::concentration_step / (h * h)};
  }
}

Deviation deviation(const std::vector<PairRates>& rates, const std::vector<PairRates>& exact) {
  std::array<double, 4> off{}, size{};
  const auto add = [&](std::size_t term, double found, double wanted) {
    off[term] += (found - wanted) * (found - wanted);
    size[term] += wanted * wanted;
  };
  for (std::size_t i = 0; i < exact.size(); ++i) {
    add(0, rates[i].density, exact[i].density);
    add(1, rates[i].fx, exact[i].fx);
    add(1, rates[i].fy, exact[i].fy);
    add(1, rates[i].fz, exact[i].fz);
    add(2, rates[i].power, exact[i].power);
    add(3, rates[i].concentration, exact[i].concentration);
  }
  const std::array<std::string, 4> names{"continuity", "pressure and viscosity", "heat", "species"};
  Deviation result;
  for (std::size_t term = 0; term < off.size(); ++term) {
    result.of[term] = std::sqrt(off[term] / size[term]);
    if (result.of[term] >= result.worst) {
      result.worst = result.of[term];
      result.term = names[term];
    }
  }
  return result;
}

}  // namespace meltproof::solver
