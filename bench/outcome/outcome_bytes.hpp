#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "results/archive/record_bytes.hpp"
#include "scenarios/loop/audit.hpp"

namespace mpm {

/// The outcome of one experiment.
struct ExperimentOutcome {
  ExperimentRecord record;
  std::vector<AuditSample> samples = {};  ///< steps that are still to be audited
  std::vector<AuditedStep> audited = {};
  double audit_seconds = 0.0;  ///< processor time
};

/// Converts outcomes of the experiments of one study to bytes and back, to pass them between a process and
/// its workers, and to store them in shards.
class OutcomeBytes {
 public:
  /// For the methods of the study, which must outlive this object.
  explicit OutcomeBytes(const Study& study);
  /// For these methods.
  OutcomeBytes(const Study& study, const AssessmentForms& forms);

  std::string to_bytes(const ExperimentOutcome& outcome) const;

  /// The outcome that these bytes were made from. Throws std::runtime_error if the bytes are too short or too
  /// long, InputError for an experiment that the study does not have.
  ExperimentOutcome from_bytes(std::string_view bytes) const;

  /// The names of what differs between the records of two outcomes.
  std::vector<std::string> differences(const ExperimentOutcome& one, const ExperimentOutcome& other) const {
    return records_.differences(one.record, other.record);
  }

 private:
  RecordBytes records_;
};

}  // namespace mpm
