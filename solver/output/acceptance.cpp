// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/acceptance.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/particles/loops.hpp"

namespace meltproof::solver {
namespace {

constexpr double clump = 0.5;     // spacings: nearer is clumped
constexpr double farthest = 3.0;  // spacings: farther is alone

template <class Choose>
std::vector<std::uint8_t> choose(const Particles& p, const Choose& which) {
  std::vector<std::uint8_t> chosen(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    chosen[i] = which(i) ? 1 : 0;
  }
  return chosen;
}

double relative_volume(const FilledVolume& v) {
  return v.mass_volume > 0 ? v.filled / v.mass_volume - 1 : 0;
}

double relative_union(const FilledVolume& v) {
  return v.mass_volume > 0 ? v.union_of_spheres / (lattice_union_of_spheres * v.mass_volume) : 1;
}

nlohmann::json distances_json(const NearestDistances& d) {
  return {{"particles", d.particles},
          {"clumped_fraction", d.clumped},
          {"smallest_spacings", d.smallest},
          {"median_spacings", d.median}};
}

nlohmann::json volume_json(const FilledVolume& v) {
  return {{"mass_over_density_um3", 1e18 * v.mass_volume},
          {"filled_um3", 1e18 * v.filled},
          {"filled_relative_error", relative_volume(v)},
          {"union_of_spheres_over_lattice", relative_union(v)}};
}

std::string line(const std::string& what, const std::string& found, const std::string& asked,
                 bool held) {
  return fmt::format("  {:<44} {:>16}   {:<22} {}\n", what, found, asked,
                     held ? "held" : "NOT HELD");
}

bool holds(const AcceptanceSettings& asked, const NearestDistances& d,
           std::optional<double> mean = {}) {
  return mean.value_or(d.particles == 0 ? 0 : d.clumped) < asked.clumped_asked;
}
bool holds(const AcceptanceSettings& asked, const FilledVolume& v) {
  return std::abs(relative_volume(v)) <= asked.volume_asked;
}

}  // namespace

NearestDistances measure_nearest(const MetalGrid& grid, const Particles& particles,
                                 const std::vector<std::uint8_t>& chosen) {
  std::vector<std::uint32_t> which;
  for (const std::uint32_t i : grid.by_identity()) {
    if (chosen[i] != 0) {
      which.push_back(i);
    }
  }
  NearestDistances result;
  result.particles = which.size();
  if (which.empty()) {
    return result;
  }
  std::vector<double> distance(which.size());
  for_each_particle(which.size(), [&](std::size_t k) {
    distance[k] = nearest_distance(grid, particles, which[k], farthest * particles.spacing) /
                  particles.spacing;
  });
  const auto near =
      std::count_if(distance.begin(), distance.end(), [](double d) { return d < clump; });
  result.clumped = static_cast<double>(near) / static_cast<double>(which.size());
  result.smallest = *std::min_element(distance.begin(), distance.end());
  const auto middle = distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2);
  std::nth_element(distance.begin(), middle, distance.end());
  result.median = *middle;
  return result;
}

double clumped_fraction(const Particles& particles) {
  const MetalGrid grid(particles);
  return measure_nearest(
             grid, particles,
             choose(particles, [&](std::size_t i) { return particles.phase[i] == Phase::liquid; }))
      .clumped;
}

std::size_t count_lost(const Particles& particles, const Vector& lower, const Vector& upper) {
  std::size_t lost = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    bool here = particles.phase[i] != Phase::lost;
    for (std::size_t d = 0; d < 3; ++d) {
      const double x = particles.position[i][d];
      here = here && x >= lower[d] && x <= upper[d] && std::isfinite(x);
    }
    lost += here ? 0 : 1;
  }
  return lost;
}

Acceptance measure_acceptance(const Particles& p, const AcceptanceSettings& settings) {
  Acceptance a;
  a.asked = settings;
  a.spacing = p.spacing;
  a.lost = count_lost(p, settings.lower, settings.upper);
  const MetalGrid grid(p, settings.lower, settings.upper);
  const auto liquid = choose(p, [&](std::size_t i) { return p.phase[i] == Phase::liquid; });
  const auto melted = choose(p, [&](std::size_t i) { return p.melted[i] != 0; });
  a.liquid = measure_nearest(grid, p, liquid);
  a.ever_melted = measure_nearest(grid, p, melted);
  a.liquid_volume = fill(grid, p, liquid);
  a.ever_melted_volume = fill(grid, p, melted);
  if (settings.from < settings.to) {
    a.has_height = true;
    a.height = measure_height(grid, p, settings.from, settings.to, settings.centre,
                              settings.width > 0 ? settings.width : 2 * p.spacing);
  }
  return a;
}

bool Acceptance::pass() const {
  return lost == 0 && holds(asked, liquid, clumped_mean) && holds(asked, ever_melted) &&
         holds(asked, liquid_volume) && holds(asked, ever_melted_volume) &&
         (!has_height || height.mean >= asked.height_asked * spacing);
}

nlohmann::json Acceptance::json() const {
  nlohmann::json result = {
      {"pass", pass()},
      {"lost_particles", lost},
      {"liquid", distances_json(liquid)},
      {"ever_melted", distances_json(ever_melted)},
      {"asked",
       {{"clumped_fraction_below", asked.clumped_asked},
        {"lost_particles", 0},
        {"filled_relative_error_within", asked.volume_asked},
        {"refilled_mean_height_above_um", 1e6 * asked.height_asked * spacing}}}};
  result["liquid"].update(volume_json(liquid_volume));
  result["ever_melted"].update(volume_json(ever_melted_volume));
  if (clumped_mean) {
    result["liquid"]["clumped_fraction_mean"] = *clumped_mean;
  }
  if (has_height) {
    result["refilled_track"] = {{"from_um", 1e6 * asked.from},
                                {"to_um", 1e6 * asked.to},
                                {"width_um", 1e6 * asked.width},
                                {"mean_height_um", 1e6 * height.mean},
                                {"lowest_section_mean_um", 1e6 * height.lowest_mean},
                                {"deepest_point_um", 1e6 * height.deepest},
                                {"share_below_one_spacing", height.share_of_pits}};
  }
  return result;
}

std::string Acceptance::table() const {
  std::string out = fmt::format("  {:<44} {:>16}   {}\n", "acceptance", "found", "asked");
  const auto part = [&](const std::string& name, const NearestDistances& d, const FilledVolume& v,
                        std::optional<double> mean) {
    if (d.particles == 0) {
      out += fmt::format("  {:<44} {:>16}\n", name, "none");
      return;
    }
    out += line(fmt::format("{}: nearer than 0.5 spacings{}", name, mean ? ", mean" : ""),
                fmt::format("{:.2f} %", 100 * mean.value_or(d.clumped)),
                fmt::format("below {:g} %", 100 * asked.clumped_asked), holds(asked, d, mean));
    out += fmt::format("  {:<44} {:>16}   of {} particles\n", "  nearest, median, spacings",
                       fmt::format("{:.2f}, {:.2f}", d.smallest, d.median), d.particles);
    out += line(fmt::format("{}: volume against mass", name),
                fmt::format("{:+.1f} %", 100 * relative_volume(v)),
                fmt::format("within {:g} %", 100 * asked.volume_asked), holds(asked, v));
  };
  part("melt", liquid, liquid_volume, clumped_mean);
  part("ever melted", ever_melted, ever_melted_volume, {});
  out += line("particles lost", fmt::format("{}", lost), "none", lost == 0);
  if (has_height) {
    out += line(fmt::format("refilled height, x = {:.0f} to {:.0f} um, mean", 1e6 * asked.from,
                            1e6 * asked.to),
                fmt::format("{:+.1f} um", 1e6 * height.mean),
                fmt::format("above {:.1f} um", 1e6 * asked.height_asked * spacing),
                height.mean >= asked.height_asked * spacing);
    out += fmt::format(
        "  {:<44} {:>16}   {:.1f} % lie a spacing below the plate\n",
        "  lowest section, deepest point",
        fmt::format("{:+.1f}, {:+.1f} um", 1e6 * height.lowest_mean, 1e6 * height.deepest),
        100 * height.share_of_pits);
  }
  return out;
}

}  // namespace meltproof::solver
