#include "bench/options.hpp"

#include <map>
#include <sstream>
#include <thread>

#include <CLI/CLI.hpp>

#include "analysis/methods/method_table.hpp"
#include "bench/version.hpp"
#include "results/plot/figure_format.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

constexpr int kUsageError = 2;

void add_run(CLI::App& app, RunCommand& run) {
  run.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  app.add_option("STUDY", run.study, "Study file, or name of a shipped study")->required();
  app.add_option("-o,--output", run.output, "Archive to write (HDF5)")->required();
  app.add_option("--experiments", run.experiments, "Run the first N experiments; any N keeps the proportions")
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", run.seed, "Master seed instead of the study's");
  app.add_option("--jobs", run.jobs, "How many experiments run at once")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--solver", run.solver, "QP solver")
      ->check(CLI::IsMember(qp_solver_names()))
      ->capture_default_str();
  const std::map<std::string, Parallel> ways{
      {"by-solver", Parallel::by_solver}, {"threads", Parallel::threads}, {"processes", Parallel::processes}};
  app.add_option("--parallel", run.parallel,
                 "Run experiments in threads (auto, active-set only) or in worker processes (all solvers)")
      ->transform(CLI::CheckedTransformer(ways))
      ->default_str("by-solver");
  app.add_option("--audit", run.audit_share,
                 "Share of the steps whose problems Ipopt solves once more, with the solver auto")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  const std::map<std::string, StorePolicy> policies{
      {"none", StorePolicy::none}, {"flagged", StorePolicy::flagged}, {"all", StorePolicy::all}};
  app.add_option("--store", run.store,
                 "Keep the loop data of no experiment, of those with a wrong verdict, of all")
      ->transform(CLI::CheckedTransformer(policies))
      ->default_str("flagged");
  app.add_flag("--allow-unhealthy-basis", run.allow_unhealthy_basis,
               "Run although the basis case fails its self-check");
  CLI::Option* const resume = app.add_flag_callback(
      "--resume", [&run] { run.leftovers = Leftovers::resume; },
      "Go on with an interrupted run of this output: run only what is missing");
  app.add_flag_callback(
         "--discard", [&run] { run.leftovers = Leftovers::discard; },
         "Delete what an interrupted run of this output has done, and start anew")
      ->excludes(resume);
  app.add_option(
         "--shard-interval", run.shard_interval,
         "Seconds between two shards, which keep what is finished: as much is lost when a run is killed")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--quiet", run.quiet, "No progress and no summary");
}

void add_sweep(CLI::App& app, SweepCommand& sweep) {
  sweep.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  app.add_option("SWEEP", sweep.sweep, "Sweep file, or name of a shipped sweep")->required();
  app.add_option("-o,--output", sweep.output, "Folder for the archives and the table")->required();
  app.add_option("--experiments", sweep.experiments, "Run the first N experiments of each study")
      ->check(CLI::PositiveNumber);
  app.add_option("--jobs", sweep.jobs, "How many experiments run at once")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--solver", sweep.solver, "QP solver")
      ->check(CLI::IsMember(qp_solver_names()))
      ->capture_default_str();
  app.add_flag("--quiet", sweep.quiet, "No progress");
}

void add_report(CLI::App& app, ReportCommand& report) {
  app.add_option("ARCHIVE", report.archive, "Archive")->required();
  CLI::Option_group* const outputs = app.add_option_group("outputs", "What to write, one or both");
  outputs->add_option("-o,--output", report.output, "Page to write (HTML)");
  CLI::Option* const figures =
      outputs->add_option("--figures", report.figures, "Folder to write the figures into, one file each");
  outputs->require_option(1, 2);
  app.add_option("--format", report.format, "Format of these files")
      ->check(CLI::IsMember(figure_format_names()))
      ->needs(figures)
      ->capture_default_str();
}

void add_plot(CLI::App& app, PlotCommand& plot) {
  app.add_option("ARCHIVE", plot.archive, "Archive")->required();
  app.add_option("INDEX", plot.index, "Index of the experiment")->required()->check(CLI::NonNegativeNumber);
  app.add_option("-o,--output", plot.output, "Figure to write: NAME.svg, NAME.pdf or NAME.png")->required();
}

void add_compare(CLI::App& app, CompareCommand& compare) {
  compare.methods = assessment_method_names();
  compare.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  app.add_option("ARCHIVE", compare.archive, "Archive")->required();
  app.add_option("--methods", compare.methods, "Methods, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(assessment_method_names()))
      ->capture_default_str();
  app.add_option("-o,--output", compare.output,
                 "Archive to write with the comparison in it (HDF5); may be ARCHIVE itself");
  app.add_option("--experiments", compare.experiments, "Compare on the first N experiments only")
      ->check(CLI::PositiveNumber);
  app.add_option("--jobs", compare.jobs, "How many loops are assessed at once")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--json", compare.json, "As JSON");
  app.add_flag("--quiet", compare.quiet, "No progress");
}

void add_reproduce(CLI::App& app, ReproduceCommand& reproduce) {
  app.add_option("TABLES", reproduce.tables,
                 "all, chapter2 to chapter6, or the number of a table such as 4.5")
      ->capture_default_str();
  app.add_option("-o,--output", reproduce.output, "Page to write (HTML)");
  app.add_option("--solver", reproduce.solver, "QP solver")
      ->check(CLI::IsMember(qp_solver_names()))
      ->capture_default_str();
  app.add_flag("--json", reproduce.json, "As JSON");
  app.add_option("--set", reproduce.changes,
                 "A key of the study of every table with another value, KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--seeds", reproduce.seeds,
                 "Run each table with N seeds, and report medians and the share of seeds that agree")
      ->check(CLI::Range(1, 100000));
  reproduce.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  app.add_option("--jobs", reproduce.jobs, "How many tables run at once, with --solver active-set")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("mpmbench: a Monte Carlo robustness testbench for the assessment of MPC models", "mpmbench");
  app.set_version_flag("--version", "mpmbench " + mpmbench_version() + " (" + source_revision() + ")");
  app.require_subcommand(1);

  RunCommand run;
  ReplayCommand replay;
  SummaryCommand summary;
  CheckCommand check;
  CLI::App* const run_app = app.add_subcommand("run", "Run a study and write its archive");
  add_run(*run_app, run);
  CLI::App* const replay_app = app.add_subcommand(
      "replay", "Run one experiment of an archive again and say whether it is bit-identical");
  replay_app->add_option("ARCHIVE", replay.archive, "Archive")->required();
  replay_app->add_option("INDEX", replay.index, "Index of the experiment")
      ->required()
      ->check(CLI::NonNegativeNumber);
  CLI::App* const summary_app =
      app.add_subcommand("summary", "Print what a study found, beside what was reported");
  summary_app->add_option("ARCHIVE", summary.archive, "Archive")->required();
  summary_app->add_flag("--json", summary.json, "As JSON");
  SweepCommand sweep;
  CLI::App* const sweep_app =
      app.add_subcommand("sweep", "Run a study once for each value of its open choices, and tabulate");
  add_sweep(*sweep_app, sweep);
  CLI::App* const check_app =
      app.add_subcommand("check", "Hold an archive against the limits of a gate file");
  check_app->add_option("ARCHIVE", check.archive, "Archive")->required();
  check_app->add_option("--gates", check.gates, "Gate file (TOML)")->required();
  check_app->add_option("--junit", check.junit, "JUnit XML to write");
  ReportCommand report;
  CLI::App* const report_app =
      app.add_subcommand("report", "Write what a study found as one HTML page, and its figures as files");
  add_report(*report_app, report);
  PlotCommand plot;
  CLI::App* const plot_app = app.add_subcommand("plot", "Draw the closed loop of one experiment");
  add_plot(*plot_app, plot);
  CompareCommand compare;
  CLI::App* const compare_app = app.add_subcommand(
      "compare", "Assess the loops of an archive by several methods: how often is each right?");
  add_compare(*compare_app, compare);
  ReproduceCommand reproduce;
  CLI::App* const reproduce_app =
      app.add_subcommand("reproduce", "Run the studies behind the tables of the thesis, cell by cell");
  add_reproduce(*reproduce_app, reproduce);
  CLI::App* const list_app = app.add_subcommand("list", "List the shipped studies");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const bool wrong_usage = app.exit(error, text, text) != 0;
    return UsageText{text.str(), wrong_usage ? kUsageError : 0};
  }
  if (run_app->parsed())
    return run;
  if (replay_app->parsed())
    return replay;
  if (summary_app->parsed())
    return summary;
  if (sweep_app->parsed())
    return sweep;
  if (check_app->parsed())
    return check;
  if (report_app->parsed())
    return report;
  if (plot_app->parsed())
    return plot;
  if (compare_app->parsed())
    return compare;
  if (reproduce_app->parsed())
    return reproduce;
  if (list_app->parsed())
    return ListCommand{};
  return UsageText{app.help(), kUsageError};
}

}  // namespace mpm
