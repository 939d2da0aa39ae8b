// SPDX-License-Identifier: GPL-3.0-or-later
// Planck's law and its integral with a weight, for radiometry.cpp and spectrum.cpp.
#pragma once

#include <functional>

namespace meltproof::imaging {

/// Spectral radiance of a black body, W m-3 sr-1. @param wavelength m; @param inverse_temperature
/// 1/K.
double planck_radiance(double wavelength, double inverse_temperature);

/// Integral of weight(lambda) times it over a range in which the weight is smooth, by
/// Gauss and Legendre with 20 points.
double planck_integral(double lower, double upper, double inverse_temperature,
                       const std::function<double(double)>& weight);

}  // namespace meltproof::imaging
