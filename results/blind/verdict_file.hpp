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
  std::vector<AssessmentRecord> answers;   ///< of each record of the campaign, in their order
  std::vector<double> calibration_scores;  ///< CalibrationLoop::scores of each calibration loop; NaN: none
  bool says_which_loops = false;  ///< the file has the hash of the loops, and it is that of the campaign
};

/// Reads a file of verdicts (CSV, docs/bring_your_own.md) on the loops of blind_order(), with calibration
/// loops when its hash says so. The method is called `name`; its description says what the columns of the
/// file answer, and that it comes from outside. A loop that the file does not name, or for which it has an
/// error, is a failed verdict. A verdict on a window counts where there is one on the loop as a whole, as
/// with any method; of calibration loops no windows are kept.
///
/// Errors: InputError "FILE:LINE: COLUMN: found ...; allowed: ..." for a file that cannot be read, other
/// columns, another value, an unknown loop, a loop that stands there twice, verdicts on other loops; and
/// for a name that is none or that a method of this program has.
OutsideVerdicts read_verdicts(const std::filesystem::path& path, const std::string& name,
                              const Campaign& campaign);

}  // namespace mpm
