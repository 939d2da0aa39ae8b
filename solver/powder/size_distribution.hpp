// SPDX-License-Identifier: GPL-3.0-or-later
// Log-normal particle size distributions, as laser diffraction reports them (by volume) and as
// spheres are drawn (by number).
#pragma once

#include <optional>
#include <string>

#include "solver/powder/random.hpp"

namespace meltproof::solver {

/// How the sizes of one powder are given.
struct SizeSettings {
  double d50 = 13.7e-6;           ///< m
  std::optional<double> d10, d90; /**< m; both or none. Then the width is fitted to them. */
  double geometric_deviation =
      1.35;               ///< 1; geometric standard deviation, if d10 and d90 are absent
  double truncation = 2;  ///< geometric standard deviations kept on each side of d50
  bool by_volume = true;  ///< d10, d50, d90 are of the volume, not of the number
};

/// A log-normal distribution of diameters by number, cut at both ends.
/// If d is log-normal by number with median m and deviation s of ln d, then it is log-normal by
/// volume with median m exp(3 s^2) and the same s (Hatch and Choate 1929).
class SizeDistribution {
 public:
  /// The width from d10 and d90 is ln(d90/d10) / (2 x 1.28155). @param powder named in messages.
  /// @throws InputError unless d10 < d50 < d90, or if only one of d10, d90 is given.
  SizeDistribution(const SizeSettings& settings, const std::string& powder);

  /// A diameter, m: drawn anew until it lies within the cut.
  double draw(Random& random) const;
  /// Density by number at diameter d, 1/m; 0 outside the cut.
  double number_density(double d) const;
  /// Mean of d^k by number, m^k, of the cut distribution.
  double moment(int k) const;
  /// The diameter below which a share q of the volume lies, m, of the cut distribution.
  double volume_quantile(double q) const;

  double median() const { return median_; }        ///< by number, of the uncut distribution, m
  double deviation() const { return deviation_; }  ///< of ln d
  double smallest() const { return smallest_; }    ///< m
  double largest() const { return largest_; }      ///< m

 private:
  double share(int k) const;  ///< of the uncut k-weighted distribution that lies within the cut
  double median_, deviation_, smallest_, largest_;
};

}  // namespace meltproof::solver
