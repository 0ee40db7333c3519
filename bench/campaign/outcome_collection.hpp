#pragma once

#include <cstdint>

#include "bench/outcome/experiment_outcome.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// Brings outcomes, which come in any order, into the order of a campaign.
class OutcomeCollection {
 public:
  explicit OutcomeCollection(std::int64_t count);

  /// Each experiment at most once.
  void add(ExperimentOutcome outcome);

  /// Moves the records, the audit and its time into the campaign. Every experiment must have been added.
  void move_into(Campaign& campaign);

 private:
  std::vector<ExperimentRecord> records_;
  std::vector<AuditedStep> audit_;
  double audit_seconds_ = 0.0;
};

}  // namespace mpm
