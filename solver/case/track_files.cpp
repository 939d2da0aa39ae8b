// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/case/track_files.hpp"

#include <optional>

#include "base/artifact.hpp"
#include "base/atomic_file.hpp"
#include "solver/case/track_result.hpp"
#include "solver/output/history.hpp"
#include "solver/output/paraview.hpp"
#include "solver/parallel/agreement.hpp"

namespace meltproof::solver {
namespace {

void write_facts(ArtifactWriter& writer, const TrackCase& t, const Engine& engine,
                 const Discretisation& made) {
  writer.attribute("title", t.title);
  writer.write("spacing", t.spacing, "m", "particle spacing");
  writer.write("smoothing_length", engine.kernel().smoothing_length, "m",
               "of the quintic spline, support 3 h");
  writer.write("scan_speed", t.speed, "m s-1", "of the beam along x");
  writer.write("laser_power", t.power, "W", "of the beam");
  writer.write("beam_radius", t.beam_radius, "m", "1/e2 radius");
  writer.write("exposure", t.exposure, "s", "the beam is on from 0 to here");
  writer.write("additive_mass_fraction", made.bed_additive_mass_fraction, "1",
               "of the powder blend as spheres");
  writer.write("reference_temperature", pool_isotherm(t, engine.mixture()), "K",
               "outlines the melt pool");
  writer.write("initial_temperature", t.initial_temperature, "K", "of plate and powder");
  writer.write("domain/lower", std::span<const double>(made.domain.lower), {3}, "m",
               "lower corner of the domain");
  writer.write("domain/upper", std::span<const double>(made.domain.upper), {3}, "m",
               "upper corner of the domain");
}

/// What runs that were killed here left of run.h5.
void remove_leftovers(const std::filesystem::path& folder) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".run.") && name.ends_with(".tmp.h5")) {
      std::filesystem::remove(entry.path(), none);
    }
  }
}

}  // namespace

void write_track_files(const std::filesystem::path& folder, const TrackCase& track,
                       const Engine& engine, const Discretisation& made,
                       const CheckpointFolder& checkpoints, const RunProgress& run,
                       const Provenance& provenance, const nlohmann::json& result) {
  const Ranks& ranks = engine.ranks();
  const auto place = folder / "run.h5";
  std::optional<ArtifactWriter> file;
  on_root(ranks, [&] {
    remove_leftovers(folder);
    file.emplace(place, "meltproof run");
    write_facts(*file, track, engine, made);
  });
  checkpoints.copy_snapshots(file ? &*file : nullptr, run.snapshots);
  on_root(ranks, [&] {
    file->commit(provenance);
    write_xdmf(place);
    write_file(folder / "history.csv", history_csv(run.lines));
    write_file(folder / "input.toml", provenance.resolved_input);
    write_file(folder / "result.json", result.dump(2) + "\n");
  });
}

}  // namespace meltproof::solver
