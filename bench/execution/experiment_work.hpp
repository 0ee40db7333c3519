#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/outcome/outcome_bytes.hpp"

namespace mpm {

/// The work of one worker: runs experiments and audits steps. Belongs to one thread or process.
class ExperimentWork {
 public:
  /// Runs experiments of `study` with methods that have learnt from the basis case of `basis_study`.
  /// `factory` makes the solvers of the controllers: that of `options.solver`, or the part of it that may run
  /// in threads. Everything but `factory` must outlive this object.
  ExperimentWork(const Study& study, const Study& basis_study, const BasisCase& basis,
                 const RunOptions& options, const QpSolverFactory& factory);

  /// Runs experiment `index` without its audits. An exception makes a record `failed` with its text. Only
  /// BrokenPromise and failures of the surroundings (is_of_surroundings()) are thrown.
  ExperimentOutcome run(std::int64_t index);

  /// Assesses an experiment by these of its methods, and puts their answers in their places. The experiment
  /// was run before, has the status ok and has its loop. Errors: as run().
  void assess(ExperimentRecord& record, const std::vector<std::string>& methods);

  /// Audits the samples of an outcome. Calls Ipopt.
  void audit(ExperimentOutcome& outcome);

 private:
  const Study& study_;
  const RunOptions& options_;
  ExperimentRunner& runner();

  const BasisCase& basis_;
  const Study& basis_study_;
  QpSolverFactory factory_;
  std::optional<ExperimentRunner> runner_;  ///< made when first needed
  LoopAssessor assessor_;                   ///< empty: the runner assesses
  std::optional<Auditor> auditor_;          ///< made when first needed
};

/// The record of an experiment that was lost, with the reason.
ExperimentRecord lost_record(const Study& study, std::int64_t index, std::string why);

/// Puts answers in the places of their methods, which the record must have.
void put_answers(std::vector<AssessmentRecord> answers, ExperimentRecord& record);

}  // namespace mpm
