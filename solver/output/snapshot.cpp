// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/snapshot.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace meltproof::solver {

void write_snapshot(ArtifactWriter& writer, std::size_t number, const Engine& engine) {
  const Particles& p = engine.particles();
  const std::size_t n = p.size();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return p.identity[a] < p.identity[b]; });
  const std::string group = fmt::format("snapshots/{:04}/", number);
  const auto field = [&](const auto& values, auto convert) {
    std::vector<decltype(convert(values[0]))> sorted(n);
    std::transform(order.begin(), order.end(), sorted.begin(),
                   [&](std::uint32_t i) { return convert(values[i]); });
    return sorted;
  };
  const auto single = [](double value) { return static_cast<float>(value); };
  const auto same = [](auto value) { return value; };
  std::vector<float> position;
  position.reserve(3 * n);
  for (const std::uint32_t i : order) {
    for (const double x : p.position[i]) {
      position.push_back(static_cast<float>(x));
    }
  }
  const Vector beam{engine.model().laser ? engine.model().laser->x(engine.time()) : 0, 0, 0};
  writer.write(group + "time", engine.time(), "s", "since the beam went on");
  writer.write(group + "beam", std::span<const double>(beam), {3}, "m",
               "where the beam meets the plate's plane");
  writer.write(group + "identity", std::span<const std::int64_t>(field(p.identity, same)), {n}, "1",
               "of the particle, for life");
  writer.write(group + "position", std::span<const float>(position), {n, 3}, "m",
               "x along the scan, y across, z up from the plate's surface");
  writer.write(group + "temperature", std::span<const float>(field(p.temperature, single)), {n},
               "K", "temperature");
  writer.write(group + "peak_temperature",
               std::span<const float>(field(p.peak_temperature, single)), {n}, "K",
               "highest temperature so far");
  writer.write(group + "concentration", std::span<const double>(field(p.concentration, same)), {n},
               "1", "mass fraction of the additive");
  writer.write(group + "liquid_fraction", std::span<const float>(field(p.liquid_fraction, single)),
               {n}, "1", "0 solid, 1 liquid");
  writer.write(group + "origin",
               std::span<const std::int32_t>(
                   field(p.origin, [](Origin o) { return static_cast<std::int32_t>(o); })),
               {n}, "1", "0 plate, 1 base powder, 2 additive powder");
  writer.write(group + "melted", std::span<const std::uint8_t>(field(p.melted, same)), {n}, "1",
               "1 if ever fully liquid");
}

}  // namespace meltproof::solver
