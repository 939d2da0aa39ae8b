// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/output/checkpoint.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/error.hpp"
#include "solver/output/checkpoint_file.hpp"
#include "solver/output/snapshot.hpp"
#include "solver/parallel/agreement.hpp"

namespace meltproof::solver {

CheckpointFolder::CheckpointFolder(const std::filesystem::path& run_folder, const Ranks& ranks)
    : folder_(run_folder / "checkpoints"), ranks_(ranks) {}

/// What stands there now; on the root, whose word holds for all.
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

std::filesystem::path CheckpointFolder::snapshot(std::size_t number) const {
  return folder_ / fmt::format("snapshot_{:04}.h5", number);
}

void CheckpointFolder::write_snapshot(std::size_t number, const Engine& engine,
                                      const Provenance& provenance) {
  solver::write_snapshot(snapshot(number), number, engine, provenance);
}

std::filesystem::path CheckpointFolder::write(const Engine& engine, const RunProgress& run,
                                              const Provenance& provenance) {
  const auto place = folder_ / fmt::format("checkpoint_{:012}.h5", engine.steps());
  write_checkpoint(place, engine, run, provenance);
  last_ = place;
  on_root(ranks_, [&] {
    auto all = files("checkpoint_");
    while (all.size() > 2) {
      std::error_code ignored;
      std::filesystem::remove(all.front(), ignored);
      all.erase(all.begin());
    }
  });
  return place;
}

std::optional<Checkpoint> CheckpointFolder::newest(const Provenance& provenance) const {
  std::string names;
  on_root(ranks_, [&] {
    const auto all = files("checkpoint_");
    for (auto file = all.rbegin(); file != all.rend(); ++file) {
      names += file->filename().string() + "\n";
    }
  });
  std::istringstream listed(ranks_.said(names));
  for (std::string name; std::getline(listed, name);) {
    const auto file = folder_ / name;
    std::string input, revision;
    std::optional<Checkpoint> found;
    try {
      agree(ranks_, [&] {
        const ArtifactReader reader(file, checkpoint_kind);
        input = reader.attribute("resolved_input", "/provenance");
        revision = reader.attribute("revision", "/provenance");
      });
      // One of another input or revision may hold other fields: it is refused below for what it is.
      if (input == provenance.resolved_input && revision == code_revision()) {
        found = read_checkpoint(file, ranks_);
      }
    } catch (const std::exception& problem) {
      spdlog::warn("{}; this checkpoint is passed over", problem.what());
      continue;
    }
    if (input != provenance.resolved_input) {
      throw InputError(fmt::format(
          "{} was made with another input than this run's: give the same case and --set values, or "
          "leave out --restart to begin anew",
          file.string()));
    }
    if (revision != code_revision()) {
      throw InputError(fmt::format(
          "{} was made by revision {}, this is {}: what both computed together would be no result "
          "of either; build that revision, or leave out --restart to begin anew",
          file.string(), revision, code_revision()));
    }
    on_root(ranks_, [&] {
      for (std::size_t k = 0; k < found->run.snapshots; ++k) {
        const ArtifactReader there(snapshot(k), "meltproof snapshot");
      }
    });
    last_ = file;
    return found;
  }
  return std::nullopt;
}

void CheckpointFolder::copy_snapshots(ArtifactWriter* run_file, std::size_t count) const {
  on_root(ranks_, [&] {
    for (std::size_t k = 0; k < count; ++k) {
      run_file->copy_from(ArtifactReader(snapshot(k), "meltproof snapshot"), snapshot_group(k));
    }
  });
}

std::string CheckpointFolder::last_good() const {
  return last_.empty() ? "no checkpoint had been written (see --checkpoint-every)"
                       : "the last good checkpoint is " + last_.string();
}

void CheckpointFolder::clear() const {
  on_root(ranks_, [&] {
    std::error_code ignored;
    for (const char* prefix : {"checkpoint_", "snapshot_", ".checkpoint_", ".snapshot_"}) {
      for (const auto& file : files(prefix)) {
        std::filesystem::remove(file, ignored);
      }
    }
    std::filesystem::remove(folder_, ignored);  // only if nothing else is in it
  });
}

}  // namespace meltproof::solver
