// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/matlab.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <matio.h>

#include "base/error.hpp"
#include "imaging/recording/array_axes.hpp"
#include "imaging/recording/guarded.hpp"
#include "imaging/recording/hdf5_array.hpp"
#include "imaging/recording/mat5_elements.hpp"
#include "imaging/recording/matlab_variables.hpp"
#include "imaging/recording/signal_unit.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

// DEFLATE gains a factor of 1032 at most.
constexpr double most_gain = 1032;
// matio decompresses a variable from its beginning for every call, so frames come in portions.
constexpr std::size_t portion_bytes = 32 << 20;

/// What matio has complained about since it was last emptied; it has no other way to say so.
std::string& complaint() {
  static thread_local std::string text;
  return text;
}

struct Source {
  fs::path path;
  std::shared_ptr<mat_t> file;
  /// One variable with the frames, or one for every frame.
  std::vector<std::shared_ptr<matvar_t>> variables;
  ArrayAxes axes;
  std::size_t frames = 1;      // that can be read
  std::vector<float> portion;  // of the frames from `first` on
  std::size_t first = 0, count = 0;
};

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw InputError(path.string() + ": " + what);
}

/// How many frames of a variable lie in the file as a whole. A compressed one must be there whole.
std::size_t whole_frames(const Source& s, const matvar_t& v, const ByteFile& file,
                         const std::vector<Mat5Element>& elements) {
  double values = 1;
  for (int i = 0; i < v.rank; ++i) values *= static_cast<double>(v.dims[i]);
  const bool is_stack = s.axes.frame != no_axis;
  const std::size_t frames = is_stack ? v.dims[s.axes.frame] : 1;
  const std::string name = v.name ? v.name : "";
  const auto named =
      std::find_if(elements.begin(), elements.end(), [&](const auto& e) { return e.name == name; });
  // MATLAB stores numbers in the smallest type that holds them, so their size is found by division.
  const double size =
      named == elements.end() ? 0 : static_cast<double>(named->data_length) / values;
  if (!(size == 1 || size == 2 || size == 4 || size == 8))
    refuse(s.path, fmt::format("the variable {} has {} values in {} bytes; the file is damaged.",
                               name, values, size * values));
  if (named->compressed) {
    if (named->length > file.size() - named->place)
      refuse(s.path, fmt::format("the compressed variable {} is cut off; copy the file again from "
                                 "its source.",
                                 name));
    if (static_cast<double>(named->data_length) > most_gain * static_cast<double>(named->length))
      refuse(s.path, fmt::format("the variable {} is said to hold {} bytes, which {} compressed "
                                 "ones cannot; the file is damaged.",
                                 name, named->data_length, named->length));
    return frames;
  }
  if (named->data_length <= file.size() - named->data_place) return frames;
  if (!is_stack || s.axes.frame < std::max(s.axes.row, s.axes.column))
    refuse(s.path, fmt::format("the variable {} is cut off, and every frame with it; copy the file "
                               "again from its source.",
                               name));
  const double frame_bytes = size * static_cast<double>(v.dims[s.axes.row] * v.dims[s.axes.column]);
  return static_cast<std::size_t>(static_cast<double>(file.size() - named->data_place) /
                                  frame_bytes);
}

/// Leaves the pictures up to the first one that is cut off. @returns how many were left out.
std::size_t keep_whole_pictures(Source& s, const ByteFile& file,
                                const std::vector<Mat5Element>& elements) {
  const std::size_t announced = s.variables.size();
  for (std::size_t i = 0; i < announced; ++i) {
    try {
      whole_frames(s, *s.variables[i], file, elements);
    } catch (const InputError&) {
      if (i == 0) throw;
      s.variables.resize(i);
      break;
    }
  }
  return announced - s.variables.size();
}

template <class T>
void append(const std::vector<char>& raw, std::vector<float>& into) {
  into.resize(raw.size() / sizeof(T));
  for (std::size_t i = 0; i < into.size(); ++i) {
    T value;
    std::memcpy(&value, raw.data() + i * sizeof(T), sizeof(T));
    into[i] = static_cast<float>(value);
  }
}

void to_float(matio_classes kind, const std::vector<char>& raw, std::vector<float>& into) {
  switch (kind) {
    case MAT_C_DOUBLE:
      return append<double>(raw, into);
    case MAT_C_SINGLE:
      return append<float>(raw, into);
    case MAT_C_INT8:
      return append<std::int8_t>(raw, into);
    case MAT_C_UINT8:
      return append<std::uint8_t>(raw, into);
    case MAT_C_INT16:
      return append<std::int16_t>(raw, into);
    case MAT_C_UINT16:
      return append<std::uint16_t>(raw, into);
    case MAT_C_INT32:
      return append<std::int32_t>(raw, into);
    case MAT_C_UINT32:
      return append<std::uint32_t>(raw, into);
    case MAT_C_INT64:
      return append<std::int64_t>(raw, into);
    default:
      return append<std::uint64_t>(raw, into);
  }
}

/// Reads the frames from `index` on that fit a portion.
void read_portion(Source& s, std::size_t index, std::size_t pixels) {
  const auto& variable = s.variables[s.variables.size() > 1 ? index : 0];
  const matvar_t& v = *variable;
  const std::size_t value_size = Mat_SizeOfClass(v.class_type);
  const std::size_t fitting = std::max<std::size_t>(1, portion_bytes / (pixels * value_size));
  s.first = index;
  // Only with the frames as the slowest index do several of them lie together.
  const bool is_stack = s.axes.frame != no_axis;
  const bool slowest = is_stack && s.axes.frame > std::max(s.axes.row, s.axes.column);
  s.count = slowest ? std::min(fitting, s.frames - index) : 1;
  std::vector<int> start(3, 0), stride(3, 1), edge(3, 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.rank); ++i)
    edge[i] = static_cast<int>(v.dims[i]);
  if (is_stack) {
    start[s.axes.frame] = static_cast<int>(index);
    edge[s.axes.frame] = static_cast<int>(s.count);
  }
  std::vector<char> raw(s.count * pixels * value_size);
  complaint().clear();
  const int failed = Mat_VarReadData(s.file.get(), variable.get(), raw.data(), start.data(),
                                     stride.data(), edge.data());
  if (failed != 0 || !complaint().empty()) {
    s.count = 0;
    refuse(s.path, fmt::format("frame {} cannot be read ({}); the file is damaged.", index,
                               complaint().empty() ? "matio says no more" : complaint()));
  }
  to_float(v.class_type, raw, s.portion);
}

}  // namespace

bool is_matlab_7(std::string_view first_bytes) { return first_bytes.starts_with("MATLAB 7.3"); }

Recording open_matlab_7(const fs::path& path, const ReadOptions& options) {
  const auto open = [&] { return open_hdf5_array(path, options, "hwf", true); };
  try_in_child(path, "HDF5", [&] {
    const Recording recording = open();
    if (recording.header().frames > 0) recording.frame(0);
  });
  return open();
}

bool is_matlab_5(std::string_view first_bytes) { return first_bytes.starts_with("MATLAB 5.0"); }

Recording open_matlab_5(const fs::path& path, const ReadOptions& options) {
  const ByteFile file(path);
  const auto elements = read_mat5_elements(file);
  Mat_LogInitFunc("meltproof", [](int, char* text) { complaint() = text; });
  const auto s = std::make_shared<Source>();
  s->path = path;
  s->file = {Mat_Open(path.c_str(), MAT_ACC_RDONLY), [](mat_t* f) {
               if (f) Mat_Close(f);
             }};
  if (!s->file) refuse(path, "the MATLAB file cannot be opened; it is damaged.");
  if (options.dataset.empty())
    s->variables = choose_variables(path, s->file.get());
  else
    s->variables = {owned_variable(Mat_VarReadInfo(s->file.get(), options.dataset.c_str()))};
  if (s->variables[0]) drop_single_dims(*s->variables[0]);
  if (!s->variables[0] || !is_stack_or_picture(*s->variables[0]))
    refuse(path, fmt::format("there is no variable {} of numbers with three dimensions; give the "
                             "name of the frames.",
                             options.dataset));
  const matvar_t& v = *s->variables[0];
  s->axes = place_axes(options.axes.empty() ? "hwf" : options.axes,
                       counting_dims({v.dims, v.dims + v.rank}), false);
  RecordingHeader header;
  header.path = path;
  header.height = v.dims[s->axes.row];
  header.width = v.dims[s->axes.column];
  check_frame_size(header);
  const bool series = s->variables.size() > 1;
  if (series) header.frames_lost = keep_whole_pictures(*s, file, elements);
  s->frames = series ? s->variables.size() : whole_frames(*s, v, file, elements);
  header.frames = s->frames;
  if (!series)
    header.frames_lost = (s->axes.frame != no_axis ? v.dims[s->axes.frame] : 1) - s->frames;
  const auto name = [](const matvar_t& variable) { return variable.name ? variable.name : "?"; };
  header.notes.push_back(fmt::format(
      "The frames are {} of shape {}, taken as {} (frame f, row h, column w); if the "
      "pictures stand on their side, say another order (axes).",
      series
          ? fmt::format("the {} variables {} to {}", s->frames, name(v), name(*s->variables.back()))
          : fmt::format("the variable {}", name(v)),
      matlab_shape_text(v), options.axes.empty() ? "hwf" : options.axes));
  const SignalScale scale = describe_signal("", options.unit, header);
  return {header, [s, scale, height = header.height, width = header.width](std::size_t index,
                                                                           Frame& frame) {
            if (index < s->first || index >= s->first + s->count)
              read_portion(*s, index, frame.values.size());
            const auto begin = s->portion.begin() + static_cast<std::ptrdiff_t>(
                                                        (index - s->first) * frame.values.size());
            const auto end = begin + static_cast<std::ptrdiff_t>(frame.values.size());
            // MATLAB's first index is the fastest: the column is the slower one if it is later.
            if (s->axes.column > s->axes.row)
              transpose({begin, end}, height, width, frame.values);
            else
              std::copy(begin, end, frame.values.begin());
            scale.apply(frame.values);
          }};
}

}  // namespace meltproof::imaging
