// SPDX-License-Identifier: GPL-3.0-or-later
// What every camera file becomes: a description and frames that are read one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "imaging/radiometry/radiometry.hpp"

namespace meltproof::imaging {

/// What a pixel's value stands for.
enum class SignalQuantity { counts, temperature, radiance };
/// "counts", "temperature" or "radiance".
std::string quantity_name(SignalQuantity quantity);
/// The inverse of quantity_name(). @throws InputError for any other name.
SignalQuantity parse_signal_quantity(const std::string& name);

/// Whether a pixel's value can be believed. The mark stays with the pixel to the end.
enum class PixelStatus : std::uint8_t { good, saturated, under_range, dead };

/// One frame. Row-major, the first value is the upper left pixel as stored.
struct Frame {
  std::size_t index = 0;
  double time = 0;                  ///< s, from the first frame of the file
  std::vector<float> values;        ///< height * width, in RecordingHeader::unit
  std::vector<float> counts;        ///< the stored counts where `values` were computed, else empty
  std::vector<PixelStatus> status;  ///< height * width
};

/// What is known about a recording before any frame is read.
struct RecordingHeader {
  std::string format;          ///< the reader's name, for example "Cedip PTW"
  std::filesystem::path path;  ///< as the user named it
  std::string sha256;          ///< of the source file
  std::size_t width = 0, height = 0;
  std::size_t frames = 0;       ///< whole frames that can be read
  std::size_t frames_lost = 0;  ///< announced or begun, but cut off; a lower bound where the format
                                ///< announces no number
  double frame_rate = 0;        ///< Hz; 0 where the file does not say
  double integration_time = 0;  ///< s; 0 where the file does not say
  double pixel_size = 0;        ///< m on the object; 0 where the file does not say
  double point_spread = 0;      ///< px, sigma of the optics' point spread; 0: the file does not say
  SignalQuantity quantity = SignalQuantity::counts;
  std::string unit = "count";  ///< "count", "K" or "W m-2 sr-1"
  /// A value from here on is saturated; one from here down is under range.
  double saturation = std::numeric_limits<double>::infinity();
  double under_range = -std::numeric_limits<double>::infinity();
  std::optional<Radiometry> radiometry;       ///< band, optics and gain, where the file holds them
  std::optional<double> emissivity_liquid;    ///< where it differs from radiometry->emissivity
  std::map<std::string, double> calibration;  ///< other constants of the file, by name with unit
  std::string synthetic;           ///< how a synthetic recording was made; empty: measured
  std::vector<std::string> notes;  ///< sentences that a user should read
  /// Other files that were read for this one: a calibration beside it, the frames of a folder.
  std::vector<std::filesystem::path> companions;
};

/// @throws InputError if the frames have no pixels, or more than any camera has. Recording checks
/// it too; a reader that must ask for memory before it has a Recording calls it first.
void check_frame_size(const RecordingHeader& header);

/// A recording. Only the frame that is asked for is read, so the file may be larger than memory.
class Recording {
 public:
  /// Fills values (and counts, and time where the file stamps its frames) of a frame whose vectors
  /// `values` and `status` have their size already.
  using ReadFrame = std::function<void(std::size_t index, Frame& frame)>;
  Recording(RecordingHeader header, ReadFrame read);

  const RecordingHeader& header() const { return header_; }
  RecordingHeader& header() { return header_; }
  /// Reads frame `index` into `frame`, reusing its memory, and marks pixels by the header's limits;
  /// a value that is no number is dead. The time is index / frame_rate unless the file knows
  /// better.
  /// @throws InputError if there is no such frame or it cannot be read.
  void read(std::size_t index, Frame& frame) const;
  Frame frame(std::size_t index) const;

 private:
  RecordingHeader header_;
  ReadFrame read_;
};

/// The same recording with counts as a linear temperature, T = offset + kelvin_per_count * counts:
/// what exports of several makers hold (0.04 K or 0.01 K a count). @throws InputError if the
/// recording holds no counts.
Recording with_linear_temperature(Recording recording, double kelvin_per_count, double offset);

}  // namespace meltproof::imaging
