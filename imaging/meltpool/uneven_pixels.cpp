// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/meltpool/uneven_pixels.hpp"

#include <algorithm>

#include <gsl/gsl_randist.h>

namespace meltproof::imaging {

UnevenPixels::UnevenPixels(const Recording& recording, const Analysis& analysis,
                           const PixelSize& pixel, double sigma)
    : analysis_(analysis), sigma_(sigma), dark_(analysis.level.interpolation.dark) {
  std::vector<std::size_t> numbers;
  for (const auto& f : analysis.frames)
    if (f.complete) numbers.push_back(f.index);
  constexpr std::size_t most = 48;  // frames, evenly chosen: their mean is what counts
  const std::size_t step = std::max<std::size_t>(1, (numbers.size() + most - 1) / most);
  for (std::size_t i = 0; i < numbers.size(); i += step)
    frames_.push_back(recording.frame(numbers[i]));
  along_ = pixel.known() ? (analysis.along_x ? pixel.x : pixel.y) : 1;
  across_ = pixel.known() ? (analysis.along_x ? pixel.y : pixel.x) : 1;
  width_ = recording.header().width;
  height_ = recording.header().height;
  gain_.assign(width_ * height_, 1);
  even_ = measure(false).size;
}

Effect UnevenPixels::operator()(gsl_rng* random) {
  for (auto& g : gain_) g = static_cast<float>(1 + sigma_ * gsl_ran_gaussian_ziggurat(random, 1));
  const Effect uneven = measure(false).size;
  return {uneven.length - even_.length, uneven.depth - even_.depth};
}

std::optional<Effect> UnevenPixels::with_gain(double gain) {
  std::fill(gain_.begin(), gain_.end(), static_cast<float>(gain));
  const Mean mean = measure(true);
  if (frames_.empty() || (mean.regions == 0 && mean.at_border > 0)) return std::nullopt;
  return mean.size;
}

UnevenPixels::Mean UnevenPixels::measure(bool whole) {
  RegionFinder finder(width_, height_, analysis_.level.interpolation);
  Mean mean;
  const auto dark = static_cast<float>(dark_);
  for (const Frame& f : frames_) {
    values_.resize(f.values.size());
    for (std::size_t i = 0; i < values_.size(); ++i)
      values_[i] = dark + gain_[i] * (f.values[i] - dark);
    if (analysis_.level.step) {
      mark_fronts(values_, width_, height_, analysis_.along_x, *analysis_.level.step, marked_);
      values_.swap(marked_);
    }
    const auto region = finder.largest(values_, *analysis_.level.value);
    if (!region) continue;
    if (whole && region->at_border()) {
      ++mean.at_border;
      continue;
    }
    mean.size.length += along_ * (analysis_.along_x ? region->x : region->y).size();
    mean.size.depth += across_ * (analysis_.along_x ? region->y : region->x).size();
    mean.regions += 1;
  }
  if (mean.regions > 0) mean.size.length /= mean.regions, mean.size.depth /= mean.regions;
  return mean;
}

}  // namespace meltproof::imaging
