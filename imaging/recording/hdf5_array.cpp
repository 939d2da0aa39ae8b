// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/hdf5_array.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "base/artifact_hdf5.hpp"
#include "base/error.hpp"
#include "imaging/recording/array_axes.hpp"
#include "imaging/recording/hdf5_candidates.hpp"
#include "imaging/recording/signal_unit.hpp"

namespace meltproof::imaging {
namespace {

namespace fs = std::filesystem;

// A chunk is decompressed as a whole, so a damaged chunk size would ask for that much memory. No
// filter that is usual gains more than this.
constexpr std::uint64_t most_gain = 2000, smallest_chunk = 1 << 20;

/// Handles close in the order of destruction, so the file stands first.
struct Source {
  Handle file{H5I_INVALID_HID, &H5Fclose};
  Handle set{H5I_INVALID_HID, &H5Dclose};
  std::string name;
  std::vector<std::string> pictures;  // of frames that are arrays of their own; `set` is the first
  std::vector<hsize_t> dims;          // as HDF5 stores them
  ArrayAxes axes;                     // of dims
  fs::path path;
};

/// Refuses chunks that cannot be, and makes the cache hold one, so that frames that share a chunk
/// do not decompress it anew each.
Handle open_set(hid_t file, const fs::path& path, const std::string& name) {
  Handle set{H5Dopen2(file, name.c_str(), H5P_DEFAULT), &H5Dclose};
  if (!set.valid())
    throw InputError(fmt::format("{}: there is no data set {}; give the path of the frames.",
                                 path.string(), name));
  if (!hdf5_holds_numbers(set.get()))
    throw InputError(fmt::format(
        "{}: the data set {} holds no integers or floating-point numbers; give the path of the "
        "frames.",
        path.string(), name));
  const Handle layout{H5Dget_create_plist(set.get()), &H5Pclose};
  if (H5Pget_external_count(layout.get()) > 0 || H5Pget_layout(layout.get()) == H5D_VIRTUAL)
    throw InputError(
        fmt::format("{}: the data set {} only points into other files; give the file "
                    "that holds the frames themselves.",
                    path.string(), name));
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return set;
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(layout.get(), H5S_MAX_RANK, chunk.data());
  const Handle type{H5Dget_type(set.get()), &H5Tclose};
  double bytes = static_cast<double>(H5Tget_size(type.get()));
  for (int i = 0; i < rank; ++i)
    bytes *= static_cast<double>(chunk.at(static_cast<std::size_t>(i)));
  const auto size = static_cast<double>(fs::file_size(path));
  if (!(bytes > 0) || bytes > std::max(size * most_gain, static_cast<double>(smallest_chunk)))
    throw InputError(fmt::format(
        "{}: the data set {} is said to come in pieces of {:.3g} bytes, which a file of {:.3g} "
        "bytes cannot hold; the file is damaged.",
        path.string(), name, bytes, size));
  const Handle access{H5Pcreate(H5P_DATASET_ACCESS), &H5Pclose};
  H5Pset_chunk_cache(access.get(), 521,
                     std::max<std::size_t>(1 << 20, static_cast<std::size_t>(bytes)), 1);
  return Handle{H5Dopen2(file, name.c_str(), access.get()), &H5Dclose};
}

/// Whether all of a picture is in the file: HDF5 gives zeros for what was never written.
bool is_written(hid_t set) {
  const Handle layout{H5Dget_create_plist(set), &H5Pclose};
  H5D_space_status_t status = H5D_SPACE_STATUS_ALLOCATED;
  H5Dget_space_status(set, &status);
  if (status == H5D_SPACE_STATUS_NOT_ALLOCATED) return false;
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return true;
  const auto dims = hdf5_dims(set);
  std::vector<hsize_t> chunk(dims.size());
  H5Pget_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
  hsize_t expected = 1, stored = 0;
  for (std::size_t i = 0; i < dims.size(); ++i)
    expected *= dims[i] / chunk[i] + (dims[i] % chunk[i] != 0 ? 1 : 0);
  const Handle all{H5Dget_space(set), &H5Sclose};
  H5Dget_num_chunks(set, all.get(), &stored);
  return stored >= expected;
}

/// Which frames are in the file: a recording that was broken off is as long as announced, and HDF5
/// gives zeros for what was never written.
struct Written {
  bool all = true;
  hsize_t layer_frames = 1;  // frames that share chunks
  std::set<hsize_t> layers;  // all of whose chunks are there
  bool has(hsize_t frame) const { return all || layers.contains(frame / layer_frames); }
};

Written find_written(const Source& s) {
  const Handle layout{H5Dget_create_plist(s.set.get()), &H5Pclose};
  H5D_space_status_t status = H5D_SPACE_STATUS_ALLOCATED;
  H5Dget_space_status(s.set.get(), &status);
  if (status == H5D_SPACE_STATUS_NOT_ALLOCATED) return {false, 1, {}};
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return {};
  std::vector<hsize_t> chunk(s.dims.size());
  H5Pget_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
  hsize_t layer_chunks = 1;  // at most as many as a frame has pixels
  for (const std::size_t axis : {s.axes.row, s.axes.column})
    layer_chunks *= s.dims[axis] / chunk[axis] + (s.dims[axis] % chunk[axis] != 0 ? 1 : 0);
  Written written{false, chunk[s.axes.frame], {}};
  hsize_t stored = 0;
  const Handle all{H5Dget_space(s.set.get()), &H5Sclose};
  H5Dget_num_chunks(s.set.get(), all.get(), &stored);
  const hsize_t layers = (s.dims[s.axes.frame] - 1) / written.layer_frames + 1;
  if (stored / layer_chunks >= layers) return {};
  std::map<hsize_t, hsize_t> found;  // chunks by layer
  std::vector<hsize_t> place(chunk.size());
  for (hsize_t i = 0; i < stored; ++i) {
    unsigned filters = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t bytes = 0;
    if (H5Dget_chunk_info(s.set.get(), all.get(), i, place.data(), &filters, &address, &bytes) < 0)
      continue;
    const hsize_t layer = place[s.axes.frame] / written.layer_frames;
    if (layer < layers && ++found[layer] == layer_chunks) written.layers.insert(layer);
  }
  return written;
}

/// The number of frames up to the last that is in the file.
std::size_t count_frames(const Source& s, const Written& written) {
  const hsize_t announced = s.dims[s.axes.frame];
  if (written.all) return announced;
  if (written.layers.empty()) return 0;
  const hsize_t last = *written.layers.rbegin();
  return last >= announced / written.layer_frames ? announced : (last + 1) * written.layer_frames;
}

/// Refuses frames that the file cannot hold, before memory is asked for.
void check_frame_bytes(const Source& s) {
  const Handle type{H5Dget_type(s.set.get()), &H5Tclose};
  const auto most = static_cast<double>(fs::file_size(s.path)) * most_gain + smallest_chunk;
  const double bytes = static_cast<double>(s.dims[s.axes.row]) *
                       static_cast<double>(s.dims[s.axes.column]) *
                       static_cast<double>(H5Tget_size(type.get()));
  if (bytes > most)
    throw InputError(fmt::format(
        "{}: a frame of {} is said to have {:.3g} bytes, which the file cannot hold; it is "
        "damaged.",
        s.path.string(), s.name, bytes));
}

void read_frame(const Source& s, std::size_t index, std::vector<float>& stored) {
  const bool own = !s.pictures.empty();
  const Handle picture =
      own ? open_set(s.file.get(), s.path, s.pictures[index]) : Handle{H5I_INVALID_HID, &H5Dclose};
  const hid_t set = own ? picture.get() : s.set.get();
  if (s.axes.frame == no_axis && (hdf5_dims(set) != s.dims || !is_written(set)))
    throw InputError(fmt::format("{}: the array {} was never written whole to the file.",
                                 s.path.string(), own ? s.pictures[index] : s.name));
  std::vector<hsize_t> start(s.dims.size(), 0), count = s.dims;
  if (s.pictures.empty() && s.axes.frame != no_axis) {
    start[s.axes.frame] = index;
    count[s.axes.frame] = 1;
  }
  const Handle from{H5Dget_space(set), &H5Sclose};
  H5Sselect_hyperslab(from.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Handle to{H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                  &H5Sclose};
  if (H5Dread(set, H5T_NATIVE_FLOAT, to.get(), from.get(), H5P_DEFAULT, stored.data()) < 0)
    throw InputError(
        fmt::format("{}: frame {} of {} cannot be read; the file is damaged, or was "
                    "compressed with a filter that is not installed here.",
                    s.path.string(), index, s.name));
}

}  // namespace

Recording open_hdf5_array(const fs::path& path, const ReadOptions& options,
                          const std::string& default_axes, bool reversed) {
  prepare_hdf5();
  const auto s = std::make_shared<Source>();
  s->path = path;
  s->file = Handle{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose};
  if (!s->file.valid())
    throw InputError(path.string() +
                     ": the HDF5 file cannot be opened; it is damaged or cut off, and then HDF5 "
                     "opens none of it. Copy it again from its source.");
  auto names = options.dataset.empty() ? choose_hdf5_arrays(path, s->file.get(), reversed)
                                       : std::vector{options.dataset};
  s->name = names.front();
  if (names.size() > 1) s->pictures = std::move(names);
  s->set = open_set(s->file.get(), path, s->name);
  s->dims = hdf5_dims(s->set.get());
  const auto counting = counting_dims({s->dims.begin(), s->dims.end()});
  const std::string shape = hdf5_shape_text(s->dims, reversed);
  if ((counting.size() != 3 && counting.size() != 2) ||
      std::count(s->dims.begin(), s->dims.end(), 0))
    throw InputError(fmt::format(
        "{}: the data set {} has the shape {}; expected three dimensions, frames, rows and columns "
        "in some order.",
        path.string(), s->name, shape.empty() ? "of one value" : shape));
  s->axes = place_axes(options.axes.empty() ? default_axes : options.axes, counting, reversed);

  RecordingHeader header;
  header.path = path;
  header.height = s->dims[s->axes.row];
  header.width = s->dims[s->axes.column];
  check_frame_size(header);
  check_frame_bytes(*s);
  Written written;
  header.frames = std::max<std::size_t>(1, s->pictures.size());
  if (counting.size() == 3) {
    written = find_written(*s);
    header.frames = count_frames(*s, written);
    header.frames_lost = s->dims[s->axes.frame] - header.frames;
  }
  header.notes.push_back(fmt::format(
      "The frames are {} of shape {}, taken as {} (frame f, row h, column w); if the "
      "pictures stand on their side, say another order (axes).",
      s->pictures.empty()
          ? "the array " + s->name
          : fmt::format("the {} arrays {} to {}", s->pictures.size(), s->name, s->pictures.back()),
      shape, options.axes.empty() ? default_axes : options.axes));
  std::string unit = read_text_attribute(s->set.get(), "units");
  if (unit.empty()) unit = read_text_attribute(s->set.get(), "unit");
  const SignalScale scale = describe_signal(unit, options.unit, header);
  return {header, [s, written, scale, height = header.height, width = header.width](
                      std::size_t index, Frame& frame) {
            if (!written.has(index))
              throw InputError(fmt::format(
                  "{}: frame {} of {} was never written to the file; cut the recording there.",
                  s->path.string(), index, s->name));
            if (s->axes.row < s->axes.column) {
              read_frame(*s, index, frame.values);
            } else {
              std::vector<float> columns(frame.values.size());
              read_frame(*s, index, columns);
              transpose(columns, height, width, frame.values);
            }
            scale.apply(frame.values);
          }};
}

}  // namespace meltproof::imaging
