// SPDX-License-Identifier: GPL-3.0-or-later
// What the sample file cannot show: the other byte order, and the inverse of the formula.
#include "imaging/recording/flir.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/atomic_file.hpp"
#include "imaging/recording/flir_temperature.hpp"

namespace meltproof::imaging {
namespace {

TEST(Flir, ReadsBothByteOrders) {
  // A synthetic block of 2 x 1 pixels, written once in each order, with the sample's own constants.
  const auto block = [](bool big) {
    std::string b(64 + 2 * 32 + 36 + 0x466, '\0');
    const auto put = [&](std::size_t at, auto value) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      if (big) std::reverse(raw, raw + sizeof value);
      std::copy(raw, raw + sizeof value, b.begin() + static_cast<std::ptrdiff_t>(at));
    };
    using u16 = std::uint16_t;
    using u32 = std::uint32_t;
    b.replace(0, 3, "FFF");
    put(0x14, u32{100});
    put(0x18, u32{64});
    put(0x1C, u32{2});
    const u32 raw = 128, camera = 164;
    put(64, u16{1});
    put(66, big ? u16{1} : u16{2});
    put(64 + 0x0C, raw);
    put(64 + 0x10, u32{36});
    put(96, u16{0x20});
    put(96 + 0x0C, camera);
    put(96 + 0x10, u32{0x466});
    put(raw, u16{2});
    put(raw + 2, u16{2});
    put(raw + 4, u16{1});
    put(raw + 0x20, u16{17870});
    put(raw + 0x22, u16{17853});
    put(camera, u16{2});
    const std::pair<std::size_t, float> floats[] = {
        {0x20, .95F},      {0x24, 1.F},      {0x28, 293.15F},  {0x2C, 293.15F},
        {0x30, 293.15F},   {0x34, 1.F},      {0x3C, .5F},      {0x58, 21106.76953125F},
        {0x5C, 1501.F},    {0x60, 1.F},      {0x70, .006569F}, {0x74, .01262F},
        {0x78, -.002276F}, {0x7C, -.00667F}, {0x80, 1.9F},     {0x30C, 0.012545257806777954F}};
    for (const auto& [at, value] : floats) put(camera + at, value);
    put(camera + 0x308, std::int32_t{-7340});
    put(camera + 0x464, u16{30});
    return b;
  };
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("meltproof-{}-order.fff", ::getpid());
  for (const bool big : {false, true}) {
    write_file(path, block(big) + block(big));
    const auto recording = open_flir(path);
    EXPECT_EQ(recording.header().frames, 2u);
    const auto f = recording.frame(1);
    EXPECT_EQ(f.counts, (std::vector<float>{17870, 17853}));
    EXPECT_NEAR(f.values[0] - 273.15, 22.46279, 2e-5) << big;
    EXPECT_NEAR(f.values[1] - 273.15, 22.36381, 2e-5) << big;
  }
  std::filesystem::remove(path);
}

TEST(FlirTemperature, InvertsTheCountsOfABlackBodyInDryAirAtNoDistance) {
  FlirConstants c{.planck_r1 = 21106.77,
                  .planck_b = 1501,
                  .planck_f = 1,
                  .planck_o = -7340,
                  .planck_r2 = 0.012545};
  const FlirTemperature temperature(c);
  for (const double t : {250.0, 295.0, 400.0}) EXPECT_NEAR(temperature(flir_counts(c, t)), t, 1e-9);
}

}  // namespace
}  // namespace meltproof::imaging
