#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/records/record_assessment.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/campaign/kept_campaign.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/failure_tally.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/execution/thread_solvers.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/version.hpp"
#include "results/assess/assessment_document.hpp"
#include "results/assess/assessment_json.hpp"
#include "results/assess/assessment_sentences.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_text.hpp"
#include "results/records/plant_record_file.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

constexpr int kFewestWindowSamples = 24;

struct AssessArguments {
  std::string study, data;
  std::vector<std::string> methods = AssessOptions{}.methods;
  std::string page;         ///< empty: no page
  std::string calibration;  ///< archive; empty: beside the data
  int trials = AssessOptions{}.trials;
  double model_error = 100.0 * AssessOptions{}.model_error;  ///< percent
  std::optional<int> window, stride;
  RunOptions run;
  bool json = false;
  bool brief = false;
  bool quiet = false;
};

/// The window of the command line, or that of the study if it fits into the record.
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

std::filesystem::path calibration_archive(const AssessArguments& options) {
  return options.calibration.empty() ? options.data + ".calibration.h5" : options.calibration;
}

/// Refuses to replace an archive that is no calibration run.
void require_own_archive(const std::filesystem::path& archive) {
  std::error_code no_status;
  if (std::filesystem::exists(archive, no_status) && !is_trial_study(stream_input(archive.string()).study))
    throw InputError(archive.string(), "an archive that is no calibration run",
                     "another name for the calibration run (--calibration)");
}

/// Answers on the loops of a kept campaign, by the index of the experiment.
using EarlierAnswers = std::map<std::int64_t, std::vector<AssessmentRecord>>;

/// The answers in `campaign` of the methods of the study that are not `missing`.
std::shared_ptr<const EarlierAnswers> earlier_answers(const Campaign& campaign, const Study& study,
                                                      const std::vector<std::string>& missing) {
  const auto has = [](const std::vector<std::string>& names, const AssessmentRecord& said) {
    return std::find(names.begin(), names.end(), said.form->method().name) != names.end();
  };
  const auto earlier = std::make_shared<EarlierAnswers>();
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (record.status == ExperimentStatus::ok)
      for (const AssessmentRecord& said : record.assessments)
        if (has(study.methods, said) && !has(missing, said))
          (*earlier)[record.draw.index].push_back(said);
  });
  return earlier;
}

/// Judges loops by the methods that are missing, and takes the answers of the others from an earlier run.
LoopAssessor assessor_beside(const TrialRequest& request, const std::vector<std::string>& missing,
                             const std::shared_ptr<const EarlierAnswers>& earlier) {
  return [earlier, ask_missing = request.assessor(missing), ask_all = request.assessor(request.study.methods),
          forms = assessment_forms(request.study, request.study.methods)](const ExperimentRecord& record) {
    const auto known = earlier->find(record.draw.index);
    if (known == earlier->end())
      return ask_all(record);
    ExperimentRecord answered;
    answered.assessments = unassessed(forms);
    put_answers(known->second, answered);
    put_answers(ask_missing(record), answered);
    return answered.assessments;
  };
}

/// Returns the kept loops if all methods of the request have judged them. Otherwise returns none, and has
/// `run` ask only the methods that have not.
std::optional<Campaign> answered_before(const TrialRequest& request, const std::filesystem::path& archive,
                                        RunOptions& run) {
  std::vector<std::string> missing = request.study.methods;
  auto earlier = std::make_shared<const EarlierAnswers>();
  if (std::optional<Campaign> campaign = kept_loops(archive, request.study, run, {})) {
    missing = methods_without(*campaign, request.study);
    if (missing.empty())
      return with_methods(*std::move(campaign), request.study.methods, std::nullopt);
    earlier = earlier_answers(*campaign, request.study, missing);
  }
  run.assessor = [&request, missing, earlier] { return assessor_beside(request, missing, earlier); };
  return std::nullopt;
}

/// Returns what gives the loops like the record: it runs them in workers and keeps them, or takes the kept
/// ones. Methods that have judged the kept loops are not asked again.
TrialRunner kept_trials(const AssessArguments& options, Progress& progress, const std::string& command) {
  return [&options, &progress, &command](const TrialRequest& request) {
    const std::filesystem::path archive = calibration_archive(options);
    const CampaignHooks hooks = hooks_of(progress);
    RunOptions run = options.run;
    run.methods = request.study.methods;
    run.store = StorePolicy::none;
    run.audit_share = 0.0;
    run.allow_unhealthy_basis = true;
    std::optional<Campaign> campaign = kept_campaign(archive, request.study, run, hooks.on_warning);
    if (!campaign)
      campaign = answered_before(request, archive, run);
    if (!campaign) {
      require_output_archive(archive, "calibration run");
      campaign = run_and_keep(archive, request.study, run, hooks, command);
    }
    const auto kept = std::make_shared<const Campaign>(*std::move(campaign));
    const RecordRange records = records_of(*kept);
    FailureTally failures;
    records.each([&failures](const ExperimentRecord& record) {
      for (const AssessmentRecord& said : record.assessments) {
        VerdictFailures of_loop;
        of_loop.add(said);
        failures.add(said.form->method().name, of_loop);
      }
    });
    failures.tell(progress);
    return TrialLoops{records, archive.filename().string(), kept};
  };
}

ExitCode assess(AssessArguments options, const std::string& command) {
  const Study study = find_study(options.study);
  options.methods = shipped_methods().known(options.methods, "--methods");
  const std::filesystem::path calibration = calibration_archive(options);
  require_no_input("--calibration", calibration, {options.study, options.data});
  if (!options.page.empty()) {
    require_no_input("--output", options.page, {options.study, options.data, calibration.string()});
    require_output_folder(options.page, "page");
  }
  if (options.trials > 0)
    require_own_archive(calibration);
  Progress progress(options.quiet);
  PlantRecord record = load_plant_record(study, options.data);
  const auto monitoring = monitoring_of(options, study, record);
  RecordAssessment assessment;
  try {
    assessment =
        assess_record(study, std::move(record),
                      {.methods = options.methods,
                       .model_error = 0.01 * options.model_error,
                       .trials = options.trials,
                       .monitoring = monitoring,
                       .for_each = in_threads(study, options.run)},
                      qp_solver_factory(options.run.solver), kept_trials(options, progress, command));
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) + "; the same command resumes the calibration run");
  }
  assessment.file = std::filesystem::path(options.data).filename().string();
  assessment.version = mpmbench_version();
  if (!options.page.empty())
    write_text(options.page, document_html(assessment_document(assessment)));
  print_result(options.json    ? assessment_json(assessment)
               : options.brief ? brief_text(assessment)
                               : document_text(assessment_document(assessment)));
  return ExitCode::done;
}

}  // namespace

void add_assess(CommandSet& commands) {
  const auto options = std::make_shared<AssessArguments>();
  CLI::App& app = commands.add(
      "assess",
      "Assess records of a plant: does the model still explain them, what does the loop cost, what to do",
      [options, &commands] { return assess(*options, commands.command_line()); });
  add_path(app, "STUDY", options->study, "Study file, or name of a shipped study")->required();
  add_path(app, "DATA", options->data, "Records of the loop (CSV or netCDF-4)")->required();
  add_methods_option(app, options->methods,
                     "Methods to show beside the verdict, which is that of mpmbench, separated by commas");
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
  app.add_flag("--brief", options->brief, "Print the verdict in ten lines or fewer, for a mail");
  add_quiet(app, options->quiet);
}

}  // namespace mpm
