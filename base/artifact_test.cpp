// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/artifact.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "base/artifact_hdf5.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace meltproof {
namespace {

std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::temp_directory_path() / ("meltproof_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

void write_example(const std::filesystem::path& path) {
  ArtifactWriter writer(path, "example");
  const std::vector<double> values(6000, 1.5);
  writer.write("fields/temperature", values, {2000, 3}, "K", "temperature");
  for (std::uint16_t frame = 0; frame < 3; ++frame) {
    const std::vector<std::uint16_t> pixels(8, frame);
    writer.append("frames", pixels, {2, 4}, "count", "frames");
  }
  writer.write("spacing", 1e-5, "m", "spacing");
  writer.commit({});
}

}  // namespace

TEST(Artifact, WhatIsWrittenReadsBackWithItsUnits) {
  const auto folder = fresh_folder("artifact");
  write_example(folder / "a.h5");
  const ArtifactReader reader(folder / "a.h5", "example");
  const auto temperature = reader.read<double>("fields/temperature");
  EXPECT_EQ(temperature.shape, (std::vector<std::size_t>{2000, 3}));
  EXPECT_EQ(temperature.units, "K");
  EXPECT_EQ(temperature.values[5999], 1.5);
  EXPECT_EQ(reader.read_slab<float>("frames", 2, 1), std::vector<float>(8, 2.0F));
  EXPECT_EQ(reader.scalar("spacing"), 1e-5);
  EXPECT_TRUE(reader.has("provenance/threads"));
  EXPECT_FALSE(reader.has("nothing/here"));
  EXPECT_EQ(reader.attribute("revision", "provenance"), code_revision());
  EXPECT_THROW(reader.read<double>("missing"), InputError);
  EXPECT_THROW(reader.read_slab<double>("frames", 2, 2), InputError);
}

TEST(Artifact, EqualResultsAreEqualBytes) {
  const auto folder = fresh_folder("artifact_bytes");
  write_example(folder / "a.h5");
  write_example(folder / "b.h5");
  EXPECT_EQ(sha256_file(folder / "a.h5"), sha256_file(folder / "b.h5"));
}

TEST(Artifact, NothingIsLeftBehindWithoutCommit) {
  const auto folder = fresh_folder("artifact_half");
  {
    ArtifactWriter writer(folder / "a.h5", "example");
    writer.write("x", 1.0, "1", "x");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Artifact, AGroupIsCopiedFromAFileWhoseSetsAreOnePieceIntoOneThatCompresses) {
  const auto folder = fresh_folder("artifact_copy");
  // More than a chunk, and no multiple of one.
  std::vector<double> values(3 * 50000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0.5 * static_cast<double>(i % 1000);
  }
  {
    ArtifactWriter piece(folder / "piece.h5", "meltproof piece");
    piece.reserve<double>("part/1/values", {50000, 3}, "m", "some");
    piece.write("part/1/time", 2.5, "s", "a single number");
    piece.write("part/0/values", std::span<const double>(values), {50000, 3}, "m", "others");
    const auto place = piece.close({});
    EXPECT_FALSE(std::filesystem::exists(folder / "piece.h5"));
    {
      const Handle file{H5Fopen(place.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), &H5Fclose};
      const Handle set{H5Dopen2(file.get(), "part/1/values", H5P_DEFAULT), &H5Dclose};
      ASSERT_GE(
          H5Dwrite(set.get(), native_type<double>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          0);
    }
    piece.put_in_place();
  }
  const ArtifactReader piece(folder / "piece.h5", "meltproof piece");
  EXPECT_GT(std::filesystem::file_size(folder / "piece.h5"), 8 * values.size());
  ArtifactWriter again(folder / "again.h5", "meltproof test");
  again.copy_from(piece, "part/1");
  again.commit({});
  const ArtifactReader reader(folder / "again.h5");
  const auto read = reader.read<double>("part/1/values");
  EXPECT_EQ(read.values, values);
  EXPECT_EQ(read.units, "m");
  EXPECT_EQ(reader.scalar("part/1/time"), 2.5);
  EXPECT_FALSE(reader.has("part/0/values"));
  EXPECT_LT(std::filesystem::file_size(folder / "again.h5"), 2 * values.size());
  EXPECT_THROW(ArtifactWriter(folder / "no.h5", "meltproof test").copy_from(piece, "part/2"),
               InputError);
}

TEST(Artifact, WhatIsReservedHasItsRoomOnTheDiskOrIsRefused) {
  const auto folder = fresh_folder("artifact_room");
  constexpr std::size_t count = 1 << 18;
  ArtifactWriter writer(folder / "a.h5", "example");
  writer.reserve<double>("values", {count}, "m", "filled later");
  struct stat found {};
  ASSERT_EQ(::stat(writer.close({}).c_str(), &found), 0);
  EXPECT_GE(static_cast<std::size_t>(found.st_blocks) * 512, 8 * count);
  // No file may grow that far: as on a full disk.
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4 * count, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  {
    ArtifactWriter refused(folder / "b.h5", "example");
    refused.reserve<double>("values", {count}, "m", "filled later");
    EXPECT_THROW(refused.close({}), std::runtime_error);
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(Artifact, AnotherKindOrNoHdf5IsRefused) {
  const auto folder = fresh_folder("artifact_kind");
  write_example(folder / "a.h5");
  std::ofstream(folder / "text.h5") << "hello";
  EXPECT_THROW(ArtifactReader(folder / "a.h5", "meltproof run"), InputError);
  EXPECT_THROW(ArtifactReader(folder / "text.h5"), InputError);
  EXPECT_THROW(ArtifactReader(folder / "none.h5"), InputError);
}

TEST(Provenance, ChecksumsAreSha256) {
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(sha256_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(AtomicFile, IsThereWholeOrNotAtAll) {
  const auto folder = fresh_folder("atomic");
  write_file(folder / "sub" / "a.txt", "one");
  EXPECT_EQ(read_file(folder / "sub" / "a.txt"), "one");
  {
    const AtomicFile abandoned(folder / "b.txt");
    std::ofstream(abandoned.temporary()) << "half";
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "b.txt"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

}  // namespace meltproof
