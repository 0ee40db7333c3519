#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/outcome/experiment_outcome.hpp"
#include "results/archive/campaign.hpp"
#include "results/archive/record_bytes.hpp"

namespace mpm {

/// Brings outcomes, which come in any order, into the order of a campaign.
class OutcomeCollection {
 public:
  explicit OutcomeCollection(std::int64_t count);

  /// Each experiment at most once.
  void add(ExperimentOutcome outcome);

  /// Another outcome of an experiment that was added: what of its record is not the same, by name. What its
  /// audit found is added.
  std::vector<std::string> differences(const ExperimentOutcome& outcome, const RecordBytes& format);

  /// Moves the records, the audit and its time into the campaign. Every experiment must have been added.
  /// Throws InputError when the audit of a step has found two things.
  void move_into(Campaign& campaign);

 private:
  std::vector<ExperimentRecord> records_;
  std::vector<AuditedStep> audit_;
  double audit_seconds_ = 0.0;
};

}  // namespace mpm
