// SPDX-License-Identifier: GPL-3.0-or-later
// The artifact: one HDF5 file in which stages meet. Every data set carries `units` and
// `description`;
// `/provenance` says where it comes from. HDF5 itself does not appear in this header, so that
// programs with the parallel and the serial library share it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/provenance.hpp"

namespace meltproof {

class ArtifactReader;

/// Writes an artifact under a temporary name beside its place; commit() renames it. Without
/// commit() nothing is left behind. Data sets are named by their path ("fields/temperature"),
/// groups are made as needed, and nothing volatile (clock, host) enters a data set, so equal
/// results are equal bytes.
class ArtifactWriter {
 public:
  /// @param kind what the artifact is, for example "meltproof powder bed"; readers check it.
  /// @throws InputError if the folder does not exist or cannot be written.
  ArtifactWriter(const std::filesystem::path& path, const std::string& kind);
  ~ArtifactWriter();
  ArtifactWriter(const ArtifactWriter&) = delete;
  ArtifactWriter& operator=(const ArtifactWriter&) = delete;

  /// Writes a data set of `shape` (row-major; its product is values.size(); {} is a scalar).
  void write(const std::string& name, std::span<const double> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  void write(const std::string& name, std::span<const float> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  void write(const std::string& name, std::span<const std::int64_t> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  void write(const std::string& name, std::span<const std::int32_t> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  void write(const std::string& name, std::span<const std::uint16_t> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  void write(const std::string& name, std::span<const std::uint8_t> values,
             const std::vector<std::size_t>& shape, const std::string& units,
             const std::string& description);
  /// One number.
  void write(const std::string& name, double value, const std::string& units,
             const std::string& description);

  /// Appends one slab along the first dimension of a data set that grows; the first call makes it.
  /// `slab_shape` is the shape of one entry (a frame: {height, width}).
  void append(const std::string& name, std::span<const std::uint16_t> slab,
              const std::vector<std::size_t>& slab_shape, const std::string& units,
              const std::string& description);
  void append(const std::string& name, std::span<const float> slab,
              const std::vector<std::size_t>& slab_shape, const std::string& units,
              const std::string& description);
  void append(const std::string& name, std::span<const double> slab,
              const std::vector<std::size_t>& slab_shape, const std::string& units,
              const std::string& description);

  /// Makes a data set of `shape` that is filled after close(), by whoever opens the file: one piece
  /// of the file, neither compressed nor in chunks, so that many may write into it at a time. T is
  /// what write() takes.
  template <class T>
  void reserve(const std::string& name, const std::vector<std::size_t>& shape,
               const std::string& units, const std::string& description);

  /// A text attribute of the root group, or of `object` if given.
  void attribute(const std::string& name, const std::string& value,
                 const std::string& object = "/");

  /// Copies the data sets of a group, by the same names, from another artifact: a chunk at a time
  /// and compressed, however they are stored there.
  /// @throws InputError if there is no such group, std::runtime_error if the disk is full.
  void copy_from(const ArtifactReader& other, const std::string& group);

  /// Writes `/provenance`, closes the file and gives it its name. @throws std::runtime_error with a
  /// sentence if the disk is full.
  void commit(const Provenance& provenance);

  /// commit() in two steps, for what is filled between them. close() writes `/provenance` and takes
  /// all of the file's room on the disk, so that a full one is met here and not while it is filled.
  /// @returns the temporary name under which it stands until put_in_place() gives it its own.
  /// @throws std::runtime_error with a sentence if the disk is full.
  std::filesystem::path close(const Provenance& provenance);
  void put_in_place();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A data set read whole, converted to T.
template <class T>
struct DataSet {
  std::vector<T> values;           ///< row-major
  std::vector<std::size_t> shape;  ///< {} for a scalar
  std::string units;
};

/// Reads an artifact, or any other HDF5 file (then without `kind`).
class ArtifactReader {
 public:
  /// @param kind if not empty, the file must be of this kind.
  /// @throws InputError if it is missing, no HDF5 file, or of another kind.
  explicit ArtifactReader(const std::filesystem::path& path, const std::string& kind = "");
  ~ArtifactReader();
  ArtifactReader(ArtifactReader&&) noexcept;
  ArtifactReader(const ArtifactReader&) = delete;
  ArtifactReader& operator=(ArtifactReader&&) noexcept;
  ArtifactReader& operator=(const ArtifactReader&) = delete;

  bool has(const std::string& name) const;
  std::vector<std::size_t> shape(const std::string& name) const;
  std::string units(const std::string& name) const;
  /// Names of the data sets and groups in a group.
  std::vector<std::string> names(const std::string& group = "/") const;

  /// T is double, float, int64_t, int32_t, uint16_t or uint8_t; HDF5 converts the stored type.
  /// @throws InputError naming file and data set if it is missing.
  template <class T>
  DataSet<T> read(const std::string& name) const;
  /// `count` entries along the first dimension from `first` on, row-major.
  template <class T>
  std::vector<T> read_slab(const std::string& name, std::size_t first, std::size_t count) const;
  double scalar(const std::string& name) const;

  /// A text attribute of the root group or of `object`; empty if there is none.
  std::string attribute(const std::string& name, const std::string& object = "/") const;
  const std::filesystem::path& path() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meltproof
