#include "analysis/records/record_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/column_lags.hpp"
#include "analysis/records/cost_of_record.hpp"
#include "analysis/records/fitted_repair.hpp"
#include "analysis/records/held_columns.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/model_habit.hpp"
#include "analysis/records/record_alternatives.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/records/verdict_evidence.hpp"
#include "analysis/statistics/standstill.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "analysis/validation/record_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/sha256.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// Says how probable the usual sources are.
constexpr const char* kOdds = "likelihood";

/// y0: the controller on its own model under the recorded disturbances, without noise; what is not reached is
/// zero.
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

/// The record since something is wrong: what was before counts in no repair.
AssessedLoop since_onset(const RecordAssessment& assessment) {
  AssessedLoop loop = assessment.loop;
  if (assessment.verdict.model.since)
    loop.y.leftCols(assessment.verdict.model.since->sample).setConstant(kNaN);
  return loop;
}

/// The samples at which some CV is judged: no others count in what a repair would bring.
std::vector<bool> counted_samples(const AssessedLoop& loop) {
  std::vector<bool> counted(static_cast<std::size_t>(loop.samples()));
  for (std::size_t k = 0; k < counted.size(); ++k)
    counted[k] = !loop.y.col(static_cast<Eigen::Index>(k)).array().isNaN().all();
  return counted;
}

/// The channel that the verdict would repair: that of the mismatch that the first method names, or else
/// `likelihood`, or else the first one that they name at the dearest CV, or else the likeliest one. It is
/// identified again where the errors that the model has beside it are known by their size.
std::optional<ChannelRepair> repair_of(const RecordAssessment& assessment, const AssessedLoop& loop,
                                       const RecordFrame& frame,
                                       const std::optional<NamedMismatch>& likeliest) {
  const Study& study = assessment.study;
  const OperatingPoint& point = frame.basis.point;
  const Eigen::Index dearest = assessment.verdict.named_cv();
  const AssessmentRecord* answer = nullptr;
  for (const AssessmentRecord* const said : {&assessment.said.front(), &assessment.odds})
    if (channel_to_repair(*said) && (answer == nullptr || !answer->named_mismatch()))
      answer = said;
  const auto identified = [&](const Channel& channel, const std::optional<MismatchParameter>& only) {
    return frame.model_error > 0.0 ? fitted_repair(study, point, assessment.loop, channel, only,
                                                   frame.model_error, assessment.verdict.model.since)
                                   : identified_channel(study, point, loop, channel, only);
  };
  if (answer == nullptr)
    return likeliest ? std::optional(identified(likeliest->channel, likeliest->parameter)) : std::nullopt;
  const std::optional<NamedMismatch> named = answer->named_mismatch();
  for (Eigen::Index mv = 0; named && named->channel.cv != dearest && mv < study.mv_count(); ++mv)
    if (answer->names({dearest, mv}))
      return identified({dearest, mv}, {});
  if (frame.model_error > 0.0 && (!named || is_fitted_alone(named->parameter)))
    return identified(*channel_to_repair(*answer), named ? std::optional(named->parameter) : std::nullopt);
  return channel_repair(study, point, loop, *answer);
}

/// What the repair says of the channel, as a mismatch: of one that was identified again as a whole its gain,
/// where that is not the model's.
NamedMismatch mismatch_of(const ChannelRepair& repair) {
  if (repair.named)
    return *repair.named;
  const bool has_gain = repair.gain_factor.upper < 1.0 || repair.gain_factor.lower > 1.0;
  const MismatchParameter parameter =
      repair.parameter.value_or(has_gain ? MismatchParameter::gain : MismatchParameter::channel);
  const FittedNumber* const size = parameter == MismatchParameter::gain            ? &repair.gain_factor
                                   : parameter == MismatchParameter::time_constant ? &repair.time_factor
                                   : parameter == MismatchParameter::dead_time     ? &repair.dead_time_shift
                                                                                   : nullptr;
  return size == nullptr
             ? NamedMismatch{repair.channel, parameter}
             : NamedMismatch{repair.channel, parameter, size->value, size->lower, size->upper, size->bound};
}

/// The record as these methods see it.
JudgedRecord judged_by(const RecordFrame& frame, std::vector<std::string> methods,
                       const PlantRecord& record) {
  RecordFrame asked = frame;
  asked.methods = std::move(methods);
  return RecordPanel(asked).judge(record);
}

/// Is nothing left but the usual background, once the channel of the repair is as it is? Of a fault that
/// begins within the record its later half counts, in which it has grown.
bool is_mismatch_alone(const RecordAssessment& assessment, const RecordFrame& frame) {
  if (!assessment.repair || frame.model_error == 0.0 ||
      assessment.record.benchmark.first < assessment.record.benchmark.second ||
      !assessment.record.y_sim.array().isNaN().all())
    return false;
  RecordFrame repaired = frame;
  const ChannelRepair& repair = assessment.repair->repair;
  for (Study* const of : {&repaired.as_kept, &repaired.closed})
    of->plant.G(repair.channel.cv, repair.channel.mv) = repair.model;
  PlantRecord record = assessment.record;
  if (const std::optional<FaultOnset>& since = assessment.verdict.model.since)
    record.y.leftCols((since->sample + record.samples()) / 2).setConstant(kNaN);
  const AssessmentRecord said = judged_by(repaired, {kModelCheck}, record).said.front();
  return said.answered() && said.score <= assessment.model_threshold();
}

/// Puts what the corrected channel promises into the assessment, when the verdict is about the model, and
/// what the repair of each channel would bring.
void add_repair(RecordAssessment& assessment, const RecordFrame& frame, VerdictEvidence& evidence) {
  if (!assessment.verdict.model.has_mismatch())
    return;
  const Study& study = assessment.study;
  const OperatingPoint& point = frame.basis.point;
  const AssessedLoop loop = since_onset(assessment);
  const std::vector<bool> counted = counted_samples(loop);
  try {
    std::optional<RepairedChannel> named;
    if (const auto repair = repair_of(assessment, loop, frame, evidence.likeliest)) {
      evidence.mismatch = mismatch_of(*repair);
      assessment.repair = promised_repair(study, point, loop, *repair, frame.factory, counted);
      assessment.information =
          channel_information(study, loop, repair->channel,
                              frame.model_error > 0.0 ? frame.model_error : study.assessment.model_error);
      evidence.tells_apart = assessment.information->rank == assessment.information->parameters;
      named = repair->repaired();
    }
    if (auto prospects = RepairProspects(study, point, frame.factory).of(loop, named, counted))
      assessment.prospects = ranked(std::move(*prospects));
  } catch (const InputError& error) {
    assessment.no_repair = error.what();
  }
  const RepairProspect* const prospect = assessment.named_prospect();
  if (prospect == nullptr || prospect->gains.empty())
    return;
  evidence.promise = {prospect->gain(), prospect->gains.front(), prospect->gains.back(),
                      prospect->variance_ratio};
  evidence.worth = study.assessment.of<AdequacyOptions>().worth;
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
      "bias, {} % of errors, {}, benchmark {} to {}{}, costs since {}",
      digest_of(seen), made.lead, frame.unjudged, made.bias, 100.0 * frame.model_error,
      frame.as_kept.assessment.model == AssessmentModel::benchmark ? "which methods allow for"
                                                                   : "of which methods know nothing",
      made.record.benchmark.first, made.record.benchmark.second, frame.finds_benchmark ? ", found" : "",
      frame.since);
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
                                    .model_error = kWorseWorlds * frame.model_error,
                                    .judged = judged_text(frame, made, shape_text(assessment.record))});
  return made;
}

/// Does any method name this one?
bool is_named_by_methods(RecordSource source) {
  return source == RecordSource::mismatch || source == RecordSource::disturbance ||
         source == RecordSource::both || source == RecordSource::valve;
}

/// How often simulated records of which the same source was said have it.
using CountsOfSource = std::function<TrialCounts(RecordSource)>;

/// The methods that every simulated record is asked for. The first one, where it tells sources, costs more
/// than all else, and only its sources count, where the model does not explain the record.
std::vector<std::string> asked_of_all(const RecordFrame& frame) {
  std::vector<std::string> names = frame.methods;
  if (method_table(frame.as_kept.assessment).method(names.front()).tells_sources)
    names.erase(names.begin());
  return names;
}

/// Asks the first method of the frame of the loops `unexplained` only, and the others of all; null: all of
/// all.
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

/// Has the loops like the record run, and puts what they say into the assessment. What is returned asks the
/// first method for its sources; empty without such loops.
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
    const std::size_t unasked = assessment.said.size() - last;  // 1, or 0
    for (std::size_t method = 0; method < assessment.said.size(); ++method)
      trial.methods.push_back(method < unasked
                                  ? std::nullopt
                                  : std::optional(trial_findings(made->study, method - unasked, loops.records,
                                                                 assessment.said[method])));
    const Eigen::Index ny = assessment.study.cv_count();
    trial.cost = number_thresholds(loops.records, last, kCostNumber, ny);
    trial.cost_since = number_thresholds(loops.records, last, kCostSinceNumber, ny);
    trial.fit = fit_threshold(loops.records, last);
    trial.health = number_thresholds(loops.records, last, "health", 1)(0);
    trial.counts = trial_counts(loops.records, last, trial.model);
    assessment.trial = std::move(trial);
    return [loops, run, last, unasked, methods = frame->methods,
            model = assessment.trial->model](RecordSource named) {
      if (!is_named_by_methods(named))
        return trial_counts(loops.records, last, model);
      const auto asked = std::make_shared<std::set<std::int64_t>>();
      for (const std::int64_t index : unexplained_records(loops.records, last, model))
        asked->insert(index);
      const TrialLoops of_sources = unasked == 0 ? loops : run(methods, asked);
      return trial_counts(of_sources.records, last + unasked, model, named);
    };
  } catch (const InputError& error) {
    assessment.no_trial = fmt::format("no loop like this one can be simulated: {}", error.what());
    return {};
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

/// Names the CVs whose noise is out of proportion: simulated records have that of the study.
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
std::shared_ptr<RecordFrame> frame_of(const AssessOptions& options, const Study& study,
                                      const QpSolverFactory& factory, RecordAssessment& assessment) {
  auto frame = std::make_shared<RecordFrame>();
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
  frame->finds_benchmark = study.data.benchmark == std::vector<std::string>{"found"};
  assessment.study = frame->study_of(options.methods.front());
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

/// The answer of `likelihood` on a record with a fault. That there is one it cannot say: it takes the small
/// disturbances that no plant is without for a fault.
AssessmentRecord odds_of(const RecordFrame& frame, const RecordAssessment& assessment) {
  RecordFrame alone = frame;
  alone.as_kept.monitoring.reset();
  return judged_by(alone, {kOdds}, assessment.record).said.front();
}

/// Costs of the record itself from this sample on.
std::vector<CvCost> costs_since(const RecordFrame& frame, const RecordAssessment& assessment,
                                Eigen::Index from) {
  if (!assessment.model.answered())
    return {};
  return cost_of_record(frame.as_kept, assessment.record.y, frame.y0, assessment.model.values("noise").col(0),
                        std::max(from, frame.unjudged));
}

/// Since when the CV is wrong that the model explains least.
std::optional<FaultOnset> onset_of(const RecordFrame& frame, const RecordAssessment& assessment,
                                   double threshold) {
  if (!assessment.model.answered() || !(assessment.model.score > threshold) ||
      assessment.model.predicted_cv < 0)
    return std::nullopt;
  return fault_onset(ChannelErrorFits(frame.as_kept, frame.model_error, frame.habit)
                         .of(assessment.loop, assessment.model.predicted_cv),
                     threshold);
}

/// The channels in periods of the record, and the error of a gain that the record as a whole would show.
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

/// The benchmark in use, or else the period in which the model is best, with what its channels look like
/// there.
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

/// All that the verdict rests on but for source and repair.
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

/// Of the CVs that the model does not explain, one that shows a value for so long that chance does not make
/// it: no other fault leaves such a stretch.
void add_stuck_sensor(const AssessedLoop& loop, VerdictEvidence& evidence) {
  constexpr double kNoChance = 1e-6;
  for (Eigen::Index cv = 0; cv < evidence.model_scores.size(); ++cv) {
    const Standstill stretch = longest_standstill(loop.y.row(cv));
    if (!(evidence.model_scores(cv) > evidence.model_threshold) || !is_long(stretch, loop.samples()) ||
        !(stretch.chance < kNoChance) || (evidence.stuck && stretch.length() <= evidence.stuck->length()))
      continue;
    evidence.stuck = stretch;
    evidence.sensor_cv = cv;
    evidence.drift = 0.0;
    evidence.weights = {};
    evidence.weights[RecordSource::sensor] = 1.0;
  }
}

/// What may be the matter with a record that the model does not explain.
void add_sources(const RecordFrame& frame, RecordAssessment& assessment, VerdictEvidence& evidence) {
  if (!assessment.odds.form)
    assessment.odds = odds_of(frame, assessment);
  AssessmentRecord first = assessment.said.front();
  first.flagged = assessment.is_flagged(0);  // by simulated records, and not by a band of variances
  evidence.weights = source_weights(assessment.odds, first);
  if (frame.model_error > 0.0) {
    RecordAlternatives alternatives =
        record_alternatives(frame.as_kept, assessment.loop, frame.model_error, evidence.onset);
    if (frame.late.any())
      alternatives.data = -kInfinity;  // nothing is left of it
    const SourceWeights weights =
        with_alternatives(evidence.weights, alternatives, assessment.trial ? assessment.trial->fit : kNaN);
    evidence.weights = weights.of;
    evidence.drift = weights.drift;
    evidence.likeliest = alternatives.named;
    evidence.valve_mv = alternatives.valve_mv;
    evidence.sensor_cv = alternatives.sensor_cv;
    if (!frame.late.any()) {
      if (alternatives.data_cv >= 0)
        evidence.late_cvs = {alternatives.data_cv};
      evidence.late = alternatives.late;
    }
    add_stuck_sensor(assessment.loop, evidence);
    return;
  }
  for (const AssessmentRecord* const said : {&assessment.odds, &assessment.said.front()})
    if (const double valve = said->number("valve_mv"); !std::isnan(valve))
      evidence.valve_mv = static_cast<Eigen::Index>(valve);
}

/// The record as it is judged, without the simulated ones beside it.
std::shared_ptr<const RecordFrame> judge(const AssessOptions& options, const Study& study,
                                         const QpSolverFactory& factory, RecordAssessment& assessment) {
  assessment.warnings = check_record(study, assessment.record);
  const std::shared_ptr<RecordFrame> frame = frame_of(options, study, factory, assessment);
  JudgedRecord checked = judged_by(*frame, {kModelCheck}, assessment.record);
  if (const AssessmentRecord& check = checked.said.front();
      frame->model_error > 0.0 && check.answered() && check.score > kFarTooLarge) {
    frame->late = common_lateness(frame->as_kept, checked.loop, frame->model_error);
    if (frame->late.any())
      checked = judged_by(*frame, {kModelCheck}, assessment.record);
  }
  std::vector<std::string> methods = options.methods;
  const auto has = [&methods](const char* name) {
    return std::find(methods.begin(), methods.end(), name) != methods.end();
  };
  const bool adds_odds = has("mpmbench") && !has(kOdds);  // it has asked for them, so that they cost nothing
  if (adds_odds)
    methods.emplace_back(kOdds);
  JudgedRecord judged = judged_by(*frame, methods, assessment.record);
  if (adds_odds) {
    assessment.odds = std::move(judged.said.back());
    judged.said.pop_back();
  }
  assessment.record.benchmark = judged.benchmark;
  assessment.loop = std::move(judged.loop);
  assessment.model = std::move(checked.said.front());
  assessment.said = std::move(judged.said);
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

bool RecordAssessment::is_flagged(std::size_t method) const {
  const AssessmentRecord& of = said[method];
  if (trial && !trial->methods[method])
    return of.answered() && of.flagged && model.score > model_threshold();
  const TrialFindings* const found = trial_of(method);
  return of.answered() &&
         (found == nullptr || std::isnan(found->threshold) ? of.flagged : of.score > found->threshold);
}

Eigen::Index worst_cv(const RecordAssessment& of) {
  const Eigen::Index named = of.verdict.named_cv();
  return named >= 0 ? named : std::max<Eigen::Index>(0, of.model.predicted_cv);
}

const RepairProspect* RecordAssessment::named_prospect() const {
  return repair ? prospect_of(prospects, repair->repair.channel) : nullptr;
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
      std::swap(evidence.weights[RecordSource::both], evidence.weights[RecordSource::mismatch]);
    if (assessment.trial) {
      const RecordVerdict::Model model = record_verdict(evidence).model;
      // No simulated record drifts: how often that is right is not known.
      evidence.trials = assessment.trial->counts =
          counts_of(model.drifts ? RecordSource::sensor : model.source);
    }
    assessment.verdict = record_verdict(evidence);
  }
  return assessment;
}

}  // namespace mpm
