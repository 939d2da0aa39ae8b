// SPDX-License-Identifier: GPL-3.0-or-later
// Who is melt, who is wall, their slots and lists, and the records that the passes read.
#include <algorithm>

#include "solver/flow/free_surface.hpp"
#include "solver/particles/loops.hpp"

namespace meltproof::solver {

/// Who is melt and who is its wall. A wall knows it from the melt's lists, those of other ranks
/// included: who finds that its melt touches a copy tells the owner, who tells everybody.
void FreeSurfaceFlow::find_roles(const Particles& particles, const std::vector<Ghost>& ghosts,
                                 const PackedLists& list) {
  const std::size_t n = particles.size();
  role_.assign(n, 0);
  wall_copies_.clear();
  select_indices(
      n,
      [&](std::uint32_t i) {
        return particles.phase[i] == Phase::liquid && particles.home[i] != Home::nowhere;
      },
      liquid_);
  for (const std::uint32_t i : liquid_) {
    role_[i] = 1;
  }
  liquid_copies_.clear();
  if (!halo_.empty()) {
    const auto copies = std::stable_partition(liquid_.begin(), liquid_.end(), [&](std::uint32_t i) {
      return particles.home[i] == Home::here;
    });
    liquid_copies_.assign(copies, liquid_.end());
    liquid_.erase(copies, liquid_.end());
  }
  for_each_sum(liquid_.size(), [&](std::size_t k) {
    list.each(liquid_[k], [&](std::uint32_t j) {
      const std::uint32_t source = j < n ? j : ghosts[j - n].source;
      if (particles.phase[source] == Phase::solid) {
#pragma omp atomic write
        role_[source] = 2;
      }
    });
  });
  select_indices(
      n, [&](std::uint32_t i) { return role_[i] == 2 && particles.home[i] == Home::here; }, wall_);
  if (settings_.walls_everywhere) {
    for (std::uint32_t i = 0; i < n; ++i) {
      if (role_[i] == 0 && particles.phase[i] == Phase::solid && particles.home[i] == Home::here) {
        role_[i] = 2;
        wall_.push_back(i);
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
  std::sort(wall_.begin(), wall_.end());
  if (!halo_.empty()) {
    const auto divide = [&](const std::vector<std::uint32_t>& members, Parts& parts) {
      parts.copied.clear();
      parts.inner.clear();
      for (std::uint32_t k = 0; k < members.size(); ++k) {
        (halo_.copied(members[k]) ? parts.copied : parts.inner).push_back(k);
      }
    };
    divide(liquid_, liquid_parts_);
    divide(wall_, wall_parts_);
  }
}

/// Slots in the order of the particles: melt and walls, images of them, the void, and behind it
/// whatever else walls have in reach.
void FreeSurfaceFlow::hand_out_slots(const Particles& particles, const std::vector<Ghost>& ghosts,
                                     const PackedLists& list) {
  const std::size_t n = particles.size();
  near_ghosts_.clear();
  // Of particles and, behind them, images and the void.
  slot_.assign(list.void_index + std::size_t{1}, nowhere);
  select_indices(
      n, [&](std::uint32_t i) { return role_[i] != 0; }, particle_);
  for_each_particle(particle_.size(),
                    [&](std::size_t s) { slot_[particle_[s]] = static_cast<std::uint32_t>(s); });
  auto next = static_cast<std::uint32_t>(particle_.size());
  for (std::uint32_t g = 0; g < ghosts.size(); ++g) {
    if (role_[ghosts[g].source] != 0) {
      slot_[n + g] = next++;
      near_ghosts_.push_back(g);
    }
  }
  list_.void_index = melt_near_wall_.void_index = next++;
  slot_[list.void_index] = list_.void_index;
  std::vector<std::uint8_t> behind(list.void_index + std::size_t{1}, 0);
  for_each_sum(wall_.size(), [&](std::size_t k) {
    list.each(wall_[k], [&](std::uint32_t j) {
      if (slot_[j] == nowhere) {
#pragma omp atomic write
        behind[j] = 1;
      }
    });
  });
  std::vector<std::uint32_t> found;
  select_indices(
      list.void_index, [&](std::uint32_t j) { return behind[j] != 0; }, found);
  behind_walls_.clear();
  for (const std::uint32_t j : found) {
    // What was lost takes part in nothing.
    if (particles.phase[j < n ? j : ghosts[j - n].source] == Phase::lost) {
      slot_[j] = list_.void_index;
    } else {
      slot_[j] = next++;
      behind_walls_.push_back(j);
    }
  }
  translate_lists(list);
  for (const std::uint32_t j : found) {
    slot_[j] = nowhere;
  }
  slot_.resize(n);
  const auto slots = [&](const std::vector<std::uint32_t>& members,
                         std::vector<std::uint32_t>& out) {
    out.resize(members.size());
    std::transform(members.begin(), members.end(), out.begin(),
                   [&](std::uint32_t i) { return slot_[i]; });
  };
  slots(liquid_, liquid_slot_);
  slots(wall_, wall_slot_);
  make_room_for_near();
}

/// Every field as long as there are slots, empty.
void FreeSurfaceFlow::fit() {
  const std::size_t own = particle_.size(), all = list_.void_index + std::size_t{1};
  for (auto* field : {&filled_, &area_, &exposed_, &pull_, &curvature_, &pressure_}) {
    field->assign(own, 0.0);
  }
  for (auto* field :
       {&colour_, &normal_, &missing_gradient_, &tension_gradient_, &acceleration_, &shift_}) {
    field->assign(own, Vector{});
  }
  melt_.assign(own, {});
  limited_.assign(own, 0);
  disorder_.assign(own, 0);
  density_gradient_.assign(all, {});
  outer_curvature_.assign(all, {});
  force_.assign(all, {});
  motion_.assign(all + behind_walls_.size(), {});
  surface_.assign(all + behind_walls_.size(), {});
}

void FreeSurfaceFlow::forget() {
  slot_.clear();
  arrived_.clear();
}

void FreeSurfaceFlow::arrange(const Particles& particles, const std::vector<Ghost>& ghosts,
                              const PackedLists& list) {
  // What is known of those who were there, by particle.
  std::vector<std::pair<std::uint32_t, FlowParticle>> known(slot_.empty() ? 0 : particle_.size());
  for_each_particle(known.size(), [&](std::size_t s) {
    known[s] = {particle_[s], particle(particle_[s])};
  });
  known.insert(known.end(), arrived_.begin(), arrived_.end());
  arrived_.clear();
  find_roles(particles, ghosts, list);
  hand_out_slots(particles, ghosts, list);
  fit();
  for (const auto& [i, what] : known) {
    if (role_[i] == 0) {
      continue;
    }
    const std::uint32_t s = slot_[i];
    colour_[s] = what.colour;
    melt_[s] = what.properties;
    // A wall has no more than that: what it was as melt must not come back when it melts again.
    if (role_[i] == 1) {
      const Vector& gradient = what.density_gradient;
      density_gradient_[s] = {gradient[0], gradient[1], gradient[2]};
      tension_gradient_[s] = what.tension_gradient;
      acceleration_[s] = what.acceleration;
      shift_[s] = what.shift;
      exposed_[s] = what.exposed;
      pressure_[s] = what.pressure;
    }
  }
  place_standing(particles, ghosts);
}

/// Solids stand still, so their places are written here and not again.
void FreeSurfaceFlow::place_standing(const Particles& particles, const std::vector<Ghost>& ghosts) {
  const auto place = [&](std::size_t s, std::uint32_t i, const Vector& at) {
    motion_[s] = {at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0};
    surface_[s] = {at[0], at[1], at[2], 0, 0, 0, 0, 0};
  };
  for (std::size_t s = 0; s < particle_.size(); ++s) {
    const std::uint32_t i = particle_[s];
    const Vector& at = particles.position[i];
    place(s, i, at);
    if (role_[i] == 2) {
      force_[s] = {at[0], at[1], at[2], 0, 0, 0, particles.volume[i], 0, 0, 0};
    }
  }
  for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
    const Vector at = ghost.image_of(particles.position[ghost.source]);
    place(s, ghost.source, at);
    force_[s] = force_[source];
    if (role_[ghost.source] == 2) {
      force_[s].x = at[0];
      force_[s].y = at[1];
      force_[s].z = at[2];
    }
    const DensityRecord& gradient = density_gradient_[source];
    const Vector image = ghost.mirrored({gradient.x, gradient.y, gradient.z});
    density_gradient_[s] = {image[0], image[1], image[2]};
  });
  const std::size_t n = particles.size();
  std::size_t s = list_.void_index;
  for (const std::uint32_t j : behind_walls_) {
    const std::uint32_t i = j < n ? j : ghosts[j - n].source;
    place(++s, i, j < n ? particles.position[i] : ghosts[j - n].image_of(particles.position[i]));
  }
}

void FreeSurfaceFlow::write_motion(const Particles& particles, const std::vector<Ghost>& ghosts) {
  const auto write = [&](std::uint32_t i) {
    const Vector &at = particles.position[i], &v = particles.velocity[i];
    motion_[slot_[i]] = {at[0],
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
  for_each_image(ghosts, [&](std::uint32_t s, const Ghost& ghost, std::uint32_t source) {
    const Vector at = ghost.image_of(particles.position[ghost.source]);
    const Vector v = ghost.mirrored(particles.velocity[ghost.source]);
    motion_[s] = {
        at[0], at[1], at[2], v[0], v[1], v[2], motion_[source].volume, motion_[source].density};
  });
}

}  // namespace meltproof::solver
