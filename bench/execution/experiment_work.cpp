#include "bench/execution/experiment_work.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "analysis/methods/broken_promise.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/records/trial_record.hpp"
#include "base/system/surroundings.hpp"
#include "base/system/thread_clock.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
ExperimentWork::ExperimentWork(const Study& study, const Study& basis_study, const BasisCase& basis,
                               const RunOptions& options, const QpSolverFactory& factory)
    : study_(study),
      options_(options),
      basis_(basis),
      basis_study_(basis_study),
      factory_(factory),
      assessor_(options.assessor ? options.assessor() : LoopAssessor{}) {}

ExperimentRunner& ExperimentWork::runner() {
  if (!runner_)
    runner_.emplace(study_, assessment_context(basis_study_, basis_, factory_),
                    assessor_ ? std::vector<std::string>{} : study_methods(study_));
  return *runner_;
}

ExperimentOutcome ExperimentWork::run(std::int64_t index) {
  ExperimentOutcome outcome;
  ExperimentRunner& experiments = runner();
  try {
    AuditSampler sampler(study_.seed, index, audited_share(study_, options_));
    outcome.record = experiments.run(index, assessor_ ? StorePolicy::all : options_.store,
                                     [&](const Controller& controller) { sampler.observe(controller); });
    if (assessor_) {
      answer(outcome.record, study_, assessor_);
      if (options_.store == StorePolicy::none)
        outcome.record.loop.reset();
    }
    outcome.samples = sampler.take();
  } catch (const BrokenPromise&) {
    throw;
  } catch (const std::exception& error) {
    if (is_of_surroundings(error))
      throw;
    outcome = {};
    outcome.record = lost_record(study_, index, error.what());
  }
  return outcome;
}

void ExperimentWork::assess(ExperimentRecord& record, const std::vector<std::string>& methods) {
  ExperimentRunner& experiments = runner();
  try {
    put_answers(experiments.assess(record, methods), record);
  } catch (const BrokenPromise&) {
    throw;
  } catch (const std::exception& error) {
    if (is_of_surroundings(error))
      throw;
    record = lost_record(study_, record.draw.index, error.what());
  }
}

void ExperimentWork::audit(ExperimentOutcome& outcome) {
  if (outcome.samples.empty())
    return;
  const double start = thread_seconds();
  if (!auditor_)
    auditor_.emplace(study_, qp_solver_factory("ipopt"));
  std::optional<Auditor> own;  // for other weights, which are part of the structure of a problem
  if (outcome.record.draw.tuning)
    own.emplace(with_tuning(study_, outcome.record.draw), qp_solver_factory("ipopt"));
  for (const AuditSample& sample : outcome.samples)
    outcome.audited.push_back((own ? *own : *auditor_).check(sample));
  outcome.samples.clear();
  outcome.audit_seconds += thread_seconds() - start;
}

ExperimentRecord lost_record(const Study& study, std::int64_t index, std::string why) {
  ExperimentRecord record;
  record.draw = draw_experiment(study, index);
  record.status = ExperimentStatus::failed;
  record.message = std::move(why);
  record.assessments = unassessed(assessment_forms(study, study_methods(study)));
  return record;
}

void put_answers(std::vector<AssessmentRecord> answers, ExperimentRecord& record) {
  for (AssessmentRecord& said : answers)
    *std::find_if(record.assessments.begin(), record.assessments.end(), [&said](const AssessmentRecord& of) {
      return of.form->method().name == said.form->method().name;
    }) = std::move(said);
}

}  // namespace mpm
