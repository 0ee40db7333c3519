#pragma once

#include <cstdint>
#include <vector>

#include "bench/outcome/experiment_outcome.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// What the audit of a campaign found.
class AuditCollection {
 public:
  void add(const ExperimentOutcome& outcome);
  /// Another outcome of an experiment that was added.
  void add_repeated(const ExperimentOutcome& outcome);

  /// Moves the audit and its time into the campaign. Throws InputError for a step with two results.
  void move_into(Campaign& campaign);

 private:
  std::vector<AuditedStep> audit_;
  double seconds_ = 0.0;
};

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
  AuditCollection audit_;
};

}  // namespace mpm
