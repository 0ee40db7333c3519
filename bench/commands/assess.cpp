#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/experiment/repair.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/repair_prospects.hpp"
#include "analysis/records/channel_information.hpp"
#include "analysis/records/column_lags.hpp"
#include "analysis/records/controller_check.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/record_panel.hpp"
#include "analysis/records/trial_record.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/validation/record_check.hpp"
#include "bench/campaign/kept_campaign.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/records/plant_record_file.hpp"
#include "scenarios/files/recorded_study.hpp"
#include "scenarios/files/study_library.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

constexpr int kFewestWindowSamples = 24;

struct AssessArguments {
  std::string study, data;
  std::vector<std::string> methods{"mpmbench"};
  std::string page;         ///< none when empty
  std::string calibration;  ///< archive; beside the data when empty
  int trials = 200;
  double model_error = 5.0;  ///< percent
  std::optional<int> window, stride;
  RunOptions run;
  bool json = false;
  bool quiet = false;
};

/// The window of the command line, or that of the study where it fits into the record.
std::optional<MonitoringOptions> monitoring_of(const AssessArguments& options, const Study& study,
                                               PlantRecord& record) {
  std::optional<MonitoringOptions> monitoring = study.monitoring;
  const auto samples = static_cast<int>(record.samples());
  if (options.window) {
    if (*options.window < kFewestWindowSamples || *options.window > samples)
      throw InputError("--window", fmt::format("{}", *options.window),
                       fmt::format("{} to {}, the samples of the record", kFewestWindowSamples, samples));
    monitoring = {.window = *options.window, .stride = std::max(1, *options.window / 4)};
  }
  if (options.stride && !monitoring)
    throw InputError("--stride", fmt::format("{} and no window", *options.stride),
                     "--window as well, or a study with [monitoring]");
  if (options.stride)
    monitoring->stride = std::min(*options.stride, samples);
  if (monitoring && monitoring->window > samples) {
    record.warnings.push_back(
        fmt::format("the record is shorter than the window of {} samples of the study", monitoring->window));
    return std::nullopt;
  }
  return monitoring;
}

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
        "those that the study's limits bear: look at units, operating point (data.scale, "
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

std::filesystem::path calibration_archive(const AssessArguments& options) {
  return options.calibration.empty() ? options.data + ".calibration.h5" : options.calibration;
}

/// Refuses to replace what is no calibration run.
void require_own_archive(const std::filesystem::path& archive) {
  std::error_code no_status;
  if (std::filesystem::exists(archive, no_status) && !is_trial_study(stream_input(archive.string()).study))
    throw InputError(archive.string(), "an archive that is no calibration run",
                     "another name for the calibration run (--calibration)");
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

/// Runs the loops like the record, or takes those that are kept, and puts what they say into the assessment.
void add_trial(RecordAssessment& assessment, const Study& study,
               const std::shared_ptr<const RecordFrame>& frame, const AssessArguments& options,
               Progress& progress, const std::string& command) {
  if (options.trials == 0) {
    assessment.no_trial = "no calibration run was asked for (--trials)";
    return;
  }
  const std::filesystem::path archive = calibration_archive(options);
  require_own_archive(archive);
  const CampaignHooks hooks = hooks_of(progress);
  try {
    const auto made = std::make_shared<TrialFrame>(trial_frame(assessment, *frame, study, options.trials));
    const auto alike = std::make_shared<RecordFrame>(*frame);
    alike->as_kept.monitoring.reset();
    alike->closed.monitoring.reset();
    RunOptions run = options.run;
    run.methods = frame->methods;
    run.store = StorePolicy::none;
    run.audit_share = 0.0;
    run.allow_unhealthy_basis = true;
    run.assessor = [alike, made] { return trial_assessor(alike, made); };
    std::optional<Campaign> campaign = kept_campaign(archive, made->study, run, hooks.on_warning);
    if (!campaign) {
      require_output_archive(archive, "calibration run");
      campaign = run_and_keep(archive, made->study, run, hooks, command);
    }
    const RecordRange records = records_of(*campaign);
    const std::size_t last = assessment.said.size();
    RecordTrial trial{archive.filename().string(),
                      static_cast<std::int64_t>(records.size()),
                      {},
                      trial_findings(campaign->study, last, records, assessment.model)};
    std::optional<TrialGuard> guard;
    if (frame->model_error > 0.0)
      guard = {last, trial.model.threshold};
    for (std::size_t method = 0; method < last; ++method)
      trial.methods.push_back(
          trial_findings(campaign->study, method, records, assessment.said[method], guard));
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
std::shared_ptr<const RecordFrame> frame_of(const AssessArguments& options, const Study& study,
                                            RecordAssessment& assessment) {
  const auto monitoring = monitoring_of(options, study, assessment.record);
  const auto frame = std::make_shared<RecordFrame>();
  frame->methods = options.methods;
  frame->methods.emplace_back(kModelCheck);
  const auto study_with = [&](GapFill gaps) {
    Study of = study;
    of.data.fill = gaps;
    return recorded_study(of, assessment.record, frame->methods, monitoring);
  };
  frame->fill = study.data.fill;
  frame->as_kept = study_with(GapFill::none);
  frame->closed = study_with(frame->fill);
  if (options.model_error > 0.0 && study.assessment.model == AssessmentModel::automatic)
    for (Study* const of : {&frame->as_kept, &frame->closed}) {
      of->assessment.model = AssessmentModel::benchmark;
      of->assessment.model_error = 0.01 * options.model_error;
    }
  frame->factory = qp_solver_factory(options.run.solver);
  frame->model_error = 0.01 * options.model_error;
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
RecordAssessment assessed(const AssessArguments& options, const Study& study,
                          std::shared_ptr<const RecordFrame>& frame) {
  RecordAssessment assessment;
  assessment.file = std::filesystem::path(options.data).filename().string();
  assessment.version = mpmbench_version();
  assessment.data = study.data;
  assessment.model_error = 0.01 * options.model_error;
  assessment.record = load_plant_record(study, options.data);
  assessment.warnings = check_record(study, assessment.record);
  frame = frame_of(options, study, assessment);
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
  return assessment;
}

ExitCode assess(AssessArguments options, const std::string& command) {
  const Study study = find_study(options.study);
  options.methods = known_methods(options.methods, "--methods");
  const std::filesystem::path calibration = calibration_archive(options);
  require_no_input("--calibration", calibration, {options.study, options.data});
  if (!options.page.empty()) {
    require_no_input("--output", options.page, {options.study, options.data, calibration.string()});
    require_output_folder(options.page, "page");
  }
  Progress progress(options.quiet);
  add_assessment_method(model_check_method(0.01 * options.model_error));
  std::shared_ptr<const RecordFrame> frame;
  RecordAssessment assessment = assessed(options, study, frame);
  try {
    add_trial(assessment, study, frame, options, progress, command);
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) + "; the same command goes on with the calibration run");
  }
  if (assessment.found() == RecordVerdict::fault)
    assessment.odds = odds_of(*frame, assessment);
  add_repair(assessment, *frame);
  if (!options.page.empty())
    write_text(options.page, document_html(assessment_document(assessment)));
  print_result(options.json ? assessment_json(assessment) : document_text(assessment_document(assessment)));
  return ExitCode::done;
}

}  // namespace

void add_assess(CommandSet& commands) {
  const auto options = std::make_shared<AssessArguments>();
  CLI::App& app = commands.add(
      "assess", "Assess records of a plant: which CVs lose how much, why, and how certain that is",
      [options, &commands] { return assess(*options, commands.command_line()); });
  add_path(app, "STUDY", options->study, "Study file, or name of a shipped study")->required();
  add_path(app, "DATA", options->data, "Records of the loop (CSV or netCDF-4)")->required();
  add_methods_option(app, options->methods, "Methods, separated by commas; the first one gives the verdict");
  add_path(app, "-o,--output", options->page, "Page to write (HTML)");
  app.add_option("--window", options->window, "Length of a window that moves over the record, in samples")
      ->check(whole_number(1, 1000000000));
  app.add_option("--stride", options->stride, "Samples from one window to the next")
      ->check(whole_number(1, 1000000000));
  app.add_option("--trials", options->trials,
                 "Number of simulated loops like the record that show how far to trust the verdict; 0: none")
      ->check(whole_number(0, 1000000))
      ->capture_default_str();
  app.add_option(
         "--model-error", options->model_error,
         "Errors that a healthy model may have, in gain, time constants and dead time of every channel: "
         "their standard deviation in percent; 0: an exact model")
      ->check(number_between(0.0, 50.0))
      ->capture_default_str();
  add_path(app, "--calibration", options->calibration,
           "Archive of these loops, made if it does not exist (default: DATA.calibration.h5)");
  add_jobs(app, options->run.jobs, "How many loops run at once");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
