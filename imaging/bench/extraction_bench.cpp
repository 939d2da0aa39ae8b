// SPDX-License-Identifier: GPL-3.0-or-later
// meltproof-bench-imaging: frames a second of the melt pool extraction, by Google Benchmark. The
// recording is synthetic: the virtual camera films an analytic pool that passes through its image,
// with the paper's optics, noise and counts.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/provenance.hpp"
#include "imaging/camera/record.hpp"
#include "imaging/meltpool/analysis.hpp"
#include "imaging/recording/formats.hpp"

namespace meltproof::imaging {
namespace {

/// A recording on disk for as long as the program runs.
class Film {
 public:
  Film()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("meltproof_bench_{}.h5", ::getpid())) {
    record_rosenthal(path_, CameraSettings{}, RosenthalSettings{}, 1, Provenance{});
  }
  ~Film() {
    std::error_code none;
    std::filesystem::remove(path_, none);
  }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const Film& film() {
  static const Film made;
  return made;
}

/// The film's frames, in memory and over and over.
Recording from_memory(std::size_t passages) {
  const Recording source = open_recording(film().path());
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < source.header().frames; ++i) {
    frames.push_back(source.frame(i));
  }
  RecordingHeader header = source.header();
  header.frames = passages * frames.size();
  return {header, [frames = std::move(frames)](std::size_t index, Frame& frame) {
            const auto& values = frames[index % frames.size()].values;
            std::copy(values.begin(), values.end(), frame.values.begin());
          }};
}

void count(benchmark::State& state, const Recording& recording) {
  const auto& header = recording.header();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(header.frames));
  state.counters["frame_rate"] = header.frame_rate;
  state.counters["frames"] = static_cast<double>(header.frames);
}

PixelSize pixel_size(const Recording& recording) {
  return {recording.header().pixel_size, recording.header().pixel_size, 0, 0};
}

/// What meltproof-thermography does between reading and writing.
void extraction_from_memory(benchmark::State& state) {
  const Recording recording = from_memory(50);
  for ([[maybe_unused]] auto _ : state) {
    const Analysis found =
        analyse(recording, LevelRequest{}, ScanDirection::right, pixel_size(recording));
    if (!found.found) {
      state.SkipWithError("no melt pool was found in the film, so nothing was timed");
      return;
    }
    benchmark::DoNotOptimize(&found);
  }
  count(state, recording);
}

/// The same with opening the file, its checksum and reading its frames; one passage of the pool.
void extraction_from_file(benchmark::State& state) {
  const std::filesystem::path& path = film().path();
  for ([[maybe_unused]] auto _ : state) {
    const Recording recording = open_recording(path);
    const Analysis found =
        analyse(recording, LevelRequest{}, ScanDirection::right, pixel_size(recording));
    benchmark::DoNotOptimize(&found);
  }
  count(state, open_recording(path));
}

BENCHMARK(extraction_from_memory)
    ->Name("extraction/memory")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(extraction_from_file)
    ->Name("extraction/file")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace meltproof::imaging

BENCHMARK_MAIN();
