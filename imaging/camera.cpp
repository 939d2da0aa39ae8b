// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-camera: films a solver run, an analytic pool or a glass scale as the infrared camera
// would.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/program.hpp"
#include "base/provenance.hpp"
#include "imaging/camera/record.hpp"
#include "imaging/camera/settings.hpp"

namespace {

constexpr const char* about =
    "The virtual camera: writes a recording as the infrared camera of the experiment would have "
    "made it, "
    "with its band, windows, point spread, motion during the integration time, noise and counts. "
    "The "
    "defaults are the paper's optics; --reference lists every setting and says which ones the "
    "paper does "
    "not give.\n"
    "Examples:\n"
    "  meltproof-camera run.h5 --output recording.h5 --seed 1\n"
    "  meltproof-camera --rosenthal --output pool.h5\n"
    "  meltproof-camera --scale --settings data/scales/across_x.toml --output scale.h5";

}  // namespace

int main(int argc, char** argv) {
  using namespace meltproof;
  std::string run, output, settings_file;
  std::vector<std::string> overrides;
  std::uint64_t seed = 1;
  bool rosenthal = false, scale = false, validate = false, schema = false, reference = false;
  Program program("meltproof-camera", about);
  program.app.add_option("run", run, "Run of meltproof-solve (HDF5)");
  program.app.add_flag("--rosenthal", rosenthal, "film an analytic pool instead of a run");
  program.app.add_flag("--scale", scale, "make an image of a glass scale instead");
  program.app.add_option("--output", output, "recording to write (HDF5)");
  program.app.add_option("--settings", settings_file, "settings of camera and scene (TOML)");
  program.app
      .add_option("--set", overrides,
                  "replace one setting: --set sensor.integration_time=\"50 us\"; "
                  "may be repeated")
      ->type_name("KEY=VALUE");
  program.app.add_option("--seed", seed, "seed of the noise")->capture_default_str();
  program.app.add_flag("--validate", validate, "check the settings, print them all, and stop");
  program.app.add_flag("--schema", schema, "print the JSON Schema of the settings and stop");
  program.app.add_flag("--reference", reference,
                       "print the reference page of the settings and stop");
  return program.run(argc, argv, [&] {
    Provenance provenance = begin_provenance(argc, argv);
    imaging::CameraSettings camera;
    imaging::RosenthalSettings source;
    imaging::ScaleScene scene;
    Input input = imaging::declare_settings(camera, source, scene);
    if (schema || reference) {
      fmt::print("{}\n", schema ? input.schema().dump(2) : input.reference());
      return ExitStatus::success;
    }
    if (!settings_file.empty()) {
      input.read(settings_file, overrides);
      for (const auto& path : input.files()) provenance.add_input(path);
    } else if (!overrides.empty()) {
      throw InputError("--set replaces a value of the settings file; name one with --settings.");
    }
    if (validate) {
      fmt::print("{}", input.resolved());
      return ExitStatus::success;
    }
    if ((run.empty() ? 0 : 1) + (rosenthal ? 1 : 0) + (scale ? 1 : 0) != 1)
      throw InputError(
          "Name one thing to film: a run, --rosenthal or --scale; see --help for examples.");
    if (output.empty()) throw InputError("--output is missing: name the recording to write.");
    provenance.resolved_input = input.resolved();
    provenance.seed = static_cast<long long>(seed);
    const imaging::Recorded recorded =
        scale       ? imaging::record_scale(output, camera, scene, seed, provenance)
        : rosenthal ? imaging::record_rosenthal(output, camera, source, seed, provenance)
                    : imaging::record_run(run, output, camera, seed, provenance);
    if (!program.quiet()) {
      fmt::print("{}: {} frames of {} x {} px, synthetic\n", output, recorded.frames, camera.width,
                 camera.height);
      if (recorded.left_out > 0)
        fmt::print("{} snapshots of the run are no frames of this camera and were left out\n",
                   recorded.left_out);
    }
    return ExitStatus::success;
  });
}
