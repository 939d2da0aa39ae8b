// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/checkpoint_file.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "solver/output/checkpoint_fields.hpp"
#include "solver/parallel/agreement.hpp"
#include "solver/parallel/shared_artifact.hpp"
#include "solver/parallel/shared_rows.hpp"

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

/// SHA-256 in hexadecimal digits.
using Digest = std::array<char, 64>;

Digest digest(const std::string& bytes) {
  Digest d{};
  const std::string text = sha256_text(bytes);
  std::copy_n(text.begin(), d.size(), d.begin());
  return d;
}

/// The checksum of a field, on the root. Collective. @param rows of this rank, @param in_blocks how
/// many of them belong to each of its blocks.
template <class Number>
std::string checksum(const Ranks& ranks, std::span<const Number> rows, std::size_t width,
                     const std::vector<std::size_t>& in_blocks) {
  std::vector<Digest> digests;
  std::size_t at = 0;
  for (const std::size_t count : in_blocks) {
    std::string bytes(count * width * sizeof(Number), '\0');
    if (count > 0) {
      std::memcpy(bytes.data(), rows.data() + at, bytes.size());
    }
    digests.push_back(digest(bytes));
    at += count * width;
  }
  std::string all;
  for (const Digest& d : ranks.to_root(digests)) {
    all.append(d.begin(), d.end());
  }
  return sha256_text(all);
}

std::string checksum(const std::vector<std::uint8_t>& bytes) {
  return sha256_text({bytes.begin(), bytes.end()});
}

/// The rows of a data set that one rank reads.
struct Part {
  std::size_t first = 0, count = 0;
  std::vector<std::size_t> in_blocks;  ///< rows in each of its blocks of identities
};

/// The same of what is known of liquid particles only. Collective. @param phase of this rank's.
Part liquid_part(const std::vector<Phase>& phase, const Ranks& ranks) {
  Part part;
  for (std::size_t at = 0; at < phase.size(); at += SharedRows::block) {
    const auto from = phase.begin() + static_cast<std::ptrdiff_t>(at);
    const auto to =
        phase.begin() + static_cast<std::ptrdiff_t>(std::min(phase.size(), at + SharedRows::block));
    part.in_blocks.push_back(static_cast<std::size_t>(std::count(from, to, Phase::liquid)));
    part.count += part.in_blocks.back();
  }
  part.first = ranks.before(part.count);
  return part;
}

/// The data set of all checksums, in the order of each_field(), as text.
constexpr const char* checksums_name = "checksums";

}  // namespace

void write_checkpoint(const std::filesystem::path& place, const Engine& engine,
                      const RunProgress& run, const Provenance& provenance) {
  const Ranks& ranks = engine.ranks();
  const EngineState state = engine.state_numbers();
  const StateView view = engine.state_view();
  const Particles& p = view.particles;
  std::vector<std::uint32_t> molten;
  double largest = -1;
  for (const std::uint32_t i : view.own) {
    largest = std::max(largest, static_cast<double>(p.identity[i]));
    if (view.flow && p.phase[i] == Phase::liquid) {
      molten.push_back(i);
    }
  }
  const auto range = static_cast<std::size_t>(ranks.largest(largest) + 1);
  const SharedRows everybody(ranks, p.identity, view.own, range),
      liquid(ranks, p.identity, std::move(molten), range);
  if (everybody.total() != range) {
    // Reading ranks find the blocks of the checksums by counting rows.
    throw std::logic_error("the identities of the particles are not 0, 1, 2, ...");
  }
  const auto rows_of = [&](Of whom) -> const SharedRows& {
    return whom == Of::liquid ? liquid : everybody;
  };
  SharedArtifact file(
      ranks, place, checkpoint_kind,
      [&](ArtifactWriter& writer) {
        nlohmann::json numbers;
        each_number(state, [&](const char* name, const auto& value) { numbers[name] = value; });
        numbers["run"] = run;
        const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(numbers);
        writer.write("numbers", std::span<const std::uint8_t>(bytes), {bytes.size()}, "1",
                     "everything that is not of single particles, as CBOR");
        writer.attribute("numbers_sha256", checksum(bytes));
        std::size_t fields = 0;
        each_field(
            [&](const char* name, const char* units, Of whom, const auto&, const auto& value) {
              using T = decltype(value(view, 0U));
              std::vector<std::size_t> shape{rows_of(whom).total()};
              if (Stored<T>::components > 1) {
                shape.push_back(Stored<T>::components);
              }
              writer.reserve<typename Stored<T>::Number>(name, shape, units,
                                                         "of the state, see EngineState");
              ++fields;
            });
        writer.reserve<std::uint8_t>(checksums_name, {fields, sizeof(Digest)}, "1",
                                     "of each field in the order of the code, as text");
      },
      provenance);
  std::vector<std::uint8_t> checksums;
  each_field([&](const char* name, const char*, Of whom, const auto&, const auto& value) {
    using T = decltype(value(view, 0U));
    using Number = typename Stored<T>::Number;
    constexpr std::size_t width = Stored<T>::components;
    static_assert(sizeof(T) == sizeof(Number) * width);
    const SharedRows& rows = rows_of(whom);
    const std::vector<Number> part = rows.bring<Number>(width, [&](std::uint32_t i, Number* out) {
      const T v = value(view, i);
      std::memcpy(out, &v, sizeof(T));
    });
    file.write<Number>(name, rows.first(), part);
    const std::string sum = checksum<Number>(ranks, part, width, rows.in_blocks());
    checksums.insert(checksums.end(), sum.begin(), sum.end());
  });
  if (!ranks.root()) {
    checksums.clear();
  }
  file.write<std::uint8_t>(checksums_name, 0, checksums);
  file.commit();
}

Checkpoint read_checkpoint(const std::filesystem::path& place, const Ranks& ranks) {
  Checkpoint checkpoint;
  checkpoint.file = place;
  std::optional<ArtifactReader> reader;
  std::vector<std::uint8_t> checksums;
  agree(ranks, [&] {
    reader.emplace(place, checkpoint_kind);
    const auto bytes = reader->read<std::uint8_t>("numbers").values;
    if (checksum(bytes) != reader->attribute("numbers_sha256")) {
      throw InputError(
          fmt::format("{}: its numbers do not have the checksum that it names", place.string()));
    }
    const nlohmann::json numbers = nlohmann::json::from_cbor(bytes);
    each_number(checkpoint.engine, [&](const char* name, auto& value) {
      value = numbers.at(name).get<std::decay_t<decltype(value)>>();
    });
    checkpoint.run = numbers.at("run").get<RunProgress>();
    checksums = reader->read<std::uint8_t>(checksums_name).values;
  });
  Part everybody;
  std::optional<Part> liquid;
  agree(ranks, [&] {
    // Identities are 0, 1, 2, ..., so they are rows.
    const std::size_t total = reader->shape("identity").at(0);
    everybody.first = SharedRows::begin(ranks, total, ranks.rank());
    everybody.count = SharedRows::begin(ranks, total, ranks.rank() + 1) - everybody.first;
    for (std::size_t at = 0; at < everybody.count; at += SharedRows::block) {
      everybody.in_blocks.push_back(std::min(SharedRows::block, everybody.count - at));
    }
  });
  std::size_t number = 0;
  each_field([&](const char* name, const char*, Of whom, const auto& array, const auto&) {
    auto& values = array(checkpoint.engine);
    using T = typename std::decay_t<decltype(values)>::value_type;
    using Number = typename Stored<T>::Number;
    constexpr std::size_t width = Stored<T>::components;
    if (whom == Of::liquid && !liquid) {
      liquid = liquid_part(checkpoint.engine.particles.phase, ranks);  // which are known by now
    }
    const Part& part = whom == Of::liquid ? *liquid : everybody;
    std::vector<Number> found;
    agree(ranks, [&] { found = reader->read_slab<Number>(name, part.first, part.count); });
    const std::string sum = checksum<Number>(ranks, found, width, part.in_blocks);
    on_root(ranks, [&] {
      const auto named = checksums.begin() + static_cast<std::ptrdiff_t>(sum.size() * number);
      if (checksums.size() < sum.size() * (number + 1) ||
          !std::equal(sum.begin(), sum.end(), named)) {
        throw InputError(fmt::format("{}: the field {} does not have the checksum that it names",
                                     place.string(), name));
      }
    });
    ++number;
    values.resize(found.size() / width);
    if (!found.empty()) {
      std::memcpy(values.data(), found.data(), values.size() * sizeof(T));
    }
  });
  checkpoint.engine.particles.home.assign(everybody.count, Home::here);
  return checkpoint;
}

}  // namespace meltproof::solver
