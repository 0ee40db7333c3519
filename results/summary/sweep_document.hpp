#pragma once

#include <string>
#include <vector>

#include "analysis/findings/finding.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// The results of one study of a sweep.
struct SweepRow {
  std::string choice;  ///< empty for the base study
  std::string value;
  bool healthy = true;  ///< the basis case passed its self-check
  std::string trouble;  ///< why the study could not be run; empty if it was run
  std::vector<Finding> findings;
};

/// Makes a table of the sweep: one line per study, grouped by choice, with the base study first, and one
/// column per headline number. A star marks a study whose basis case fails its self-check. A study that could
/// not be run has no numbers; the reason is below the table. `rows` must outlive the document.
Document sweep_document(const std::string& title, const std::vector<SweepRow>& rows);

}  // namespace mpm
