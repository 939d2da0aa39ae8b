// SPDX-License-Identifier: GPL-3.0-or-later
// Measured spectra: response of a detector, transmission of windows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meltproof::imaging {

/// A quantity over wavelength, linear between its points and zero outside them.
class Spectrum {
 public:
  /// @param wavelength m, increasing, two or more; @param value not negative, as many.
  /// @param origin what messages call it. @throws InputError if they are not so.
  Spectrum(std::vector<double> wavelength, std::vector<double> value, const std::string& origin);
  double at(double wavelength) const;
  double lower() const { return wavelength_.front(); }
  double upper() const { return wavelength_.back(); }
  const std::vector<double>& wavelength() const { return wavelength_; }

 private:
  std::vector<double> wavelength_, value_;
};

/// Reads two columns of a CSV file whose header names their units: "wavelength [um]" (or [nm], [m])
/// and any name with "[1]" or "[%]". Lines that begin with # are left out.
/// @throws InputError naming file, line and what was expected.
Spectrum read_spectrum(const std::filesystem::path& path);

/// Product of spectra over the wavelengths that all of them cover, at the points of all.
/// @throws InputError if there are no such wavelengths.
Spectrum product(const std::vector<Spectrum>& spectra);

/// Radiance of a black body weighted by a spectrum, integral of w(lambda) L(lambda, T) d lambda, by
/// adaptive quadrature between the spectrum's points to a relative 1e-10.
/// @param temperature K; zero or less gives 0. @return W m-2 sr-1.
double weighted_radiance(const Spectrum& weight, double temperature);

/// The temperature at which weighted_radiance() is `radiance`, to 1e-6 K. NaN where none has it.
double weighted_temperature(const Spectrum& weight, double radiance);

/// What a window transmits of a black body's radiation as a detector sees it,
/// integral(r tau L) / integral(r L). It depends a little on the temperature.
double effective_transmission(const Spectrum& response, const Spectrum& window, double temperature);

}  // namespace meltproof::imaging
