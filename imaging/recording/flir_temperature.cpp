// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaging/recording/flir_temperature.hpp"

#include <cmath>
#include <limits>

namespace meltproof::imaging {

double flir_air_transmission(const FlirConstants& c) {
  const double t = c.atmospheric_temperature - 273.15;
  const double water =
      c.relative_humidity * std::exp(1.5587 + t * (0.06939 + t * (-0.00027816 + t * 6.8455e-7)));
  const double path = std::sqrt(0.5 * c.distance), humid = std::sqrt(water);
  return c.x * std::exp(-path * (c.alpha_1 + c.beta_1 * humid)) +
         (1 - c.x) * std::exp(-path * (c.alpha_2 + c.beta_2 * humid));
}

double flir_counts(const FlirConstants& c, double temperature) {
  return c.planck_r1 / (c.planck_r2 * (std::exp(c.planck_b / temperature) - c.planck_f)) -
         c.planck_o;
}

FlirTemperature::FlirTemperature(const FlirConstants& c) : constants_(c) {
  const double air = flir_air_transmission(c), window = c.window_transmission;
  const double atmosphere = flir_counts(c, c.atmospheric_temperature);
  // From the object to the camera: reflection, air, the window's own emission, air again. Each
  // stray part is attenuated by what lies between it and the detector.
  scale_ = c.emissivity * air * window * air;
  stray_ = (1 - c.emissivity) * air * window * air * flir_counts(c, c.reflected_temperature) +
           (1 - air) * window * air * atmosphere +
           (1 - window) * air * flir_counts(c, c.window_temperature) + (1 - air) * atmosphere;
}

double FlirTemperature::operator()(double counts) const {
  const auto& c = constants_;
  const double object = (counts - stray_) / scale_ + c.planck_o;
  if (!(object > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double logarithm = std::log(c.planck_r1 / (c.planck_r2 * object) + c.planck_f);
  return logarithm > 0 ? c.planck_b / logarithm : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace meltproof::imaging
