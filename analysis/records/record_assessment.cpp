#include "analysis/records/record_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/records/column_lags.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "analysis/validation/record_check.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// y0: the controller on its own model under the recorded disturbances, without noise; what is not reached is
/// zero.
Eigen::MatrixXd nominal_loop(const Study& study, const AssessedLoop& loop, const QpSolverFactory& factory) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(loop.y.rows(), loop.samples());
  return run_closed_loop(study, study.plant.G,
                         {.d = loop.d, .noise = none, .y_d = none, .y_set = setpoints(study)}, factory)
      .y;
}

/// The basis case of the record. Throws InputError when the controller does not run through it.
BasisCase basis_of(const Study& study, const QpSolverFactory& factory) {
  BasisCase basis = run_basis_case(study, factory);
  if (!basis.sensitivity.is_known)
    throw InputError("controller.program", "a program that runs on the plant only (on_model is false)",
                     "one that runs on its model: a record is held against the nominal loop");
  if (basis.trajectory.status != ControlStatus::ok)
    throw InputError(
        "record",
        fmt::format("measured disturbances, setpoints or limits under which the controller of the "
                    "study does not run on its own model: {}",
                    basis.explanation),
        "values within the limits of the study: check units and operating point (data.scale, "
        "data.operating_point) and the limits at the time (data.lower, data.upper)");
  return basis;
}

/// Whether the fault may be one of the model.
bool may_be_mismatch(const RecordAssessment& assessment) {
  const FaultSource source = named_source(assessment.verdict());
  return assessment.found() == RecordVerdict::fault && source != FaultSource::ud &&
         source != FaultSource::other;
}

/// Puts what the corrected channel promises into the assessment, when the verdict names one, and what the
/// repair of each channel would bring.
void add_repair(RecordAssessment& assessment, const RecordFrame& frame) {
  if (!may_be_mismatch(assessment))
    return;
  const Study& study = assessment.study;
  const OperatingPoint& point = frame.basis.point;
  try {
    std::optional<RepairedChannel> named;
    if (const auto repair = channel_repair(study, point, assessment.loop, assessment.verdict())) {
      assessment.repair = promised_repair(study, point, assessment.loop, *repair, frame.factory);
      assessment.information =
          channel_information(study, assessment.loop, repair->channel,
                              frame.model_error > 0.0 ? frame.model_error : study.assessment.model_error);
      named = repair->repaired();
    }
    if (auto prospects = RepairProspects(study, point, frame.factory).of(assessment.loop, named))
      assessment.prospects = ranked(std::move(*prospects));
  } catch (const InputError& error) {
    assessment.no_repair = error.what();
  }
}

/// The gaps of the record, which those of the simulated ones are.
std::string shape_text(const PlantRecord& record) {
  std::string shape;
  for (Eigen::Index k = 0; k < record.samples(); ++k)
    for (Eigen::Index cv = 0; cv < record.y.rows(); ++cv)
      shape += std::isnan(record.y(cv, k)) ? '-' : 'y';
  return shape;
}

/// What decides on the answers on simulated records beside their study.
std::string judged_text(const RecordFrame& frame, const TrialFrame& made, std::string_view seen) {
  return fmt::format(
      "judged as the record {} is: {} samples before it, {} not judged, {:g} of the noise as "
      "bias, {} % of errors, {}, benchmark {} to {}{}",
      digest_of(seen), made.lead, frame.unjudged, made.bias, 100.0 * frame.model_error,
      frame.as_kept.assessment.model == AssessmentModel::benchmark ? "which methods allow for"
                                                                   : "of which methods know nothing",
      made.record.benchmark.first, made.record.benchmark.second, frame.finds_benchmark ? ", found" : "");
}

/// From what simulated records are made: with a model that may be wrong they begin midway where the record
/// does.
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
                                    .model_error = frame.model_error,
                                    .judged = judged_text(frame, made, shape_text(assessment.record))});
  return made;
}

/// Has the loops like the record run, and puts what they say into the assessment.
void add_trial(RecordAssessment& assessment, const Study& study,
               const std::shared_ptr<const RecordFrame>& frame, int trials, const TrialRunner& run_trials) {
  if (trials == 0) {
    assessment.no_trial = "no calibration run was asked for (--trials)";
    return;
  }
  try {
    const auto made = std::make_shared<TrialFrame>(trial_frame(assessment, *frame, study, trials));
    const auto alike = std::make_shared<RecordFrame>(*frame);
    alike->as_kept.monitoring.reset();
    alike->closed.monitoring.reset();
    const TrialLoops loops = run_trials({made->study, [alike, made] { return trial_assessor(alike, made); }});
    const std::size_t last = assessment.said.size();
    RecordTrial trial{loops.archive,
                      static_cast<std::int64_t>(loops.records.size()),
                      {},
                      trial_findings(made->study, last, loops.records, assessment.model)};
    std::optional<TrialGuard> guard;
    if (frame->model_error > 0.0)
      guard = {last, trial.model.threshold};
    for (std::size_t method = 0; method < last; ++method)
      trial.methods.push_back(
          trial_findings(made->study, method, loops.records, assessment.said[method], guard));
    assessment.trial = std::move(trial);
  } catch (const InputError& error) {
    assessment.no_trial = fmt::format("no loop like this one can be simulated: {}", error.what());
  }
}

/// Names the benchmark that was found.
void tell_benchmark(const RecordFrame& frame, RecordAssessment& assessment) {
  if (!frame.finds_benchmark)
    return;
  const PlantRecord& record = assessment.record;
  const auto [first, end] = record.benchmark;
  assessment.warnings.push_back(fmt::format(
      "the benchmark is the period of the record in which the model is best, {} to {}: look whether the loop "
      "ran well then (data.benchmark)",
      record.stamps[static_cast<std::size_t>(first)], record.stamps[static_cast<std::size_t>(end - 1)]));
}

void tell_unjudged(RecordAssessment& assessment) {
  if (2 * assessment.unjudged > assessment.record.samples())
    throw InputError(
        "record",
        fmt::format("{} samples, and {} for the model to settle, since it does not begin at rest",
                    assessment.record.samples(), assessment.unjudged),
        "at least twice as many, or one that begins at rest at the operating point (data.start)");
  if (assessment.unjudged > 0)
    assessment.warnings.push_back(
        fmt::format("the record does not begin at rest at the operating point: its first {} samples are not "
                    "judged, until the slowest channel has settled (data.start)",
                    assessment.unjudged));
}

/// How the record is judged: its study, the nominal loop, and what of it nobody knows.
std::shared_ptr<const RecordFrame> frame_of(const AssessOptions& options, const Study& study,
                                            const QpSolverFactory& factory, RecordAssessment& assessment) {
  const auto frame = std::make_shared<RecordFrame>();
  frame->methods = options.methods;
  frame->methods.emplace_back(kModelCheck);
  const auto study_with = [&](GapFill gaps) {
    Study of = study;
    of.data.fill = gaps;
    return recorded_study(of, assessment.record, frame->methods, options.monitoring);
  };
  frame->fill = study.data.fill;
  frame->as_kept = study_with(GapFill::none);
  frame->closed = study_with(frame->fill);
  if (options.model_error > 0.0 && study.assessment.model == AssessmentModel::automatic)
    for (Study* const of : {&frame->as_kept, &frame->closed}) {
      of->assessment.model = AssessmentModel::benchmark;
      of->assessment.model_error = options.model_error;
    }
  frame->factory = factory;
  frame->model_error = options.model_error;
  frame->finds_benchmark = study.data.benchmark.size() == 1;
  assessment.study = frame->study_of(options.methods.front());
  frame->basis = basis_of(assessment.study, frame->factory);
  frame->settling = slowest_settling(study);
  frame->unjudged =
      samples_to_settle(assessment.study, frame->basis.point, assessment.record, study.data.start);
  if (frame->unjudged == 0 && frame->model_error > 0.0 && study.data.start == RecordStart::automatic &&
      shows_a_past(assessed_loop(frame->as_kept, frame->basis.point, assessment.record, 0), frame->settling))
    frame->unjudged = frame->settling;
  assessment.unjudged = frame->unjudged;
  tell_unjudged(assessment);
  return frame;
}

/// The answer of `likelihood` on a record with a fault. That there is one it cannot say: it takes the small
/// disturbances that no plant is without for a fault.
AssessmentRecord odds_of(const RecordFrame& frame, const RecordAssessment& assessment) {
  RecordFrame alone = frame;
  alone.methods = {"likelihood"};
  alone.as_kept.monitoring.reset();
  return RecordPanel(alone).judge(assessment.record).said.front();
}

/// The record as it is judged, without the simulated ones beside it.
std::shared_ptr<const RecordFrame> judge(const AssessOptions& options, const Study& study,
                                         const QpSolverFactory& factory, RecordAssessment& assessment) {
  assessment.warnings = check_record(study, assessment.record);
  std::shared_ptr<const RecordFrame> frame = frame_of(options, study, factory, assessment);
  JudgedRecord judged = RecordPanel(*frame).judge(assessment.record);
  assessment.record.benchmark = judged.benchmark;
  assessment.loop = std::move(judged.loop);
  assessment.model = std::move(judged.said.back());
  judged.said.pop_back();
  assessment.said = std::move(judged.said);
  assessment.unexplained = unexplained_cvs(frame->as_kept, assessment.loop, frame->model_error);
  tell_benchmark(*frame, assessment);
  for (std::string& warning : column_lags(*frame, assessment.record))
    assessment.warnings.push_back(std::move(warning));
  assessment.y0 = nominal_loop(assessment.study, assessment.loop, frame->factory);
  assessment.controller = check_controller(*frame, assessment.record, assessment.loop);
  assessment.warnings.insert(assessment.warnings.begin(), assessment.record.warnings.begin(),
                             assessment.record.warnings.end());
  return frame;
}

}  // namespace

RecordAnswers RecordAssessment::answers_of(std::size_t method) const {
  return {.said = said[method],
          .trial_of_said = trial_of(method),
          .model = model,
          .trial_of_model = trial ? &trial->model : nullptr,
          .allows_errors = model_error > 0.0,
          .has_unexplained = !unexplained.empty()};
}

Eigen::Index worst_cv(const RecordAssessment& of) {
  if (!of.unexplained.empty())
    return of.unexplained.front().cv;
  if (of.found() == RecordVerdict::fault && of.verdict().predicted_cv >= 0)
    return of.verdict().predicted_cv;
  return std::max<Eigen::Index>(0, of.model.predicted_cv);
}

const RepairProspect* RecordAssessment::named_prospect() const {
  return repair ? prospect_of(prospects, repair->repair.channel) : nullptr;
}

std::optional<FaultOdds> RecordAssessment::fault_odds() const {
  if (!odds.answered())
    return std::nullopt;
  const FaultOdds of{odds.number("p_mpm"), odds.number("p_ud"), odds.number("p_both"),
                     odds.number("p_other")};
  const double fault = of.mpm + of.ud + of.mpm_ud + of.other;
  if (!(fault > 0.0))
    return std::nullopt;
  return FaultOdds{of.mpm / fault, of.ud / fault, of.mpm_ud / fault, of.other / fault};
}

TrialRunner trials_in_memory(QpSolverFactory factory) {
  return [factory = std::move(factory)](const TrialRequest& request) {
    const BasisCase basis = run_basis_case(request.study, factory);
    ExperimentRunner runner(request.study, basis, std::vector<std::string>{}, factory);
    const LoopAssessor assess = request.assessor();
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

RecordAssessment assess_record(const Study& study, PlantRecord record, const AssessOptions& options,
                               const QpSolverFactory& factory, const TrialRunner& run_trials) {
  Study checked = study;
  const auto methods = std::make_shared<MethodTable>(method_table(study.assessment));
  methods->add(model_check_method(options.model_error));
  checked.assessment.table = methods;
  RecordAssessment assessment;
  assessment.data = study.data;
  assessment.model_error = options.model_error;
  assessment.record = std::move(record);
  const std::shared_ptr<const RecordFrame> frame = judge(options, checked, factory, assessment);
  add_trial(assessment, checked, frame, options.trials, run_trials);
  if (assessment.found() == RecordVerdict::fault)
    assessment.odds = odds_of(*frame, assessment);
  add_repair(assessment, *frame);
  return assessment;
}

}  // namespace mpm
