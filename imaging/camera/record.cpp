// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/camera/record.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/error.hpp"
#include "base/progress.hpp"
#include "imaging/camera/recording_file.hpp"
#include "imaging/camera/rosenthal.hpp"
#include "imaging/camera/scale_scene.hpp"
#include "imaging/camera/scene.hpp"
#include "imaging/camera/section.hpp"

namespace meltproof::imaging {
namespace {

/// A snapshot of a run that becomes a frame.
struct Instant {
  std::string group;
  double time, beam;
};

std::vector<double> values(const ArtifactReader& run, const std::string& name, std::size_t count) {
  auto data = run.read<double>(name).values;
  if (data.size() != count)
    throw InputError(fmt::format("{}: {} holds {} numbers; expected {}. The run is damaged.",
                                 run.path().string(), name, data.size(), count));
  return data;
}

std::vector<Instant> frame_instants(const ArtifactReader& run, const CameraSettings& camera,
                                    std::size_t& left_out) {
  if (!run.has("snapshots"))
    throw InputError(run.path().string() +
                     ": the run holds no snapshots; let the solver write them at "
                     "the camera's frame rate.");
  auto groups = run.names("snapshots");
  std::sort(groups.begin(), groups.end());
  std::vector<Instant> instants;
  double interval = 0;
  for (const auto& name : groups) {
    const std::string group = "snapshots/" + name;
    const Instant next{group, run.scalar(group + "/time"), values(run, group + "/beam", 3)[0]};
    if (!instants.empty()) {
      interval = next.time - instants.back().time;
      if (std::abs(interval * camera.frame_rate - 1) > 0.01) break;
    }
    instants.push_back(next);
  }
  left_out = groups.size() - instants.size();
  if (instants.size() < 2 && groups.size() > 1)
    throw InputError(
        fmt::format("{}: the first snapshots are {:.4g} us apart, the camera's frames {:.4g} us; "
                    "run the solver with "
                    "snapshots at the camera's frame rate or set sensor.frame_rate.",
                    run.path().string(), interval * 1e6, 1e6 / camera.frame_rate));
  if (instants.empty()) throw InputError(run.path().string() + ": the run holds no snapshots.");
  return instants;
}

}  // namespace

Recorded record_run(const std::filesystem::path& path, const std::filesystem::path& output,
                    const CameraSettings& settings, std::uint64_t seed, Provenance provenance) {
  const ArtifactReader run(path, "meltproof run");
  provenance.add_input(path);
  const double speed = run.scalar("scan_speed");
  const double reference = run.scalar("reference_temperature");
  Recorded recorded;
  const auto instants = frame_instants(run, settings, recorded.left_out);
  const double centre =
      settings.centre.value_or(0.5 * (instants.front().beam + instants.back().beam));
  const double motion = speed * settings.integration_time;
  const SceneGrid grid(settings, centre, motion);
  const Camera camera(settings);
  Noise noise(seed);
  RecordingFile file(output, "virtual camera of " + path.filename().string(),
                     section_statement(settings), static_cast<std::size_t>(settings.width),
                     static_cast<std::size_t>(settings.height));
  file.describe_sensor(settings, settings.pixel_size);
  file.describe_radiometry(settings, camera.radiometry());
  file.describe_scene(speed, reference, grid.first_pixel_u(), grid.first_pixel_v());
  Progress progress("film", static_cast<double>(instants.size()));
  for (const auto& instant : instants) {
    ParticleSnapshot snapshot;
    snapshot.time = instant.time;
    snapshot.spacing = run.scalar("spacing");
    snapshot.temperature = run.read<double>(instant.group + "/temperature").values;
    const std::size_t n = snapshot.temperature.size();
    snapshot.position = values(run, instant.group + "/position", 3 * n);
    snapshot.liquid_fraction = values(run, instant.group + "/liquid_fraction", n);
    const Scene scene = render_section(snapshot, settings, grid);
    const VisiblePool pool = visible_pool(scene, grid, reference);
    file.add(camera.detect(camera.expose(scene, grid, motion), noise), instant.time,
             {grid.pixel_column(instant.beam), pool.length, pool.depth});
    progress.update(static_cast<double>(file.frames()));
  }
  recorded.frames = file.frames();
  file.commit(provenance);
  return recorded;
}

Recorded record_rosenthal(const std::filesystem::path& output, const CameraSettings& settings,
                          const RosenthalSettings& source, std::uint64_t seed,
                          Provenance provenance) {
  const bool side = source.view == "side";
  const double motion = source.scan_speed * settings.integration_time;
  const SceneGrid grid(settings, settings.centre.value_or(0), motion);
  const Camera camera(settings);
  const RosenthalPool pool = rosenthal_pool(source);
  Noise noise(seed);
  RecordingFile file(output, "virtual camera of an analytic pool (Rosenthal), no measurement",
                     side ? section_statement(settings)
                          : "Seen from above: the surface z = 0; columns along x, rows along -y.",
                     static_cast<std::size_t>(settings.width),
                     static_cast<std::size_t>(settings.height));
  file.describe_sensor(settings, settings.pixel_size);
  file.describe_radiometry(settings, camera.radiometry());
  file.describe_scene(source.scan_speed, source.reference_temperature, grid.first_pixel_u(),
                      grid.first_pixel_v());
  file.truth("pool_length", pool.length, "m", "Exact length of the analytic pool.");
  file.truth("pool_width", pool.width, "m", "Exact width of the analytic pool.");
  file.truth("pool_depth", 0.5 * pool.width, "m", "Exact depth of the analytic pool.");
  const double start =
      settings.centre.value_or(0) - 0.5 * static_cast<double>(settings.width) * settings.pixel_size;
  Progress progress("film", static_cast<double>(source.frames));
  for (long long i = 0; i < source.frames; ++i) {
    const double time = static_cast<double>(i) / settings.frame_rate;
    const double position = start + source.scan_speed * time;
    const Scene scene = render_scene(rosenthal_field(source, settings, position), grid);
    const VisiblePool seen = visible_pool(scene, grid, source.reference_temperature);
    file.add(camera.detect(camera.expose(scene, grid, motion), noise), time,
             {grid.pixel_column(position), seen.length, seen.depth});
    progress.update(static_cast<double>(i + 1));
  }
  const Recorded recorded{file.frames(), 0};
  file.commit(provenance);
  return recorded;
}

Recorded record_scale(const std::filesystem::path& output, const CameraSettings& settings,
                      ScaleScene scale, std::uint64_t seed, Provenance provenance) {
  scale.width = static_cast<int>(settings.width);
  scale.height = static_cast<int>(settings.height);
  scale.pixel_size_x = scale.pixel_size_y = settings.pixel_size;
  scale.point_spread = settings.point_spread;
  scale.seed = seed;
  const cv::Mat image = render_scale(scale);
  std::vector<std::uint16_t> counts;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column)
      counts.push_back(static_cast<std::uint16_t>(std::clamp<double>(
          std::round(double{image.at<float>(row, column)}), 0, settings.full_scale())));
  RecordingFile file(
      output, "virtual camera of a glass scale, no measurement",
      fmt::format("A warmed glass scale: lines of {} um every {} um, {:.3f} degrees.",
                  scale.line_width * 1e6, scale.period * 1e6, scale.angle * 180 / CV_PI),
      static_cast<std::size_t>(settings.width), static_cast<std::size_t>(settings.height));
  file.describe_sensor(settings, 0);
  file.truth("pixel_size", settings.pixel_size, "m", "With which the image was rendered.");
  file.truth("period", scale.period, "m", "Of the lines.");
  file.truth("angle", scale.angle, "rad",
             "Of the direction across the lines against the columns' axis.");
  file.add(counts, 0);
  file.commit(provenance);
  return {1, 0};
}

}  // namespace meltproof::imaging
