// SPDX-License-Identifier: GPL-3.0-or-later
// Which runs are made to see what one number of a track changes: pipelines/studies.toml.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"

namespace meltproof::validation {

/// A run: a case of the solver with some of its numbers set otherwise.
struct StudyRun {
  std::string name = {};              ///< of its result file
  std::string title = {};             ///< what is different, for the report
  std::string track = {};             ///< solver/cases/<track>.toml
  std::string powder = {};            ///< solver/cases/<powder>.toml for a track with a layer
  std::vector<std::string> set = {};  ///< "table.key=value" overrides of the case
};

/// Runs to be compared with each other.
struct StudySeries {
  std::string name = {}, title = {};
  /// - resolution: three spacings, finest last; its uncertainty enters u_num.
  /// - numerical: choices that physics knows nothing of; their spread enters u_num.
  /// - physics: terms and properties; shown, because no spread of them is a numerical error.
  /// - input: an uncertain input, lower and higher than at the base; it enters u_input.
  std::string kind = {};
  std::string base = {};               ///< the run that the others are compared with
  std::vector<std::string> runs = {};  ///< the base among them
  std::string about = {};              ///< what it is for, for the report
  bool counted = true;  ///< false: its uncertainty is shown but does not enter u_num or u_input
  // Of kind input only:
  std::string key = {};          ///< of the case, that its runs change: "laser.absorptivity"
  std::string value = {};        ///< at the base, with unit: "40 um"; empty: a choice between laws
  std::string uncertainty = {};  ///< standard, with unit, or in % of the value; empty for a choice
  std::string reason = {};       ///< where value and uncertainty come from
  bool logarithmic = false;      ///< the input is a factor: its logarithm is what is uncertain
};

/// What a run sets `key` to ("laser.radius=38 um": "38 um"); empty if it does not set it.
std::string setting_of(const StudyRun& run, const std::string& key);

struct StudyDeclaration {
  std::string profile;  ///< whose spacing the base run has
  std::deque<StudyRun> runs;
  std::deque<StudySeries> series;
};

/// The declaration bound to `studies`, which must outlive it.
Input study_input(StudyDeclaration& studies);

/// @throws InputError for two runs or series of one name, a series of a run that is not declared,
///         or without its base, a resolution that has not three runs, or an input without key,
///         reason, value or uncertainty (a choice has neither of these two), or with a run that
///         does not set its key.
void check(const StudyDeclaration& studies, const std::filesystem::path& path);

}  // namespace meltproof::validation
