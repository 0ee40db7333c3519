#pragma once

#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "scenarios/loop/audit.hpp"

namespace mpm {

/// What came of one experiment.
struct ExperimentOutcome {
  ExperimentRecord record;
  std::vector<AuditSample> samples;  ///< steps that are still to be audited
  std::vector<AuditedStep> audited;
  double audit_seconds = 0.0;  ///< processor time
};

}  // namespace mpm
