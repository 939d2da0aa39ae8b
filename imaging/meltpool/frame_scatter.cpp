// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/frame_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gsl/gsl_randist.h>

namespace meltproof::imaging {

double draw_mean(gsl_rng* random, const Series& s) {
  if (s.n < 2) return 0;
  return s.uncertainty_of_mean() * gsl_ran_tdist(random, std::max(2.0, s.effective - 1));
}

Effect windowed(const Analysis& a, double from, double to) {
  std::vector<const FrameResult*> used;
  for (const auto& f : a.frames)
    if (a.only_incomplete ? f.found : f.complete) used.push_back(&f);
  const auto n = static_cast<double>(used.size());
  Effect mean;
  double count = 0;
  for (auto i = static_cast<std::size_t>(from * n); i < static_cast<std::size_t>(to * n); ++i) {
    mean.length += used[i]->length;
    mean.depth += used[i]->depth;
    count += 1;
  }
  if (count > 0) mean.length /= count, mean.depth /= count;
  return mean;
}

OwnShare own_share(const Stack& stack, const Analysis& a, double noise_factor, double along,
                   double across, std::uint64_t seed) {
  if (a.length.n < 3 || !a.level.value) return {};
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 &gsl_rng_free);
  gsl_rng_set(random.get(), static_cast<unsigned long>(seed));
  const std::vector<float> mean = smoothed(stack, 0, 0);
  const std::size_t width = stack.columns / Stack::samples;
  RegionFinder finder(width, stack.lines, a.level.interpolation);
  std::vector<float> image(width * stack.lines), marked;
  std::vector<double> length, depth;
  for (std::size_t k = 0; k < 64; ++k) {
    for (std::size_t l = 0; l < stack.lines; ++l)
      for (std::size_t i = 0; i < width; ++i)
        image[l * width + i] = mean[l * stack.columns + i * Stack::samples + k % Stack::samples] +
                               static_cast<float>(noise_factor * stack.noise *
                                                  gsl_ran_gaussian_ziggurat(random.get(), 1));
    if (a.level.step) {
      mark_fronts(image, width, stack.lines, true, *a.level.step, marked);
      image.swap(marked);
    }
    const auto region = finder.largest(image, *a.level.value);
    if (!region || region->pixels < smallest_pool) continue;
    length.push_back(along * region->x.size());
    depth.push_back(across * region->y.size());
  }
  const auto share = [](const Series& frames, const std::vector<double>& noise) {
    const double seen = frames.deviation * frames.deviation;
    if (!(seen > 0) || noise.size() < 32) return 1.0;
    return std::sqrt(std::max(0.0, 1 - std::pow(summarise(noise).deviation, 2) / seen));
  };
  return {share(a.length, length), share(a.depth, depth)};
}

}  // namespace meltproof::imaging
