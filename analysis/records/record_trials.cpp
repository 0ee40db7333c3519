#include "analysis/records/record_trials.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/verdict_evidence.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"

namespace mpm {
namespace {

/// The gaps of the record, which the simulated records have as well.
std::string shape_text(const PlantRecord& record) {
  std::string shape;
  for (Eigen::Index k = 0; k < record.samples(); ++k)
    for (Eigen::Index cv = 0; cv < record.y.rows(); ++cv)
      shape += std::isnan(record.y(cv, k)) ? '-' : 'y';
  return shape;
}

/// Describes what the answers on simulated records depend on besides their study.
std::string judged_text(const RecordFrame& frame, const TrialFrame& made, std::string_view seen) {
  return fmt::format(
      "judged as the record {} is: {} samples before it, {} not judged, {:g} of the noise as "
      "bias, {} % of errors, {}, benchmark {} to {}{}, costs since {}",
      digest_of(seen), made.lead, frame.unjudged, made.bias, 100.0 * frame.model_error,
      frame.as_kept.assessment.model == AssessmentModel::benchmark ? "which methods allow for"
                                                                   : "of which methods know nothing",
      made.record.benchmark.first, made.record.benchmark.second, frame.finds_benchmark ? ", found" : "",
      frame.since);
}

/// The frame from which simulated records are made. If the model may be wrong and the record begins in the
/// middle of operation, the simulated records do so as well.
TrialFrame trial_frame(const RecordAssessment& assessment, const RecordFrame& frame, const Study& study,
                       int trials) {
  constexpr Eigen::Index kLongLead = 2;  // settling times
  TrialFrame made{.record = assessment.record, .study = {}};
  if (frame.finds_benchmark)
    made.record.benchmark = {0, 0};
  if (frame.model_error > 0.0) {
    made.bias = kTrialBias;
    made.lead = std::min(kLongLead * frame.unjudged, assessment.record.samples() - 1);
  }
  const Study longer =
      recorded_study(study, with_lead(assessment.record, made.lead), frame.methods, std::nullopt);
  const int faulty = trials / 2;
  made.study = trial_study(longer, {.healthy = trials - faulty,
                                    .faulty = faulty,
                                    .model_error = kWorseWorlds * frame.model_error,
                                    .judged = judged_text(frame, made, shape_text(assessment.record))});
  return made;
}

/// Returns whether some method can name this source.
bool is_named_by_methods(RecordSource source) {
  return source == RecordSource::mismatch || source == RecordSource::disturbance ||
         source == RecordSource::both || source == RecordSource::valve;
}

/// The methods that assess every simulated record: all but the first one, which costs more than all else.
/// Only its sources count, and only for records that the model does not explain.
std::vector<std::string> asked_of_all(const RecordFrame& frame) {
  return {frame.methods.begin() + 1, frame.methods.end()};
}

/// Asks the first method of the frame about the loops `unexplained` only, and the other methods about all
/// loops; null: every method about all loops.
LoopAssessor source_assessor(const RecordFrame& frame, const std::shared_ptr<const TrialFrame>& made,
                             const std::vector<std::string>& methods,
                             std::shared_ptr<const std::set<std::int64_t>> unexplained) {
  const auto assessor_of = [&](const std::vector<std::string>& names) {
    const auto asked = std::make_shared<RecordFrame>(frame);
    asked->methods = names;
    return trial_assessor(asked, made);
  };
  if (!unexplained || methods.front() != frame.methods.front())
    return assessor_of(methods);
  const std::vector<std::string> others(methods.begin() + 1, methods.end());
  AssessmentRecord unasked = unassessed(assessment_forms(made->study, {methods.front()})).front();
  unasked.status = AssessmentStatus::not_applicable;
  unasked.reason = "the model explains the record";
  return [all = assessor_of(methods), rest = others.empty() ? LoopAssessor{} : assessor_of(others),
          unasked = std::move(unasked),
          unexplained = std::move(unexplained)](const ExperimentRecord& experiment) {
    if (unexplained->contains(experiment.draw.index))
      return all(experiment);
    std::vector<AssessmentRecord> said = rest ? rest(experiment) : std::vector<AssessmentRecord>{};
    said.insert(said.begin(), unasked);
    return said;
  };
}

}  // namespace

CountsOfSource add_trial(RecordAssessment& assessment, const Study& study,
                         const std::shared_ptr<const RecordFrame>& frame, int trials,
                         const TrialRunner& run_trials) {
  if (trials == 0) {
    assessment.no_trial = "no calibration run was asked for (--trials)";
    return {};
  }
  try {
    const auto made = std::make_shared<TrialFrame>(trial_frame(assessment, *frame, study, trials));
    const auto alike = std::make_shared<RecordFrame>(*frame);
    alike->as_kept.monitoring.reset();
    alike->closed.monitoring.reset();
    alike->late = {};
    alike->habit.reset();
    const auto run = [alike, made, run_trials](const std::vector<std::string>& methods,
                                               const std::shared_ptr<const std::set<std::int64_t>>& asked) {
      Study with_methods = made->study;
      with_methods.methods = methods;
      return run_trials({std::move(with_methods), [=](const std::vector<std::string>& names) {
                           return source_assessor(*alike, made, names, asked);
                         }});
    };
    const std::vector<std::string> always = asked_of_all(*frame);
    const TrialLoops loops = run(always, {});
    const std::size_t last = always.size() - 1;
    RecordTrial trial{loops.archive,
                      static_cast<std::int64_t>(loops.records.size()),
                      {},
                      trial_findings(made->study, last, loops.records, assessment.model)};
    for (const AssessmentRecord& said : assessment.said) {
      const auto place = std::find(always.begin(), always.end(), said.form->method().name) - always.begin();
      trial.methods.push_back(place == std::ssize(always)
                                  ? std::nullopt
                                  : std::optional(trial_findings(made->study, static_cast<std::size_t>(place),
                                                                 loops.records, said)));
    }
    const Eigen::Index ny = assessment.study.cv_count();
    trial.cost = number_thresholds(loops.records, last, kCostNumber, ny);
    trial.cost_since = number_thresholds(loops.records, last, kCostSinceNumber, ny);
    trial.fit = fit_threshold(loops.records, last);
    trial.health = number_thresholds(loops.records, last, "health", 1)(0);
    trial.counts = trial_counts(loops.records, last, trial.model);
    assessment.trial = std::move(trial);
    return [loops, run, last, methods = frame->methods, model = assessment.trial->model](RecordSource named) {
      if (!is_named_by_methods(named))
        return trial_counts(loops.records, last, model);
      const auto asked = std::make_shared<std::set<std::int64_t>>();
      for (const std::int64_t index : unexplained_records(loops.records, last, model))
        asked->insert(index);
      return trial_counts(run(methods, asked).records, last + 1, model, named);
    };
  } catch (const InputError& error) {
    assessment.no_trial = fmt::format("no loop like this one can be simulated: {}", error.what());
    return {};
  }
}

TrialRunner trials_in_memory(QpSolverFactory factory) {
  return [factory = std::move(factory)](const TrialRequest& request) {
    const BasisCase basis = run_basis_case(request.study, factory);
    ExperimentRunner runner(request.study, basis, std::vector<std::string>{}, factory);
    const LoopAssessor assess = request.assessor(request.study.methods);
    const auto records = std::make_shared<std::vector<ExperimentRecord>>();
    for (std::int64_t index = 0; index < request.study.experiments.total(); ++index) {
      ExperimentRecord record = runner.run(index, StorePolicy::all);
      answer(record, request.study, assess);
      record.loop.reset();
      records->push_back(std::move(record));
    }
    return TrialLoops{*records, {}, records};
  };
}

}  // namespace mpm
