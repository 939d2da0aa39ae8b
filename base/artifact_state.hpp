// SPDX-License-Identifier: GPL-3.0-or-later
// What a writer of artifacts does with HDF5; only artifact.cpp includes this.
#pragma once

#include <csignal>
#include <functional>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "base/artifact.hpp"
#include "base/artifact_hdf5.hpp"
#include "base/atomic_file.hpp"

namespace meltproof {

struct ArtifactWriter::State {
  bool prepared = prepare_hdf5();  // before any other call of the library
  AtomicFile place;
  Handle file{H5I_INVALID_HID, &H5Fclose};
  Handle link_options{H5Pcreate(H5P_LINK_CREATE), &H5Pclose};

  explicit State(const std::filesystem::path& path) : place(path) {
    // Where files may only grow so far (ulimit -f) a sentence says so, as of a full disk; the
    // signal would end the program without one.
    std::signal(SIGXFSZ, SIG_IGN);
  }

  /// @param name of a data set; empty: the file as a whole.
  [[noreturn]] void fail(const std::string& name = "") {
    throw std::runtime_error(
        fmt::format("{}: {} cannot be written (is the disk full?); nothing was left behind",
                    place.place().string(), name.empty() ? "it" : "the data set " + name));
  }

  Handle space_of(const std::vector<hsize_t>& dims) const {
    return Handle{dims.empty()
                      ? H5Screate(H5S_SCALAR)
                      : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                  &H5Sclose};
  }

  /// Rows in a chunk; a data set of less than 4096 numbers is one piece.
  static hsize_t chunk_rows(const std::vector<hsize_t>& dims) {
    const hsize_t rest =
        std::accumulate(dims.begin() + 1, dims.end(), hsize_t{1}, std::multiplies<>());
    return std::clamp<hsize_t>((1U << 17) / std::max<hsize_t>(1, rest), 1,
                               std::max<hsize_t>(1, dims[0]));
  }

  /// @param options H5P_DATASET_CREATE, to which what all data sets have in common is added.
  Handle make(const std::string& name, hid_t type, const std::vector<hsize_t>& dims,
              const Handle& options, const std::string& units, const std::string& description) {
    H5Pset_obj_track_times(options.get(), false);
    Handle set{H5Dcreate2(file.get(), name.c_str(), type, space_of(dims).get(), link_options.get(),
                          options.get(), H5P_DEFAULT),
               &H5Dclose};
    if (!set.valid()) {
      fail(name);
    }
    write_text_attribute(set.get(), "units", units);
    write_text_attribute(set.get(), "description", description);
    return set;
  }

  /// Compressed, where there is enough of it.
  Handle make_compressed(const std::string& name, hid_t type, const std::vector<hsize_t>& dims,
                         const std::string& units, const std::string& description) {
    const Handle options{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
    const hsize_t count =
        std::accumulate(dims.begin(), dims.end(), hsize_t{1}, std::multiplies<>());
    if (count > 4096 && !dims.empty()) {
      auto chunk = dims;
      chunk[0] = chunk_rows(dims);
      H5Pset_chunk(options.get(), static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(options.get());
      H5Pset_deflate(options.get(), 4);
    }
    return make(name, type, dims, options, units, description);
  }

  template <class T>
  void write(const std::string& name, std::span<const T> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description) {
    std::size_t count = 1;
    for (const auto n : shape) {
      count *= n;
    }
    if (count != values.size()) {
      throw std::logic_error(fmt::format("data set {}: {} values do not fill the shape of {}", name,
                                         values.size(), count));
    }
    Handle set = make_compressed(name, native_type<T>(), extent(shape), units, description);
    if (count > 0 &&
        H5Dwrite(set.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail(name);
    }
    finish(set, name);
  }

  /// A data set of another file, a chunk at a time.
  void copy(const Handle& from, const std::string& name) {
    const Handle source{H5Dget_space(from.get()), &H5Sclose};
    const Handle type{H5Dget_type(from.get()), &H5Tclose};
    std::vector<hsize_t> dims(static_cast<std::size_t>(H5Sget_simple_extent_ndims(source.get())));
    H5Sget_simple_extent_dims(source.get(), dims.data(), nullptr);
    Handle to = make_compressed(name, type.get(), dims, read_text_attribute(from.get(), "units"),
                                read_text_attribute(from.get(), "description"));
    const Handle target = space_of(dims);
    auto part = dims;
    std::vector<hsize_t> start(dims.size(), 0);
    const hsize_t rows = dims.empty() ? 1 : dims[0], most = dims.empty() ? 1 : chunk_rows(dims);
    std::vector<char> values;
    for (hsize_t at = 0; at < rows; at += most) {
      if (!dims.empty()) {
        start[0] = at;
        part[0] = std::min(most, rows - at);
        for (const Handle* space : {&source, &target}) {
          H5Sselect_hyperslab(space->get(), H5S_SELECT_SET, start.data(), nullptr, part.data(),
                              nullptr);
        }
      }
      const Handle memory = space_of(part);
      values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(memory.get())) *
                    H5Tget_size(type.get()));
      if (H5Dread(from.get(), type.get(), memory.get(), source.get(), H5P_DEFAULT, values.data()) <
              0 ||
          H5Dwrite(to.get(), type.get(), memory.get(), target.get(), H5P_DEFAULT, values.data()) <
              0) {
        fail(name);
      }
    }
    finish(to, name);
  }

  /// Closes it; what HDF5 still held back of it is written now.
  void finish(Handle& set, const std::string& name) {
    if (!set.reset()) {
      fail(name);
    }
  }

  template <class T>
  void append(const std::string& name, std::span<const T> slab,
              const std::vector<std::size_t>& slab_shape, const std::string& units,
              const std::string& description) {
    auto dims = extent(slab_shape);
    dims.insert(dims.begin(), 1);
    Handle set{H5Lexists(file.get(), name.substr(0, name.find('/')).c_str(), H5P_DEFAULT) > 0
                   ? H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT)
                   : H5I_INVALID_HID,
               &H5Dclose};
    hsize_t at = 0;
    if (!set.valid()) {
      auto none = dims, most = dims;
      none[0] = 0;
      most[0] = H5S_UNLIMITED;
      const Handle space{H5Screate_simple(static_cast<int>(dims.size()), none.data(), most.data()),
                         &H5Sclose};
      const Handle options{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
      H5Pset_obj_track_times(options.get(), false);
      H5Pset_chunk(options.get(), static_cast<int>(dims.size()), dims.data());
      H5Pset_shuffle(options.get());
      H5Pset_deflate(options.get(), 1);
      set = Handle{H5Dcreate2(file.get(), name.c_str(), native_type<T>(), space.get(),
                              link_options.get(), options.get(), H5P_DEFAULT),
                   &H5Dclose};
      if (!set.valid()) {
        fail(name);
      }
      write_text_attribute(set.get(), "units", units);
      write_text_attribute(set.get(), "description", description);
    } else {
      const Handle space{H5Dget_space(set.get()), &H5Sclose};
      std::vector<hsize_t> now(dims.size());
      H5Sget_simple_extent_dims(space.get(), now.data(), nullptr);
      at = now[0];
    }
    auto grown = dims;
    grown[0] = at + 1;
    std::vector<hsize_t> start(dims.size(), 0);
    start[0] = at;
    if (H5Dset_extent(set.get(), grown.data()) < 0) {
      fail(name);
    }
    const Handle target{H5Dget_space(set.get()), &H5Sclose};
    H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, dims.data(), nullptr);
    const Handle source{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                        &H5Sclose};
    if (H5Dwrite(set.get(), native_type<T>(), source.get(), target.get(), H5P_DEFAULT,
                 slab.data()) < 0) {
      fail(name);
    }
  }
};

}  // namespace meltproof
