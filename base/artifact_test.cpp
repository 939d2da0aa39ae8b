// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/artifact.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

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

TEST(Artifact, GroupsAreCopiedInAndOutAndAFileMadeInMemoryReadsTheSame) {
  const auto folder = fresh_folder("artifact_copy");
  const std::vector<double> values{1.5, -2, 3e300};
  ArtifactWriter source(folder / "whole.h5", "meltproof test");
  source.write("part/0/values", std::span<const double>(values), {3}, "m", "some");
  source.write("part/1/values", std::span<const double>(values), {3}, "m", "others");
  {
    ArtifactWriter piece(folder / "piece.h5", "meltproof piece", true);
    source.copy_to(piece, "part/1");
    EXPECT_FALSE(std::filesystem::exists(folder / "piece.h5"));
    piece.commit({});
  }
  const ArtifactReader piece(folder / "piece.h5", "meltproof piece");
  EXPECT_FALSE(piece.has("part/0/values"));
  ArtifactWriter again(folder / "again.h5", "meltproof test");
  again.copy_from(piece, "part/1");
  again.commit({});
  const auto read = ArtifactReader(folder / "again.h5").read<double>("part/1/values");
  EXPECT_EQ(read.values, values);
  EXPECT_EQ(read.units, "m");
  EXPECT_THROW(ArtifactWriter(folder / "no.h5", "meltproof test").copy_from(piece, "part/0"),
               std::runtime_error);
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
