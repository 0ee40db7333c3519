#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/validation/benchmark_period.hpp"
#include "analysis/validation/record_check.hpp"
#include "bench/campaign/kept_campaign.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/records/plant_record_file.hpp"
#include "scenarios/files/recorded_study.hpp"
#include "scenarios/files/study_library.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/study/window_scan.hpp"

namespace mpm {
namespace {

constexpr int kFewestWindowSamples = 24;

struct AssessArguments {
  std::string study, data;
  std::vector<std::string> methods{"mpmbench"};
  std::string page;         ///< none when empty
  std::string calibration;  ///< archive; beside the data when empty
  int trials = 200;
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

/// Puts what the identified channel promises into the assessment, when the verdict names one.
void add_repair_to(RecordAssessment& assessment, const BasisCase& basis, const QpSolverFactory& factory) {
  try {
    assessment.repair =
        promised_repair(assessment.study, basis.point, assessment.loop, assessment.verdict(), factory);
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

/// Runs the loops like the record, or takes those that are kept, and puts what they say into the assessment.
void add_trial(RecordAssessment& assessment, const AssessArguments& options, Progress& progress,
               const std::string& command) {
  if (options.trials == 0) {
    assessment.no_trial = "no calibration run was asked for (--trials)";
    return;
  }
  const std::filesystem::path archive = calibration_archive(options);
  require_own_archive(archive);
  RunOptions run = options.run;
  run.methods = options.methods;
  run.store = StorePolicy::none;
  run.audit_share = 0.0;
  run.allow_unhealthy_basis = true;
  const int faulty = options.trials / 2;
  const CampaignHooks hooks = hooks_of(progress);
  try {
    const Study study = trial_study(assessment.study, options.trials - faulty, faulty);
    std::optional<Campaign> campaign = kept_campaign(archive, study, run, hooks.on_warning);
    if (!campaign) {
      require_output_archive(archive, "calibration run");
      campaign = run_and_keep(archive, study, run, hooks, command);
    }
    RecordTrial trial{
        archive.filename().string(), static_cast<std::int64_t>(records_of(*campaign).size()), {}};
    for (std::size_t method = 0; method < assessment.said.size(); ++method)
      trial.methods.push_back(
          trial_findings(campaign->study, method, records_of(*campaign), assessment.said[method]));
    assessment.trial = std::move(trial);
  } catch (const InputError& error) {
    assessment.no_trial = fmt::format("no loop like this one can be simulated: {}", error.what());
  }
}

/// Does the method not apply to a record with gaps?
bool needs_every_sample(const std::string& method) {
  return assessment_method(method).requirements.complete_record;
}

/// The loop with the gaps of its CVs closed, from the first sample that is judged on.
AssessedLoop without_gaps(AssessedLoop loop, Eigen::Index unjudged, GapFill fill) {
  auto judged = loop.y.rightCols(loop.samples() - unjudged);
  for (Eigen::Index cv = 0; cv < judged.rows(); ++cv)
    judged.row(cv) = filled(judged.row(cv), fill);
  return loop;
}

/// The period of the record that data.benchmark = "found" asks for: a quarter of it, or what windows need.
void find_benchmark(const Study& study, RecordAssessment& assessment) {
  if (study.data.benchmark.size() != 1)
    return;
  PlantRecord& record = assessment.record;
  const Eigen::Index fewest = window_scan(assessment.study).longest + kFewestCorrelatedPairs;
  record.benchmark = quietest_period(assessment.loop, std::max(record.samples() / 4, fewest));
  const auto [first, end] = record.benchmark;
  if (first == end)
    throw InputError("data.benchmark", "\"found\", and no period with enough samples of a CV",
                     "two time stamps, or a longer record");
  assessment.warnings.push_back(fmt::format(
      "the benchmark is the period of the record in which the model is best, {} to {}: look whether the loop "
      "ran well then (data.benchmark)",
      record.stamps[static_cast<std::size_t>(first)], record.stamps[static_cast<std::size_t>(end - 1)]));
}

RecordAssessment assessed(const AssessArguments& options, const Study& study) {
  RecordAssessment assessment;
  assessment.file = std::filesystem::path(options.data).filename().string();
  assessment.version = mpmbench_version();
  assessment.record = load_plant_record(study, options.data);
  assessment.warnings = check_record(study, assessment.record);
  const auto monitoring = monitoring_of(options, study, assessment.record);
  const GapFill fill = study.data.fill;
  const auto study_with = [&](GapFill gaps) {
    Study of = study;
    of.data.fill = gaps;
    return recorded_study(of, assessment.record, options.methods, monitoring);
  };
  // The calibration run has the gaps as the method of the verdict has them.
  const bool closed_verdict = needs_every_sample(options.methods.front());
  assessment.study = study_with(closed_verdict ? fill : GapFill::none);
  const QpSolverFactory factory = qp_solver_factory(options.run.solver);
  const BasisCase basis = basis_of(assessment.study, factory);
  assessment.unjudged = samples_to_settle(assessment.study, basis.point, assessment.record, study.data.start);
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
  assessment.loop = assessed_loop(assessment.study, basis.point, assessment.record, assessment.unjudged);
  find_benchmark(study, assessment);
  const auto [first, end] = assessment.record.benchmark;
  const Study as_kept = study_with(GapFill::none), closed = study_with(fill);
  for (const std::string& name : options.methods) {
    const bool closes = needs_every_sample(name);
    const AssessedLoop loop =
        closes ? without_gaps(assessment.loop, assessment.unjudged, fill) : assessment.loop;
    const Study& of_method = closes ? closed : as_kept;
    AssessmentContext context = assessment_context(of_method, basis, factory);
    if (end > first)
      context.benchmark = window_of(loop, first, end - first);
    MethodPanel panel(of_method, std::move(context), {name});
    assessment.said.push_back(panel.assess(loop).front());
  }
  assessment.y0 = nominal_loop(assessment.study, assessment.loop, factory);
  add_repair_to(assessment, basis, factory);
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
  RecordAssessment assessment = assessed(options, study);
  try {
    add_trial(assessment, options, progress, command);
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) + "; the same command goes on with the calibration run");
  }
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
  add_path(app, "--calibration", options->calibration,
           "Archive of these loops, made if it does not exist (default: DATA.calibration.h5)");
  add_jobs(app, options->run.jobs, "How many loops run at once");
  add_solver(app, options->run.solver);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
