#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/findings/study_findings.hpp"
#include "bench/console/progress.hpp"

namespace mpm {

/// On how many loops each method failed, of one study or of several: what a command tells at its end, quiet
/// or not.
class FailureTally {
 public:
  void add(const StudyFindings& findings);
  void add(const std::string& method, const VerdictFailures& failures);
  /// A warning for each method that failed.
  void tell(Progress& progress) const;

 private:
  std::vector<std::pair<std::string, VerdictFailures>> methods_;
};

}  // namespace mpm
