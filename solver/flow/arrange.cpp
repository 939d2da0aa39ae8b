// SPDX-License-Identifier: GPL-3.0-or-later
// Who is melt, who is wall, and the records that the passes read.
#include <algorithm>
#include <numeric>

#include "solver/flow/free_surface.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

void FreeSurfaceFlow::fit(std::size_t n) {
  for (auto* field : {&filled_, &area_, &exposed_, &pull_, &curvature_, &pressure_}) {
    field->resize(n, 0.0);
  }
  for (auto* field :
       {&colour_, &normal_, &missing_gradient_, &tension_gradient_, &acceleration_, &shift_}) {
    field->resize(n, Vector{});
  }
  density_gradient_.resize(std::max(n, density_gradient_.size()));
}

/// Who is melt and who is its wall. A wall knows it from the melt's lists, those of other ranks
/// included: who finds that its melt touches a copy tells the owner, who tells everybody.
void FreeSurfaceFlow::find_roles(const Particles& particles, const std::vector<Ghost>& ghosts,
                                 const NeighbourList& list) {
  const std::size_t n = particles.size();
  role_.assign(n, 0);
  for (auto* members : {&liquid_, &wall_, &liquid_copies_, &wall_copies_}) {
    members->clear();
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    if (particles.phase[i] == Phase::liquid && particles.home[i] != Home::nowhere) {
      (particles.home[i] == Home::here ? liquid_ : liquid_copies_).push_back(i);
      role_[i] = 1;
    }
  }
  for (const std::uint32_t i : liquid_) {
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j == list.void_index) {
        continue;
      }
      const std::uint32_t source = j < n ? j : ghosts[j - n].source;
      if (role_[source] == 0 && particles.phase[source] == Phase::solid) {
        role_[source] = 2;
        if (particles.home[source] == Home::here) {
          wall_.push_back(source);
        }
      }
    }
  }
  if (!halo_.empty()) {
    halo_.give_back(
        Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = role_[i] == 2 ? 1 : 0; },
        [&](std::uint32_t i, const double* in) {
          if (*in > 0 && role_[i] == 0) {
            role_[i] = 2;
            wall_.push_back(i);
          }
        });
    halo_.exchange(
        Halo::everybody, 1, [&](std::uint32_t i, double* out) { *out = role_[i]; },
        [&](std::uint32_t i, const double* in) {
          role_[i] = static_cast<std::uint8_t>(*in);
          if (role_[i] == 2) {
            wall_copies_.push_back(i);
          }
        });
    halo_.set_roles(role_);
  }
}

void FreeSurfaceFlow::arrange(const Particles& particles, const std::vector<Ghost>& ghosts,
                              const NeighbourList& list, bool everything,
                              const std::vector<std::uint32_t>& came_or_went) {
  const std::size_t n = particles.size(), all = list.void_index + std::size_t{1};
  // Whoever had a role before may have lost it; the records of all others still hold.
  std::vector<std::uint32_t> changed;
  if (everything || role_.size() != n) {
    changed.resize(n);
    std::iota(changed.begin(), changed.end(), 0U);
  } else {
    changed = came_or_went;
    for (const auto* members : near_melt()) {
      changed.insert(changed.end(), members->begin(), members->end());
    }
  }
  find_roles(particles, ghosts, list);
  std::sort(wall_.begin(), wall_.end());
  // A wall listens to the melt only, which is a small part of its list.
  melt_near_wall_.first.clear();
  melt_near_wall_.last.clear();
  melt_near_wall_.index.clear();
  for (const std::uint32_t i : wall_) {
    const std::size_t begin = melt_near_wall_.index.size();
    melt_near_wall_.first.push_back(begin);
    for (std::size_t k = list.first[i]; k < list.last[i]; ++k) {
      const std::uint32_t j = list.index[k];
      if (j != list.void_index && role_[j < n ? j : ghosts[j - n].source] == 1) {
        melt_near_wall_.index.push_back(j);
      }
    }
    while ((melt_near_wall_.index.size() - begin) % lane_count != 0) {
      melt_near_wall_.index.push_back(list.void_index);
    }
    melt_near_wall_.last.push_back(melt_near_wall_.index.size());
  }
  near_ghosts_.clear();
  for (std::uint32_t g = 0; g < ghosts.size(); ++g) {
    if (role_[ghosts[g].source] != 0) {
      near_ghosts_.push_back(g);
    }
  }
  fit(n);
  limited_.assign(n, 0);
  disorder_.assign(n, 0);
  // Solids stand still, so their records are written here and not again. Behind everybody stands
  // the void.
  changed.insert(changed.end(), wall_.begin(), wall_.end());
  changed.insert(changed.end(), wall_copies_.begin(), wall_copies_.end());
  motion_.resize(all);
  density_gradient_.resize(all);
  surface_.resize(all);
  outer_curvature_.assign(all, {});
  force_.resize(all);
  // One thread: an index may stand in the list twice.
  for (const std::uint32_t i : changed) {
    const Vector& at = particles.position[i];
    // What was lost takes part in nothing.
    const bool here = particles.phase[i] != Phase::lost && particles.home[i] != Home::nowhere;
    motion_[i] =
        here ? MotionRecord{at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0} : MotionRecord{};
    surface_[i] = here ? SurfaceRecord{at[0], at[1], at[2], 0, 0, 0, 0, 0} : SurfaceRecord{};
    force_[i] = ForceRecord{};
    // What a particle was when it last had a role must not come back with the next one.
    if (role_[i] == 0) {
      colour_[i] = {};
    }
    if (role_[i] != 1) {
      density_gradient_[i] = {};
      area_[i] = exposed_[i] = pull_[i] = curvature_[i] = pressure_[i] = 0;
      normal_[i] = acceleration_[i] = shift_[i] = missing_gradient_[i] = tension_gradient_[i] = {};
    }
    if (role_[i] == 2) {
      force_[i] = ForceRecord{at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0, 0, 0};
    }
  }
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const std::uint32_t source = ghosts[g].source;
    const Vector at = ghosts[g].image_of(particles.position[source]);
    motion_[n + g] = motion_[source];
    surface_[n + g] = surface_[source];
    force_[n + g] = force_[source];
    const DensityRecord& gradient = density_gradient_[source];
    const Vector image = ghosts[g].mirrored({gradient.x, gradient.y, gradient.z});
    density_gradient_[n + g] = {image[0], image[1], image[2]};
    motion_[n + g].x = surface_[n + g].x = at[0];
    motion_[n + g].y = surface_[n + g].y = at[1];
    motion_[n + g].z = surface_[n + g].z = at[2];
    if (role_[source] == 2) {
      force_[n + g].x = at[0];
      force_[n + g].y = at[1];
      force_[n + g].z = at[2];
    }
  }
  motion_.back() = MotionRecord{};
  density_gradient_.back() = DensityRecord{};
  surface_.back() = SurfaceRecord{};
  force_.back() = ForceRecord{};
}

void FreeSurfaceFlow::write_motion(const Particles& particles, const std::vector<Ghost>& ghosts) {
  const auto write = [&](std::uint32_t i) {
    const Vector &at = particles.position[i], &v = particles.velocity[i];
    motion_[i] = {at[0],
                  at[1],
                  at[2],
                  v[0],
                  v[1],
                  v[2],
                  particles.mass[i] / particles.density[i],
                  particles.density[i]};
  };
  for_each_particle(liquid_.size(), [&](std::size_t k) { write(liquid_[k]); });
  for_each_particle(liquid_copies_.size(), [&](std::size_t k) { write(liquid_copies_[k]); });
  const std::size_t n = particles.size();
  for (const std::uint32_t g : near_ghosts_) {
    const std::uint32_t source = ghosts[g].source;
    const Vector at = ghosts[g].image_of(particles.position[source]);
    const Vector v = ghosts[g].mirrored(particles.velocity[source]);
    motion_[n + g] = {
        at[0], at[1], at[2], v[0], v[1], v[2], motion_[source].volume, motion_[source].density};
  }
}

}  // namespace meltproof::solver
