#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/findings/study_findings.hpp"
#include "bench/console/progress.hpp"

namespace mpm {

/// The number of loops on which each method failed, in one study or several; a command prints it at its end,
/// quiet or not.
class FailureTally {
 public:
  void add(const StudyFindings& findings);
  void add(const std::string& method, const VerdictFailures& failures);
  /// Prints a warning for each method that failed.
  void tell(Progress& progress) const;

 private:
  std::vector<std::pair<std::string, VerdictFailures>> methods_;
};

}  // namespace mpm
