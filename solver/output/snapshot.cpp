// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/snapshot.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/parallel/shared_artifact.hpp"
#include "solver/parallel/shared_rows.hpp"

namespace meltproof::solver {
namespace {

using enum FieldType;
constexpr std::array fields{
    SnapshotField{"position", "m", "x along the scan, y across, z up from the plate's surface",
                  float32, 3},
    SnapshotField{"identity", "1", "of the particle, for life", int64, 1},
    SnapshotField{"temperature", "K", "temperature", float32, 1},
    SnapshotField{"peak_temperature", "K", "highest temperature so far", float32, 1},
    SnapshotField{"concentration", "1", "mass fraction of the additive", float64, 1},
    SnapshotField{"liquid_fraction", "1", "0 solid, 1 liquid", float32, 1},
    SnapshotField{"origin", "1", "0 plate, 1 base powder, 2 additive powder", int32, 1},
    SnapshotField{"melted", "1", "1 if ever fully liquid", uint8, 1},
    SnapshotField{"phase", "1", "0 solid, a wall to the melt; 1 liquid; 2 gas; 3 lost", uint8, 1},
    SnapshotField{"velocity", "m s-1", "of the melt; zero where nothing flows", float32, 3},
    SnapshotField{"density", "kg m-3", "of the flow; the reference density at rest", float32, 1},
    SnapshotField{"pressure", "Pa", "of the flow; zero in the solid", float32, 1},
    SnapshotField{"melt_time", "s", "last time above its liquidus first; -1: never", float32, 1},
    SnapshotField{"freeze_time", "s", "last time below its liquidus again; -1: never", float32, 1},
    SnapshotField{"cooling_rate", "K s-1", "at freeze_time", float32, 1},
    SnapshotField{"freeze_gradient", "K m-1",
                  "magnitude of the temperature gradient at freeze_time", float32, 1},
};

/// The fields of one state: visit(field, value), where value(i) is entry i's. Vectors have three
/// components.
template <class Visit>
void each_value(const Engine& engine, const Visit& visit) {
  const Particles& p = engine.particles();
  const auto of = [](const auto& values) {
    return [&values](std::uint32_t i) { return values[i]; };
  };
  const auto field = [](const std::string& name) -> const SnapshotField& {
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const SnapshotField& f) { return name == f.name; });
    if (found == fields.end()) {
      throw std::logic_error("no field of a snapshot is called " + name);
    }
    return *found;
  };
  visit(field("position"), of(p.position));
  visit(field("identity"), of(p.identity));
  visit(field("temperature"), of(p.temperature));
  visit(field("peak_temperature"), of(p.peak_temperature));
  visit(field("concentration"), of(p.concentration));
  visit(field("liquid_fraction"), of(p.liquid_fraction));
  visit(field("origin"), of(p.origin));
  visit(field("melted"), of(p.melted));
  visit(field("phase"), of(p.phase));
  visit(field("velocity"), of(p.velocity));
  visit(field("density"), of(p.density));
  visit(field("melt_time"), of(p.melt_time));
  visit(field("freeze_time"), of(p.freeze_time));
  visit(field("cooling_rate"), of(p.cooling_rate));
  visit(field("freeze_gradient"), of(p.freeze_gradient));
  if (engine.model().flow) {
    visit(field("pressure"), [&](std::uint32_t i) {
      return p.phase[i] == Phase::liquid ? engine.flow().pressure(i) : 0.0;
    });
  }
}

/// Calls act(T{}) with the number type of a field.
template <class Act>
void with_type(const SnapshotField& field, const Act& act) {
  switch (field.type) {
    case float32:
      return act(float{});
    case float64:
      return act(double{});
    case int32:
      return act(std::int32_t{});
    case int64:
      return act(std::int64_t{});
    case uint8:
      return act(std::uint8_t{});
  }
}

}  // namespace

std::span<const SnapshotField> snapshot_fields() { return fields; }

std::string snapshot_group(std::size_t number) { return fmt::format("snapshots/{:04}", number); }

void write_snapshot(const std::filesystem::path& place, std::size_t number, const Engine& engine,
                    const Provenance& provenance) {
  const Particles& p = engine.particles();
  std::vector<std::uint32_t> own;
  double largest = -1;
  for (std::uint32_t i = 0; i < p.size(); ++i) {
    if (p.home[i] == Home::here) {
      own.push_back(i);
      largest = std::max(largest, static_cast<double>(p.identity[i]));
    }
  }
  const auto range = static_cast<std::size_t>(engine.ranks().largest(largest) + 1);
  const SharedRows rows(engine.ranks(), p.identity, std::move(own), range);
  const std::string group = snapshot_group(number) + "/";
  SharedArtifact file(
      engine.ranks(), place, "meltproof snapshot",
      [&](ArtifactWriter& writer) {
        const Vector beam{engine.model().laser ? engine.model().laser->x(engine.time()) : 0, 0, 0};
        writer.write(group + "time", engine.time(), "s", "since the beam went on");
        writer.write(group + "beam", std::span<const double>(beam), {3}, "m",
                     "where the beam meets the plate's plane");
        each_value(engine, [&](const SnapshotField& field, const auto&) {
          std::vector<std::size_t> shape{rows.total()};
          if (field.components > 1) {
            shape.push_back(field.components);
          }
          with_type(field, [&]<class T>(T) {
            writer.reserve<T>(group + field.name, shape, field.units, field.description);
          });
        });
      },
      provenance);
  each_value(engine, [&](const SnapshotField& field, const auto& value) {
    with_type(field, [&]<class T>(T) {
      const std::vector<T> part = rows.bring<T>(field.components, [&](std::uint32_t i, T* out) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value(i))>, Vector>) {
          const Vector v = value(i);
          std::transform(v.begin(), v.end(), out, [](double x) { return static_cast<T>(x); });
        } else {
          *out = static_cast<T>(value(i));
        }
      });
      file.write<T>(group + field.name, rows.first(), part);
    });
  });
  file.commit();
}

}  // namespace meltproof::solver
