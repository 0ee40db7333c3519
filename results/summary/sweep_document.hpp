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
  std::string trouble;  ///< why it could not be run; empty when it was
  std::vector<Finding> findings;
};

/// The sweep as a table: one line a study, grouped by choice, the base study first, one column a headline
/// number. A star marks a study whose basis case fails its self-check; one that could not be run has no
/// numbers, and the reason below the table. `rows` must outlive the document.
Document sweep_document(const std::string& title, const std::vector<SweepRow>& rows);

}  // namespace mpm
