// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/eds/concentration.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/error.hpp"

namespace meltproof::validation {
namespace {

/// Mass fractions of all elements at a point and the factor from what was reported to them.
struct MassPoint {
  ElementFractions mass;
  std::map<std::string, double> factor;
};

MassPoint mass_at(const LineScan& scan, std::size_t point) {
  MassPoint result;
  for (const auto& [name, profile] : scan.elements) {
    result.mass[name] = profile.fraction[point];
    result.factor[name] = 1;
  }
  if (scan.of_atoms) {
    const auto reported = result.mass;
    result.mass = mass_from_atom(reported);
    for (auto& [name, factor] : result.factor) {
      // The relative uncertainty of at% is carried over to wt%.
      factor = reported.at(name) > 0 ? result.mass.at(name) / reported.at(name) : 1.0;
    }
  }
  return result;
}

/// sqrt(N + 2B) of a point in the unit of the reported fraction; NaN without counts.
double counting(const ElementProfile& profile, std::size_t point) {
  if (profile.counts.empty() || !(profile.counts[point] > 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double background = profile.background.empty() ? 0 : profile.background[point];
  const double net = profile.counts[point];
  return profile.fraction[point] * counting_noise(net, background) / net;
}

ConcentrationProfile profile_of(const LineScan& scan, const std::string& symbol,
                                const std::function<double(double)>& concentration) {
  const auto element = scan.elements.find(symbol);
  if (element == scan.elements.end()) {
    throw InputError(fmt::format("{}: the line scan holds no {}: expected a column \"{} wt%\".",
                                 scan.path.string(), symbol, symbol));
  }
  ConcentrationProfile result;
  result.position = scan.position;
  const double slope = concentration(1) - concentration(0);
  for (std::size_t i = 0; i < scan.position.size(); ++i) {
    const MassPoint at = mass_at(scan, i);
    result.concentration.push_back(concentration(at.mass.at(symbol)));
    const double scale = at.factor.at(symbol) * slope;
    if (!element->second.uncertainty.empty()) {
      result.uncertainty.push_back(element->second.uncertainty[i] * scale);
    }
    if (!element->second.counts.empty()) {
      result.counting.push_back(counting(element->second, i) * scale);
    }
  }
  return result;
}

/// Uncertainty of each element at a point, in mass fraction; empty if one has none.
std::vector<double> weights_at(const LineScan& scan, std::size_t point, const MassPoint& at) {
  std::vector<double> u;
  for (const auto& [name, profile] : scan.elements) {
    const double value =
        profile.uncertainty.empty() ? counting(profile, point) : profile.uncertainty[point];
    if (!(value > 0)) {
      return {};
    }
    u.push_back(value * at.factor.at(name));
  }
  return u;
}

double fraction_in(const ElementFractions& alloy, const std::string& symbol) {
  const auto at = alloy.find(symbol);
  return at == alloy.end() ? 0 : at->second;
}

}  // namespace

ConcentrationProfile concentration_from_aluminium(const LineScan& scan) {
  return profile_of(scan, "Al", [](double mass) { return concentration_from_aluminium(mass); });
}

ConcentrationProfile concentration_from_silicon(const LineScan& scan, double silicon_of_base) {
  return profile_of(scan, "Si", [silicon_of_base](double mass) {
    return concentration_from_silicon(mass, silicon_of_base);
  });
}

LeastSquares concentration_by_least_squares(const LineScan& scan, const ElementFractions& base) {
  const auto rows = static_cast<Eigen::Index>(scan.elements.size());
  Eigen::MatrixX2d design(rows, 2);
  Eigen::Index row = 0;
  for (const auto& [name, profile] : scan.elements) {
    design.row(row++) << fraction_in(alsi10mg_composition(), name), fraction_in(base, name);
  }
  const double determinant = (design.transpose() * design).determinant();
  if (rows < 2 || !(determinant > 1e-6)) {
    throw InputError(fmt::format(
        "{}: least squares need at least two elements that tell AlSi10Mg from the steel, for "
        "example Al and Fe; found {}.",
        scan.path.string(), rows));
  }
  LeastSquares result;
  std::vector<MassPoint> points;
  std::vector<std::vector<double>> u;
  for (std::size_t i = 0; i < scan.position.size(); ++i) {
    points.push_back(mass_at(scan, i));
    u.push_back(weights_at(scan, i, points.back()));
  }
  result.weighted = std::none_of(u.begin(), u.end(), [](const auto& list) { return list.empty(); });
  result.profile.position = scan.position;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows), mass(rows);
    row = 0;
    for (const auto& [name, value] : points[i].mass) {
      mass(row) = value;
      if (result.weighted) {
        weight(row) = 1 / u[i][static_cast<std::size_t>(row)];
      }
      ++row;
    }
    const Eigen::MatrixX2d a = weight.asDiagonal() * design;
    const Eigen::VectorXd b = weight.asDiagonal() * mass;
    const Eigen::Vector2d amounts = a.colPivHouseholderQr().solve(b);
    Eigen::Matrix2d covariance = (a.transpose() * a).inverse();
    const double squares = (a * amounts - b).squaredNorm();
    const auto freedom = static_cast<double>(rows - 2);
    if (!result.weighted) {
      covariance *= freedom > 0 ? squares / freedom : std::numeric_limits<double>::quiet_NaN();
    } else if (freedom > 0) {
      result.reduced_chi_square.push_back(squares / freedom);
    }
    const double p = amounts(0), q = amounts(1), sum = p + q;
    const Eigen::Vector2d slope(q / (sum * sum), -p / (sum * sum));
    result.profile.concentration.push_back(p / sum);
    result.profile.uncertainty.push_back(std::sqrt(slope.dot(covariance * slope)));
    result.amount.push_back(sum);
    result.covariance.push_back({covariance(0, 0), covariance(0, 1), covariance(1, 1)});
  }
  auto& spread = result.profile.uncertainty;
  if (std::any_of(spread.begin(), spread.end(), [](double value) { return !(value > 0); })) {
    spread.clear();  // two elements without uncertainties leave nothing to tell it from
  }
  return result;
}

}  // namespace meltproof::validation
