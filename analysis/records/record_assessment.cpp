#include "analysis/records/record_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/cv_errors.hpp"
#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/column_lags.hpp"
#include "analysis/records/cost_of_record.hpp"
#include "analysis/records/held_columns.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/model_habit.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/record_repair.hpp"
#include "analysis/records/record_trials.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/records/verdict_evidence.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "analysis/validation/record_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// The method that the verdict follows, and the method that it asks for the posterior.
constexpr const char *kVerdict = "mpmbench", *kOdds = "likelihood";

/// The methods of a record: the verdict's first, and then the others that were asked for.
std::vector<std::string> with_verdict_first(std::vector<std::string> methods) {
  methods.erase(std::remove(methods.begin(), methods.end(), kVerdict), methods.end());
  methods.insert(methods.begin(), kVerdict);
  return methods;
}

/// y0: the controller on its own model under the recorded disturbances, without noise. Samples that the loop
/// does not reach are zero.
Eigen::MatrixXd nominal_loop(const Study& study, const Eigen::MatrixXd& d, const QpSolverFactory& factory) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(study.cv_count(), d.cols());
  return run_closed_loop(study, study.plant.G,
                         {.d = d, .noise = none, .y_d = none, .y_set = setpoints(study)}, factory)
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

/// Names the CVs whose noise differs much from that of the study, which the simulated records have.
void tell_noise(const RecordFrame& frame, RecordAssessment& assessment) {
  constexpr double kMuch = 3.0;
  if (!assessment.model.answered())
    return;
  const Eigen::MatrixXd noise = assessment.model.values("noise");
  for (Eigen::Index cv = 0; cv < noise.rows(); ++cv) {
    double usual = frame.as_kept.simulation.noise_standard_deviation(cv);
    if (frame.habit && frame.habit->noise[static_cast<std::size_t>(cv)])
      usual = std::sqrt(frame.habit->noise[static_cast<std::size_t>(cv)]->differences);
    const double ratio = std::sqrt(noise(cv, 0)) / usual;
    const bool is_said = std::any_of(assessment.unexplained.begin(), assessment.unexplained.end(),
                                     [cv](const UnexplainedCv& each) { return each.cv == cv; });
    if (!is_said && std::isfinite(ratio) && (ratio > kMuch || ratio * kMuch < 1.0))
      assessment.warnings.push_back(fmt::format(
          "the noise of {} has {:.2g} times the standard deviation that the study states, and the simulated "
          "records have that of the study: look at the sensor, at what the historian stores, and at "
          "simulation.noise_standard_deviation",
          frame.as_kept.plant.cvs[static_cast<std::size_t>(cv)].name, ratio));
  }
}

/// CvErrors of each CV, with X the responses to errors that the model may have.
std::vector<CvErrors> cv_errors(const RecordFrame& frame, const AssessedLoop& loop) {
  const ChannelErrorFits fits(frame.as_kept, frame.model_error);
  std::vector<CvErrors> all;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    const ChannelErrorFit fit = fits.of(loop, cv);
    all.emplace_back(loop, cv, fit.samples, fit.e, fit.X);
    all.back().find_change();
  }
  return all;
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

/// How the record is judged: its study, the nominal loop, and the samples that are not judged.
std::shared_ptr<RecordFrame> frame_of(const AssessOptions& options, const Study& study,
                                      const QpSolverFactory& factory, RecordAssessment& assessment) {
  auto frame = std::make_shared<RecordFrame>();
  frame->methods = with_verdict_first(options.methods);
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
  frame->for_each = options.for_each ? options.for_each : in_turn(factory);
  frame->model_error = options.model_error;
  frame->finds_benchmark = study.data.benchmark == std::vector<std::string>{"found"};
  assessment.study = frame->as_kept;
  frame->basis = basis_of(assessment.study, frame->factory);
  frame->settling = slowest_settling(study);
  frame->y0 = nominal_loop(assessment.study, assessment.record.d, frame->factory);
  frame->unjudged =
      samples_to_settle(assessment.study, frame->basis.point, assessment.record, study.data.start);
  if (frame->unjudged == 0 && frame->model_error > 0.0 && study.data.start == RecordStart::automatic &&
      shows_a_past(assessed_loop(frame->as_kept, frame->basis.point, assessment.record, 0), frame->settling))
    frame->unjudged = frame->settling;
  assessment.unjudged = frame->unjudged;
  tell_unjudged(assessment);
  return frame;
}

/// Costs of the record itself from this sample on.
std::vector<CvCost> costs_since(const RecordFrame& frame, const RecordAssessment& assessment,
                                Eigen::Index from) {
  if (!assessment.model.answered())
    return {};
  return cost_of_record(frame.as_kept, assessment.record.y, frame.y0, assessment.model.values("noise").col(0),
                        std::max(from, frame.unjudged));
}

/// The onset of the fault in the CV that the model explains least.
std::optional<FaultOnset> onset_of(const RecordFrame& frame, const RecordAssessment& assessment,
                                   double threshold) {
  if (!assessment.model.answered() || !(assessment.model.score > threshold) ||
      assessment.model.predicted_cv < 0)
    return std::nullopt;
  return fault_onset(ChannelErrorFits(frame.as_kept, frame.model_error, frame.habit)
                         .of(assessment.loop, assessment.model.predicted_cv),
                     threshold);
}

/// Adds the health of the channels in periods of the record. Returns the smallest error of a gain that the
/// record as a whole would show.
double add_health(const RecordFrame& frame, RecordAssessment& assessment) {
  if (!assessment.model.answered() || frame.model_error == 0.0)
    return 0.0;
  const ChannelErrorFits fits(frame.as_kept, frame.model_error, frame.habit);
  const Eigen::Index samples = assessment.loop.samples();
  assessment.periods = health_periods(samples, frame.settling);
  double visible = kInfinity;
  for (Eigen::Index cv = 0; cv < assessment.loop.y.rows(); ++cv) {
    const ChannelErrorFit fit = fits.of(assessment.loop, cv);
    for (ChannelHistory& history :
         channel_histories(fit, cv, assessment.periods, samples, assessment.health_threshold()))
      assessment.health.push_back(std::move(history));
    for (const ChannelHistory& whole : channel_histories(fit, cv, {0}, samples, assessment.model_threshold()))
      visible = std::min(visible, whole.periods.front().visible);
  }
  return visible;
}

/// The benchmark in use, or else the period in which the model is best, with the largest score of a channel
/// in it.
RecordBenchmark best_benchmark(const RecordFrame& frame, const RecordAssessment& assessment) {
  const auto [first, end] = assessment.record.benchmark;
  RecordBenchmark benchmark{.use = first == end            ? BenchmarkUse::none
                                   : frame.finds_benchmark ? BenchmarkUse::found
                                                           : BenchmarkUse::named,
                            .first = first,
                            .end = end,
                            .is_wanted = assessment.data.benchmark != std::vector<std::string>{"none"}};
  if (first < end || !benchmark.is_wanted)
    return benchmark;
  std::tie(benchmark.first, benchmark.end) = best_period(frame, assessment.loop);
  if (benchmark.first == benchmark.end || frame.model_error == 0.0)
    return benchmark;
  const auto habit = habit_of(frame.as_kept, frame.model_error,
                              window_of(assessment.loop, benchmark.first, benchmark.end - benchmark.first));
  for (Eigen::Index cv = 0; cv < assessment.loop.y.rows(); ++cv)
    if (const auto& noise = habit->noise[static_cast<std::size_t>(cv)];
        noise && !(noise->channel_score <= benchmark.channel_score)) {
      benchmark.channel_score = noise->channel_score;
      benchmark.cv = cv;
    }
  return benchmark;
}

/// All evidence for the verdict except source and repair.
VerdictEvidence evidence_of(const RecordFrame& frame, RecordAssessment& assessment) {
  VerdictEvidence evidence;
  if (assessment.model.answered())
    evidence.model_scores = assessment.model.values("cv_score").col(0);
  evidence.model_threshold = assessment.model_threshold();
  for (const UnexplainedCv& each : assessment.unexplained)
    evidence.noisy.push_back({each.cv, each.noise, kMostNoise, true});
  evidence.least_visible = add_health(frame, assessment);
  evidence.onset = onset_of(frame, assessment, evidence.model_threshold);
  const bool since = evidence.onset && evidence.onset->sample == frame.since;
  if (!since)
    evidence.onset.reset();
  evidence.costs = since ? costs_since(frame, assessment, frame.since) : assessment.costs;
  if (assessment.trial)
    for (CvCost& cost : evidence.costs)
      cost.threshold = (since ? assessment.trial->cost_since : assessment.trial->cost)(cost.cv);
  evidence.controller_is_alike = assessment.controller.is_alike();
  evidence.benchmark = best_benchmark(frame, assessment);
  evidence.late = frame.late.samples;
  evidence.late_cvs = frame.late.cvs;
  evidence.late_is_corrected = frame.late.any();
  if (assessment.trial)
    evidence.trials = assessment.trial->counts;
  return evidence;
}

/// Adds the possible sources of a fault to the evidence on a record that the model does not explain.
void add_sources(const RecordFrame& frame, RecordAssessment& assessment, VerdictEvidence& evidence) {
  const LateCvs corrected = frame.late;
  take_sources(assessment.loop, assessment.sources, assessment.trial ? assessment.trial->fit : kNaN,
               evidence);
  if (corrected.any()) {  // the correction leaves nothing of the lateness
    evidence.weights.of[RecordSource::data] = 0.0;
    evidence.late = corrected.samples;
    evidence.late_cvs = corrected.cvs;
  }
}

/// Judges the record without the simulated records beside it.
std::shared_ptr<const RecordFrame> judge(const AssessOptions& options, const Study& study,
                                         const QpSolverFactory& factory, RecordAssessment& assessment) {
  assessment.warnings = check_record(study, assessment.record);
  const std::shared_ptr<RecordFrame> frame = frame_of(options, study, factory, assessment);
  JudgedRecord checked = judged_by(*frame, {kModelCheck}, assessment.record);
  if (const AssessmentRecord& check = checked.said.front();
      frame->model_error > 0.0 && check.answered() && check.score > kFarTooLarge) {
    frame->late = common_lateness(frame->as_kept, checked.loop, cv_errors(*frame, checked.loop));
    if (frame->late.any())
      checked = judged_by(*frame, {kModelCheck}, assessment.record);
  }
  std::vector<std::string> methods = with_verdict_first(options.methods);
  methods.emplace_back(kOdds);  // `mpmbench` asks for them anyway, so they cost nothing
  JudgedRecord judged = judged_by(*frame, methods, assessment.record);
  for (const std::string& asked : options.methods)
    assessment.said.push_back(judged.said[static_cast<std::size_t>(
        std::find(methods.begin(), methods.end(), asked) - methods.begin())]);
  assessment.sources = std::move(judged.said.front());
  assessment.odds = std::move(judged.said.back());
  assessment.record.benchmark = judged.benchmark;
  assessment.loop = std::move(judged.loop);
  assessment.model = std::move(checked.said.front());
  frame->habit = judged.habit;
  assessment.unexplained =
      unexplained_cvs(frame->as_kept, assessment.loop, frame->model_error, frame->habit.get());
  tell_noise(*frame, assessment);
  tell_benchmark(*frame, assessment);
  for (std::string& warning : column_lags(*frame, assessment.record))
    assessment.warnings.push_back(std::move(warning));
  assessment.y0 = frame->y0;
  if (const std::optional<FaultOnset> onset = onset_of(*frame, assessment, kFarTooLarge))
    frame->since = onset->sample;
  assessment.costs = costs_since(*frame, assessment, frame->unjudged);
  assessment.controller = check_controller(*frame, assessment.record, assessment.loop);
  assessment.warnings.insert(assessment.warnings.begin(), assessment.record.warnings.begin(),
                             assessment.record.warnings.end());
  return frame;
}

}  // namespace

RecordAssessment assess_record(const Study& study, PlantRecord record, const AssessOptions& options,
                               const QpSolverFactory& factory, const TrialRunner& run_trials) {
  Study checked = with_held_columns(study, record);
  const auto methods = std::make_shared<MethodTable>(method_table(study.assessment));
  methods->add(model_check_method(options.model_error));
  checked.assessment.table = methods;
  RecordAssessment assessment;
  assessment.data = study.data;
  assessment.model_error = options.model_error;
  assessment.record = std::move(record);
  const std::shared_ptr<const RecordFrame> frame = judge(options, checked, factory, assessment);
  const CountsOfSource counts_of = add_trial(assessment, checked, frame, options.trials, run_trials);
  VerdictEvidence evidence = evidence_of(*frame, assessment);
  assessment.verdict = record_verdict(evidence);
  if (assessment.verdict.model.answer == ModelAnswer::fails) {
    add_sources(*frame, assessment, evidence);
    assessment.verdict = record_verdict(evidence);
    add_repair(assessment, *frame, evidence);
    if (assessment.verdict.model.source == RecordSource::both && is_mismatch_alone(assessment, *frame))
      std::swap(evidence.weights.of[RecordSource::both], evidence.weights.of[RecordSource::mismatch]);
    if (assessment.trial) {
      const RecordVerdict::Model model = record_verdict(evidence).model;
      // No simulated record drifts, so nobody knows how often that answer is right.
      evidence.trials = assessment.trial->counts =
          counts_of(model.drifts ? RecordSource::sensor : model.source);
    }
    assessment.verdict = record_verdict(evidence);
  }
  return assessment;
}

}  // namespace mpm
