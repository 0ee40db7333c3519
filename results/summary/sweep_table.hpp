#pragma once

#include <string>
#include <vector>

#include "analysis/findings/finding.hpp"

namespace mpm {

/// What one study of a sweep gave.
struct SweepRow {
  std::string choice;  ///< empty for the base study
  std::string value;
  bool healthy = true;  ///< the basis case passed its self-check
  std::string trouble;  ///< why it could not be run; empty when it was
  std::vector<Finding> findings;
};

/// The sweep as a table in Markdown: one line a study, grouped by choice, the base study first, one column a
/// headline number with its interval in brackets. A star marks a study whose basis case fails its
/// self-check; one that could not be run has no numbers, and the reason below the table.
std::string sweep_table(const std::vector<SweepRow>& rows);

}  // namespace mpm
