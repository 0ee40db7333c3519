#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"

namespace mpm {

/// What somebody says about the loops of a blind export.
struct OutsideVerdicts {
  std::shared_ptr<const AssessmentForm> form;
  std::vector<AssessmentRecord> answers;   ///< one for each record of the campaign, in their order
  std::vector<double> calibration_scores;  ///< CalibrationLoop::scores of each calibration loop; NaN: none
  bool says_which_loops = false;  ///< the file has the hash of the loops, and it is that of the campaign
};

/// Reads a file of verdicts (CSV, docs/bring_your_own.md) on the loops of blind_order(), with calibration
/// loops if its hash says so. The method gets the name `name`; its description says which answers the columns
/// of the file give, and that it comes from outside. A loop that the file does not name, or for which it has
/// an error, gets a failed verdict. As with any method, a verdict on a window counts only if there is one on
/// the whole loop. Windows of calibration loops are not kept.
///
/// Errors: InputError "FILE:LINE: COLUMN: found ...; allowed: ..." if the file cannot be read, has other
/// columns, another value, an unknown loop, a loop twice, or verdicts on other loops; and if `name` is not a
/// valid name or a method of this program has it.
OutsideVerdicts read_verdicts(const std::filesystem::path& path, const std::string& name,
                              const Campaign& campaign);

}  // namespace mpm
