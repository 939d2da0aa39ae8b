// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/verification/flow_setup.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Dense>

#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

bool is_fluid(const Particles& particles, std::size_t i) {
  return particles.phase[i] == Phase::liquid || particles.phase[i] == Phase::gas;
}

}  // namespace

FlowStart fill_lattice(int dimensions, double spacing, const Vector& lower, const Vector& upper,
                       const std::vector<Fluid>& fluids,
                       const std::function<Placement(const Vector&)>& place) {
  FlowStart start;
  start.particles.dimensions = dimensions;
  start.particles.spacing = spacing;
  std::array<long, 3> count{1, 1, 1};
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimensions); ++d) {
    count[d] = std::lround((upper[d] - lower[d]) / spacing);
  }
  const double volume = std::pow(spacing, dimensions);
  std::int64_t identity = 0;
  for (long k = 0; k < count[2]; ++k) {
    for (long j = 0; j < count[1]; ++j) {
      for (long i = 0; i < count[0]; ++i) {
        const auto middle = [&](std::size_t d, long index) {
          return lower[d] + (static_cast<double>(index) + 0.5) * spacing;
        };
        const Vector at{middle(0, i), middle(1, j), dimensions == 3 ? middle(2, k) : 0};
        const Placement what = place(at);
        const double density =
            fluids[static_cast<std::size_t>(std::max<std::int32_t>(0, what.fluid))].density;
        start.particles.add(identity++, at, density * volume, volume, 0, 0, Origin::plate);
        start.particles.phase.back() = what.phase;
        start.particles.velocity.back() = what.velocity;
        start.fluid.push_back(what.fluid);
      }
    }
  }
  return start;
}

void set_stiffness(ClosedFlowModel& model, double density, double sound_speed, double background) {
  model.stiffness = density * sound_speed * sound_speed;
  model.background = background * model.stiffness;
}

VerificationRun start_run(const ClosedFlow& flow, const std::array<const char*, 2>& position,
                          const std::array<const char*, 2>& value) {
  VerificationRun run;
  run.particles = flow.particles().size();
  run.position_name = position[0];
  run.position_unit = position[1];
  run.position_scale = 1;
  run.value_name = value[0];
  run.value_unit = value[1];
  return run;
}

void show(VerificationRun& run, double position, double value, double exact) {
  run.position.push_back(position);
  run.value.push_back(value);
  run.exact.push_back(exact);
}

Domain box(const Vector& lower, const Vector& upper, const std::array<Face, 3>& face) {
  Domain domain;
  domain.lower = lower;
  domain.upper = upper;
  for (std::size_t d = 0; d < 3; ++d) {
    domain.face[d] = {face[d], face[d]};
  }
  return domain;
}

void run_until(ClosedFlow& flow, double time) {
  while (flow.time() < time) {
    const double left = time - flow.time();
    const double step = std::min(flow.stable_step(), left);
    // No sliver at the end: its share is spread over the last two steps.
    flow.advance(step < left && left < 1.5 * step ? left / 2 : step);
    if (time - flow.time() < 1e-9 * time) {
      break;
    }
  }
}

void relax(ClosedFlow& flow, double amplitude, std::size_t steps) {
  std::mt19937_64 random(20251122);
  const double reach = amplitude * flow.particles().spacing;
  Particles& particles = flow.particles();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!is_fluid(particles, i)) {
      continue;
    }
    for (std::size_t d = 0; d < static_cast<std::size_t>(particles.dimensions); ++d) {
      const double uniform = static_cast<double>(random() >> 11U) * 0x1.0p-53;
      particles.position[i][d] += reach * (2 * uniform - 1);
    }
  }
  flow.stop();
  const double step = flow.stable_step();
  for (std::size_t k = 0; k < steps; ++k) {
    flow.advance(step);
    flow.stop();
  }
}

double read_at(const ClosedFlow& flow, const Vector& at,
               const std::function<double(std::size_t)>& value) {
  const Particles& particles = flow.particles();
  Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  std::size_t found = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!is_fluid(particles, i)) {
      continue;
    }
    const double x = particles.position[i][0] - at[0], y = particles.position[i][1] - at[1],
                 z = particles.position[i][2] - at[2], squared = x * x + y * y + z * z;
    if (squared >= flow.kernel().support() * flow.kernel().support()) {
      continue;
    }
    const double h = flow.kernel().smoothing_length;
    const Eigen::Vector4d basis(1, x / h, y / h, z / h);
    const double weight = flow.kernel().value(std::sqrt(squared));
    moment += weight * basis * basis.transpose();
    right += weight * value(i) * basis;
    ++found;
  }
  if (found < 4) {
    throw std::logic_error("too few fluid particles near the place that is read");
  }
  // In two dimensions the last row is empty: it stands for itself.
  if (particles.dimensions == 2) {
    moment(3, 3) = 1;
  }
  return moment.ldlt().solve(right)(0);
}

double largest_speed(const ClosedFlow& flow) {
  const Particles& particles = flow.particles();
  return block_max(particles.size(), 0, [&](std::size_t i) {
    const Vector& v = particles.velocity[i];
    return is_fluid(particles, i) ? std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) : 0;
  });
}

Clumping clumping(const ClosedFlow& flow) {
  const Particles& particles = flow.particles();
  const auto ghosts = make_ghosts(particles, flow.model().domain, particles.spacing * 1.5);
  const auto list = make_neighbours(particles, ghosts, particles.spacing * 1.5);
  Clumping result{1.5, 0};
  std::size_t below = 0, count = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!is_fluid(particles, i)) {
      continue;
    }
    double nearest = 1.5;
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j == list.void_index) {
        continue;
      }
      const Vector& other =
          j < particles.size() ? particles.position[j] : ghosts[j - particles.size()].position;
      double squared = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        squared += std::pow(particles.position[i][d] - other[d], 2);
      }
      nearest = std::min(nearest, std::sqrt(squared) / particles.spacing);
    }
    result.nearest = std::min(result.nearest, nearest);
    below += nearest < 0.5 ? 1 : 0;
    ++count;
  }
  result.share_below_half = static_cast<double>(below) / static_cast<double>(count);
  return result;
}

}  // namespace meltproof::solver
