// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <omp.h>

#include "base/program.hpp"
#include "base/provenance.hpp"
#include "solver/case/track_run.hpp"

int main(int argc, char** argv) {
  using namespace meltproof;
  const solver::MpiSession session;
  const solver::Ranks ranks = solver::Ranks::world();
  Program program(
      "meltproof-solve",
      "Simulates a single laser track: heat, melting and alloy diffusion in three dimensions.\n"
      "Example: meltproof-solve solver/cases/track_1wt.toml --powder powder.h5 --output run/\n"
      "Long runs keep checkpoints; SIGTERM and Ctrl-C write one. The same command with --restart "
      "goes\n"
      "on from the newest, and ends in the same numbers as a run that was never stopped.\n"
      "Several processes share a run: mpirun -n 4 meltproof-solve ... --threads 1, where "
      "processes\n"
      "times threads should not exceed the cores. Whatever their number, the numbers are the "
      "same.\n"
      "mpirun kills a second after Ctrl-C or SIGTERM, perhaps before a checkpoint is written: give "
      "it\n"
      "--mca odls_base_sigkill_timeout 600.");
  if (!ranks.root()) {
    program.hush();
  }
  InputOptions options;
  options.add_to(program.app, "the track");
  std::string powder, output;
  int threads = omp_get_max_threads();
  solver::RunOptions how;
  double minutes = how.checkpoint_interval / 60;
  program.app.add_option("--powder", powder,
                         "powder bed made by meltproof-powder (same as --set powder.bed=FILE)");
  program.app.add_option("-o,--output", output, "folder for run.h5, history.csv and result.json");
  program.app.add_option("--threads", threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
  program.app
      .add_option("--checkpoint-every", minutes,
                  "minutes of wall-clock time between checkpoints; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  program.app.add_option("--checkpoint-steps", how.checkpoint_steps,
                         "thermal steps between checkpoints, beside those by time; 0: none");
  program.app.add_option("--melt-of", how.melt_of,
                         "history.csv of a coarser run of the same track: the time left then "
                         "follows how its melt grew");
  program.app.add_flag("--restart", how.restart,
                       "go on from the newest good checkpoint in the output folder; without one, "
                       "begin");
  const int status = program.run(argc, argv, [&] {
    solver::MpiSession::check();
    solver::TrackCase track;
    Input input = solver::declare(track);
    if (!powder.empty()) {
      options.overrides.push_back("powder.bed=" + powder);
    }
    if (!ranks.root() && options.only_asks()) {
      return ExitStatus::success;
    }
    if (options.handle(input)) {
      return ExitStatus::success;
    }
    if (output.empty()) {
      throw InputError(
          "--output is missing: name the folder for the results, for example --output run/");
    }
    omp_set_num_threads(threads);
    Provenance provenance = begin_provenance(argc, argv);
    provenance.resolved_input = input.resolved();
    provenance.threads = threads;
    for (const auto& file : input.files()) {
      provenance.add_input(file);
    }
    how.name = std::filesystem::path(options.path).stem().string();
    how.folder = output;
    how.quiet = program.quiet() || !ranks.root();
    how.ranks = ranks;
    how.checkpoint_interval = 60 * minutes;
    const auto result = solver::run_track(track, how, provenance);
    if (!how.quiet) {
      fmt::print(
          "{}: pool length {:.1f} um, width {:.1f} um, depth {:.1f} um ({}); any liquid {:.1f} um; "
          "energy closes to "
          "{:.1e}, additive mass to {:.1e}; {} steps in {:.0f} s\n",
          how.name, result["pool_length_um"].get<double>(), result["pool_width_um"].get<double>(),
          result["pool_depth_um"].get<double>(), result["window"].get<std::string>(),
          result["any_liquid_length_um"].get<double>(),
          result["energy_relative_error"].get<double>(),
          result["species_relative_error"].get<double>(), result["steps"].get<std::size_t>(),
          result["wall_time_s"].get<double>());
    }
    return ExitStatus::success;
  });
  if (status != 0 && status != static_cast<int>(ExitStatus::stopped)) {
    session.give_up(status);
  }
  return status;
}
