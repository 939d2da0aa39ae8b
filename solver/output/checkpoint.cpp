// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/checkpoint.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "base/error.hpp"

namespace meltproof::solver {

// Numbers go through CBOR, which keeps every bit of a double, the ones that are no number too.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Extent, found, onset, end, length, width, depth, volume)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HistoryLine, time, step, beam_x, pool, any_liquid,
                                   peak_temperature, absorbed_power, absorbed, lost,
                                   enthalpy_change, largest_speed, mean_speed, liquid_volume,
                                   lost_particles, clumped, evaporated_mass)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NearestDistances, particles, clumped, smallest, median)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FilledVolume, mass_volume, filled, union_of_spheres, particles)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunProgress, lines, history, snapshots, beam_balance,
                                   start_enthalpy, start_additive, wall_time, melt, melt_volume)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LimiterCounts, wall_pressure, curvature, particle_steps,
                                   wall_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EnergyLedger, absorbed, reflected, missed, evaporated, radiated,
                                   convected, evaporated_mass)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepLimits, acoustic, viscous, capillary, thermal, species,
                                   gravity, surface)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepTimes, heat, species, surface, state, lists, flow)

namespace {

constexpr const char* kind = "meltproof checkpoint";

/// Every array of the state with its name and unit. @tparam State EngineState, const or not.
template <class State, class Visit>
void each_array(State& s, const Visit& visit) {
  auto& p = s.particles;
  visit("identity", p.identity, "1");
  visit("position", p.position, "m");
  visit("velocity", p.velocity, "m s-1");
  visit("mass", p.mass, "kg");
  visit("volume", p.volume, "m3");
  visit("density", p.density, "kg m-3");
  visit("enthalpy", p.enthalpy, "J kg-1");
  visit("concentration", p.concentration, "1");
  visit("temperature", p.temperature, "K");
  visit("liquid_fraction", p.liquid_fraction, "1");
  visit("peak_temperature", p.peak_temperature, "K");
  visit("melt_time", p.melt_time, "s");
  visit("freeze_time", p.freeze_time, "s");
  visit("cooling_rate", p.cooling_rate, "K s-1");
  visit("freeze_gradient", p.freeze_gradient, "K m-1");
  visit("origin", p.origin, "1");
  visit("phase", p.phase, "1");
  visit("melted", p.melted, "1");
  visit("listed_at", s.listed_at, "m");
  visit("mobile", s.mobile, "1");
  visit("fast", s.fast, "1");
  visit("slow_power", s.slow_power, "W m-3");
  visit("flow/acceleration", s.flow.acceleration, "m s-2");
  visit("flow/shift", s.flow.shift, "m s-2");
  visit("flow/area", s.flow.area, "m2");
  visit("flow/pressure", s.flow.pressure, "Pa");
  visit("flow/viscosity", s.flow.viscosity, "Pa s");
  visit("flow/surface_tension", s.flow.surface_tension, "N m-1");
  visit("flow/recoil", s.flow.recoil, "Pa");
}

/// The numbers of the state that are no arrays.
template <class State, class Visit>
void each_number(State& s, const Visit& visit) {
  visit("dimensions", s.particles.dimensions);
  visit("spacing", s.particles.spacing);
  visit("limiters", s.limiters);
  visit("ledger", s.ledger);
  visit("limits", s.limits);
  visit("times", s.times);
  visit("time", s.time);
  visit("round_time", s.round_time);
  visit("start_temperature", s.start_temperature);
  visit("steps", s.steps);
  visit("flow_steps", s.flow_steps);
  visit("list_builds", s.list_builds);
  visit("builds_since_sort", s.builds_since_sort);
  visit("lost", s.lost);
}

/// As what an entry is stored.
template <class T>
struct Stored {
  using Number = T;
  static constexpr std::size_t components = 1;
};
template <>
struct Stored<Vector> {
  using Number = double;
  static constexpr std::size_t components = 3;
};
template <>
struct Stored<Origin> {
  using Number = std::int32_t;
  static constexpr std::size_t components = 1;
};
template <>
struct Stored<Phase> {
  using Number = std::uint8_t;
  static constexpr std::size_t components = 1;
};

template <class T>
std::vector<typename Stored<T>::Number> flat(const std::vector<T>& values) {
  std::vector<typename Stored<T>::Number> numbers(values.size() * Stored<T>::components);
  static_assert(sizeof(T) == sizeof(numbers[0]) * Stored<T>::components);
  if (!values.empty()) {
    std::memcpy(numbers.data(), values.data(), values.size() * sizeof(T));
  }
  return numbers;
}

template <class T>
std::string checksum(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) {
    std::memcpy(bytes.data(), values.data(), bytes.size());
  }
  return sha256_text(bytes);
}

std::string snapshot_group(std::size_t number) { return fmt::format("snapshots/{:04}", number); }

std::filesystem::path snapshot_file(const std::filesystem::path& folder, std::size_t number) {
  return folder / fmt::format("snapshot_{:04}.h5", number);
}

/// @throws InputError if the file is damaged.
Checkpoint read(const ArtifactReader& reader) {
  Checkpoint checkpoint;
  checkpoint.file = reader.path();
  const auto bytes = reader.read<std::uint8_t>("numbers").values;
  if (checksum(bytes) != reader.attribute("numbers_sha256")) {
    throw InputError(fmt::format("{}: its numbers do not have the checksum that it names",
                                 reader.path().string()));
  }
  const nlohmann::json numbers = nlohmann::json::from_cbor(bytes);
  each_number(checkpoint.engine, [&](const char* name, auto& value) {
    value = numbers.at(name).get<std::decay_t<decltype(value)>>();
  });
  checkpoint.run = numbers.at("run").get<RunProgress>();
  each_array(checkpoint.engine, [&](const char* name, auto& values, const char*) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    const auto found = reader.read<typename Stored<T>::Number>(name).values;
    if (checksum(found) != numbers.at("sha256").at(name).template get<std::string>()) {
      throw InputError(fmt::format("{}: the field {} does not have the checksum that it names",
                                   reader.path().string(), name));
    }
    values.resize(found.size() / Stored<T>::components);
    if (!found.empty()) {
      std::memcpy(values.data(), found.data(), values.size() * sizeof(T));
    }
  });
  // The file is in the engine's order, and holds everybody.
  Particles& p = checkpoint.engine.particles;
  p.order.resize(p.size());
  std::iota(p.order.begin(), p.order.end(), 0U);
  p.home.assign(p.size(), Home::here);
  return checkpoint;
}

}  // namespace

CheckpointFolder::CheckpointFolder(const std::filesystem::path& run_folder)
    : folder_(run_folder / "checkpoints") {}

std::vector<std::filesystem::path> CheckpointFolder::files(const std::string& prefix) const {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && entry.path().extension() == ".h5") {
      found.push_back(entry.path());
    }
  }
  // The names hold the number of the step with leading zeros.
  std::sort(found.begin(), found.end());
  return found;
}

std::filesystem::path CheckpointFolder::write(const EngineState& engine, const RunProgress& run,
                                              const ArtifactWriter& snapshots,
                                              const Provenance& provenance) {
  for (std::size_t k = 0; k < run.snapshots; ++k) {
    if (!std::filesystem::exists(snapshot_file(folder_, k))) {
      ArtifactWriter piece(snapshot_file(folder_, k), "meltproof snapshot", true);
      snapshots.copy_to(piece, snapshot_group(k));
      piece.commit(provenance);
    }
  }
  auto place = folder_ / fmt::format("checkpoint_{:012}.h5", engine.steps);
  ArtifactWriter writer(place, kind, true);
  nlohmann::json numbers;
  each_number(engine, [&](const char* name, const auto& value) { numbers[name] = value; });
  numbers["run"] = run;
  each_array(engine, [&](const char* name, const auto& values, const char* units) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    using Number = typename Stored<T>::Number;
    const std::vector<Number> data = flat(values);
    std::vector<std::size_t> shape{values.size()};
    if (Stored<T>::components > 1) {
      shape.push_back(Stored<T>::components);
    }
    writer.write(name, std::span<const Number>(data), shape, units,
                 "of the state, see EngineState");
    numbers["sha256"][name] = checksum(data);
  });
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(numbers);
  writer.write("numbers", std::span<const std::uint8_t>(bytes), {bytes.size()}, "1",
               "everything else, as CBOR");
  writer.attribute("numbers_sha256", checksum(bytes));
  writer.commit(provenance);
  last_ = place;
  auto all = files("checkpoint_");
  while (all.size() > 2) {
    std::error_code ignored;
    std::filesystem::remove(all.front(), ignored);
    all.erase(all.begin());
  }
  return place;
}

std::optional<Checkpoint> CheckpointFolder::newest(const Provenance& provenance) const {
  auto all = files("checkpoint_");
  for (auto file = all.rbegin(); file != all.rend(); ++file) {
    std::string input, revision;
    std::optional<Checkpoint> found;
    try {
      const ArtifactReader reader(*file, kind);
      input = reader.attribute("resolved_input", "/provenance");
      revision = reader.attribute("revision", "/provenance");
      // One of another input or revision may hold other fields: it is refused below for what it is.
      if (input == provenance.resolved_input && revision == code_revision()) {
        found = read(reader);
      }
    } catch (const std::exception& problem) {
      spdlog::warn("{}; this checkpoint is passed over", problem.what());
      continue;
    }
    if (input != provenance.resolved_input) {
      throw InputError(fmt::format(
          "{} was made with another input than this run's: give the same case and --set values, or "
          "leave out --restart to begin anew",
          file->string()));
    }
    if (revision != code_revision()) {
      throw InputError(fmt::format(
          "{} was made by revision {}, this is {}: what both computed together would be no result "
          "of either; build that revision, or leave out --restart to begin anew",
          file->string(), revision, code_revision()));
    }
    last_ = *file;
    return found;
  }
  return std::nullopt;
}

void CheckpointFolder::restore_snapshots(ArtifactWriter& writer, std::size_t count) const {
  for (std::size_t k = 0; k < count; ++k) {
    writer.copy_from(ArtifactReader(snapshot_file(folder_, k), "meltproof snapshot"),
                     snapshot_group(k));
  }
}

void CheckpointFolder::clear() const {
  std::error_code ignored;
  for (const char* prefix : {"checkpoint_", "snapshot_", ".checkpoint_", ".snapshot_"}) {
    for (const auto& file : files(prefix)) {
      std::filesystem::remove(file, ignored);
    }
  }
  std::filesystem::remove(folder_, ignored);  // only if nothing else is in it
}

}  // namespace meltproof::solver
