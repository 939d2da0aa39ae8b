// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/linescan/measured_line.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "validation/linescan/json_numbers.hpp"

namespace meltproof::validation {
namespace {

using nlohmann::json;

double silicon_of(const ElementFractions& base) {
  const auto at = base.find("Si");
  return at == base.end() ? 0 : at->second;
}

json profile_json(const ConcentrationProfile& profile) {
  const std::size_t n = profile.concentration.size();
  return {{"concentration", numbers_json(profile.concentration)},
          {"concentration_u", filled_json(profile.uncertainty, n)},
          {"concentration_u_counting", filled_json(profile.counting, n)}};
}

/// The uncertainty of a point by the scan's sigma or, without one, by its counts; NaN if neither.
double uncertainty_of(const ConcentrationProfile& profile, std::size_t i) {
  return !profile.uncertainty.empty() ? profile.uncertainty[i]
         : !profile.counting.empty()  ? profile.counting[i]
                                      : std::nan("");
}

/// How far two estimates lie apart over the points that are not flagged.
json difference_json(const LineScan& scan, const ConcentrationProfile& a,
                     const ConcentrationProfile& b, double& in_u) {
  double mean = 0, squares = 0, chi = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < scan.position.size(); ++i) {
    if (std::find(scan.flagged.begin(), scan.flagged.end(), i) != scan.flagged.end()) {
      continue;
    }
    const double difference = a.concentration[i] - b.concentration[i];
    mean += difference;
    squares += difference * difference;
    chi += std::pow(difference / std::hypot(uncertainty_of(a, i), uncertainty_of(b, i)), 2);
    ++n;
  }
  const auto count = static_cast<double>(n);
  in_u = n > 0 ? std::sqrt(chi / count) : std::nan("");
  return {{"mean_difference", n > 0 ? number_json(mean / count) : json()},
          {"rms_difference", n > 0 ? number_json(std::sqrt(squares / count)) : json()},
          {"rms_in_u", number_json(in_u)}};
}

struct Named {
  std::string name;
  ConcentrationProfile profile;
};

ConcentrationProfile stated(const LineScan& scan) {
  return {scan.position, scan.alloy->fraction, scan.alloy->uncertainty, {}};
}

/// Whether a point that is compared has no positive uncertainty.
bool lacks_one(const LineScan& scan, const std::vector<double>& u) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (!(u[i] > 0) &&
        std::find(scan.flagged.begin(), scan.flagged.end(), i) == scan.flagged.end()) {
      return true;
    }
  }
  return false;
}

void check_uncertainty(MeasuredLine& line, const std::string& place) {
  auto& u = line.profile.uncertainty;
  if (lacks_one(line.scan, u)) {
    line.warnings.push_back(
        {"zero_uncertainty",
         fmt::format("{}: some uncertainties are zero or missing, so none is used.", place)});
    u.clear();
  }
  auto& counting = line.profile.counting;
  if (lacks_one(line.scan, counting)) {
    counting.clear();  // a point without counts has no relative noise
  }
  if (u.empty() && counting.empty()) {
    line.warnings.push_back(
        {"no_uncertainty",
         fmt::format("{}: neither a sigma nor counts of the element are in it, so there is no "
                     "reduced chi-square: export the columns of uncertainties too.",
                     place)});
  }
}

}  // namespace

json estimates_json(const LineScan& scan, const MeasuredRequest& request, json& agreement,
                    std::vector<Warning>& warnings) {
  json estimates = {{"Al", json()}, {"Si", json()}, {"least_squares", json()}};
  std::vector<Named> all;
  if (scan.alloy) {
    estimates["stated"] = profile_json(stated(scan));
    agreement = json::object();
    return estimates;
  }
  if (scan.elements.contains("Al")) {
    all.push_back({"Al", concentration_from_aluminium(scan)});
    estimates["Al"] = profile_json(all.back().profile);
  }
  if (scan.elements.contains("Si")) {
    const double silicon = silicon_of(request.base);
    all.push_back({"Si", concentration_from_silicon(scan, silicon)});
    estimates["Si"] = profile_json(all.back().profile);
    estimates["Si"]["silicon_of_base"] = silicon;
    estimates["Si"]["base_assumed"] = !request.base_given;
  }
  try {
    const auto squares = concentration_by_least_squares(scan, request.base);
    all.push_back({"least_squares", squares.profile});
    auto& entry = estimates["least_squares"] = profile_json(squares.profile);
    entry["amount"] = numbers_json(squares.amount);
    entry["reduced_chi_square"] = filled_json(squares.reduced_chi_square, scan.position.size());
    entry["covariance"] = squares.covariance;
    entry["weighted"] = squares.weighted;
    entry["base_assumed"] = !request.base_given;
    auto chi = squares.reduced_chi_square;
    std::sort(chi.begin(), chi.end());
    if (!chi.empty() && chi[chi.size() / 2] > 4) {
      warnings.push_back(
          {"no_mixture",
           fmt::format("{}: half of the points have a reduced chi-square above {:.3g} as a mixture "
                       "of AlSi10Mg and the steel: the base composition, the uncertainties or the "
                       "quantification do not fit.",
                       scan.path.string(), chi[chi.size() / 2])});
    }
  } catch (const InputError& problem) {
    if (request.from == Estimate::least_squares) {
      throw;
    }
    estimates["least_squares_missing"] = problem.what();
  }
  agreement = json::object();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      double in_u = 0;
      agreement[all[i].name + "_" + all[k].name] =
          difference_json(scan, all[i].profile, all[k].profile, in_u);
      // Al and least squares share their counts; only Al and Si are independent.
      if (all[i].name == "Al" && all[k].name == "Si" && in_u > 2) {
        warnings.push_back(
            {"estimates_disagree",
             fmt::format("{}: the concentrations from Al and from Si differ by {:.3g} of their "
                         "uncertainties (root mean square).",
                         scan.path.string(), in_u)});
      }
    }
  }
  return estimates;
}

MeasuredLine read_measured_line(const MeasuredRequest& request) {
  MeasuredLine line;
  line.scan = read_line_scan(request.path, request.options);
  if (line.scan.empty_slot) {
    return line;
  }
  const std::string place = request.path.string();
  for (const auto& remark : line.scan.remarks) {
    line.warnings.push_back({"export", fmt::format("{}: {}", place, remark)});
  }
  if (line.scan.voltage && std::abs(*line.scan.voltage - request.voltage) > 0.01) {
    line.warnings.push_back(
        {"voltage",
         fmt::format("{}: it was measured at {} kV and the interaction volume is computed for {} "
                     "kV: give --voltage.",
                     place, *line.scan.voltage, request.voltage)});
  }
  line.estimates = estimates_json(line.scan, request, line.agreement, line.warnings);
  line.profile = line.scan.alloy                       ? stated(line.scan)
                 : request.from == Estimate::aluminium ? concentration_from_aluminium(line.scan)
                 : request.from == Estimate::silicon
                     ? concentration_from_silicon(line.scan, silicon_of(request.base))
                     : concentration_by_least_squares(line.scan, request.base).profile;
  check_uncertainty(line, place);
  if (line.scan.flagged.size() == line.scan.position.size()) {
    throw InputError(fmt::format(
        "{}: every point has a total outside 95 to 105 % (the first {:.4g} %), so none can be "
        "compared: export all elements, not normalised, in percent.",
        place, 100 * line.scan.total.front()));
  }
  return line;
}

}  // namespace meltproof::validation
