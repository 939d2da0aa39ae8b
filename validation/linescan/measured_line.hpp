// SPDX-License-Identifier: GPL-3.0-or-later
// The measured side of a line scan: its concentration, three ways, and what is odd about it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "validation/eds/concentration.hpp"

namespace meltproof::validation {

/// From what the compared concentration is taken.
enum class Estimate { aluminium, silicon, least_squares };

/// Something that a reader of the result should know: a short name and a sentence.
struct Warning {
  std::string name, sentence;
};

struct MeasuredRequest {
  std::filesystem::path path;
  ScanOptions options;
  Estimate from = Estimate::aluminium;
  ElementFractions base = steel_316l_composition();
  bool base_given = false;  ///< otherwise the nominal 316L is assumed
  double voltage = 30;      ///< kV, of the simulated beam, to be held against the file's
};

struct MeasuredLine {
  LineScan scan;
  ConcentrationProfile profile;  ///< the one that is compared
  nlohmann::json estimates;      ///< all that the scan allows, beside each other
  nlohmann::json agreement;      ///< between each two of them
  std::vector<Warning> warnings;
};

/// @throws InputError as read_line_scan(), or if the wanted estimate cannot be had.
MeasuredLine read_measured_line(const MeasuredRequest& request);

/// The estimates of any scan, also of a single point.
nlohmann::json estimates_json(const LineScan& scan, const MeasuredRequest& request,
                              nlohmann::json& agreement, std::vector<Warning>& warnings);

}  // namespace meltproof::validation
