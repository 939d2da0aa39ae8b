// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/snapshot.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "solver/output/whole.hpp"

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

/// Writes fields of one snapshot, taking values by particle index in the order of identities.
class SnapshotWriter {
 public:
  SnapshotWriter(ArtifactWriter& writer, std::string group, const Particles& p)
      : writer_(writer), group_(std::move(group)), order_(p.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return p.identity[a] < p.identity[b]; });
  }

  /// value(i) of the particles; a Vector for three components.
  template <class Value>
  void write(const std::string& name, const Value& value) {
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const SnapshotField& f) { return name == f.name; });
    if (field == fields.end()) {
      throw std::logic_error("no field of a snapshot is called " + name);
    }
    switch (field->type) {
      case float32:
        return store<float>(*field, value);
      case float64:
        return store<double>(*field, value);
      case int32:
        return store<std::int32_t>(*field, value);
      case int64:
        return store<std::int64_t>(*field, value);
      case uint8:
        return store<std::uint8_t>(*field, value);
    }
  }

 private:
  template <class T, class Value>
  void store(const SnapshotField& field, const Value& value) {
    std::vector<T> data;
    data.reserve(field.components * order_.size());
    for (const std::uint32_t i : order_) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value(i))>, Vector>) {
        for (const double x : value(i)) {
          data.push_back(static_cast<T>(x));
        }
      } else {
        data.push_back(static_cast<T>(value(i)));
      }
    }
    std::vector<std::size_t> shape{order_.size()};
    if (field.components > 1) {
      shape.push_back(field.components);
    }
    writer_.write(group_ + field.name, std::span<const T>(data), shape, field.units,
                  field.description);
  }

  ArtifactWriter& writer_;
  std::string group_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::span<const SnapshotField> snapshot_fields() { return fields; }

void write_snapshot(ArtifactWriter* file, std::size_t number, const Engine& engine) {
  const Whole whole(engine);
  if (file == nullptr) {
    return;
  }
  ArtifactWriter& writer = *file;
  const Particles& p = whole.particles();
  const std::string group = fmt::format("snapshots/{:04}/", number);
  const Vector beam{engine.model().laser ? engine.model().laser->x(engine.time()) : 0, 0, 0};
  writer.write(group + "time", engine.time(), "s", "since the beam went on");
  writer.write(group + "beam", std::span<const double>(beam), {3}, "m",
               "where the beam meets the plate's plane");
  SnapshotWriter to(writer, group, p);
  const auto of = [](const auto& values) {
    return [&values](std::uint32_t i) { return values[i]; };
  };
  to.write("position", of(p.position));
  to.write("identity", of(p.identity));
  to.write("temperature", of(p.temperature));
  to.write("peak_temperature", of(p.peak_temperature));
  to.write("concentration", of(p.concentration));
  to.write("liquid_fraction", of(p.liquid_fraction));
  to.write("origin", of(p.origin));
  to.write("melted", of(p.melted));
  to.write("phase", of(p.phase));
  to.write("velocity", of(p.velocity));
  to.write("density", of(p.density));
  to.write("melt_time", of(p.melt_time));
  to.write("freeze_time", of(p.freeze_time));
  to.write("cooling_rate", of(p.cooling_rate));
  to.write("freeze_gradient", of(p.freeze_gradient));
  if (!whole.pressure().empty()) {
    to.write("pressure", [&](std::uint32_t i) {
      return p.phase[i] == Phase::liquid ? whole.pressure()[i] : 0.0;
    });
  }
}

}  // namespace meltproof::solver
