#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "base/error.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/experiment_loop.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/archive/csv_table.hpp"
#include "results/blind/blind_loops.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct ExportArguments {
  std::string archive;
  std::string table = "experiments";
  std::optional<std::int64_t> index;  ///< of the experiment; none: all
  std::string output;                 ///< empty: stdout
  bool blind = false;
  BlindParts parts;
  std::string key;  ///< file for the key of the blind loops; empty: none
  int jobs = 1;
  bool quiet = false;
};

/// Writes the loops, without the truth, into a folder.
ExitCode export_blind(const ExportArguments& options) {
  const Campaign campaign = stream_input(options.archive);
  if (options.parts.calibration && !campaign.study.calibration)
    throw InputError("--calibration", "a study without a table `calibration`", "a study with one");
  if (options.parts.windows && !campaign.study.monitoring)
    throw InputError("--windows", "a study without a table `monitoring`", "a study with one");
  const std::vector<BlindLoop> order = blind_order(campaign, options.parts.calibration);
  if (order.empty())
    throw InputError(options.archive, "no loop that ran to its end", "one or more to export");
  if (options.output.empty())
    throw InputError("--output", "none", "with --blind a folder");
  if (!options.key.empty()) {
    require_no_input("--key", options.key, {options.archive});
    require_output_folder(options.key, "key");
  }
  make_output_folder(options.output, "loops");
  Progress progress(options.quiet);
  const std::filesystem::path shards = std::filesystem::path(options.output) / "loops.shards";
  const ShardIdentity identity{{"program", program_identity()},
                               {"list of loops", loops_hash(campaign, options.parts.calibration)}};
  std::optional<ShardStore> loops(std::in_place, shards, identity,
                                  ShardStore::Options{.leftovers = Leftovers::renew});
  try {
    run_blind_loops(campaign, order, options.jobs, hooks_of(progress), *loops);
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) + "; run the same command again to resume");
  }
  AssessmentContext context =
      assessment_context(campaign.study, campaign.basis, qp_solver_factory(campaign.info.solver));
  std::optional<BlindLoops> benchmarks;
  if (campaign.study.world) {
    context.benchmark.reset();
    benchmarks = blind_benchmarks_in(*loops, order.size());
  }
  write_blind_loops(options.output, campaign, context,
                    {blind_loops_in(*loops, order.size()), std::move(benchmarks)}, options.parts);
  loops.reset();
  remove_shard_folder(shards);
  if (!options.key.empty())
    write_text(options.key, blind_key(campaign, options.parts.calibration));
  print_result(
      fmt::format("{} loops of {} without the truth: {}\n", order.size(), options.archive, options.output));
  return ExitCode::done;
}

ExitCode export_table(const ExportArguments& options) {
  if (options.blind)
    return export_blind(options);
  if (!options.output.empty()) {
    require_no_input("--output", options.output, {options.archive});
    require_output_folder(options.output, "table");
  }
  if (options.index && options.table == "findings")
    throw InputError("--index", "the table findings", "a table with a row or more for each experiment");
  Campaign campaign = stream_input(options.archive);
  if (options.index) {
    campaign.records = {experiment_of(campaign, *options.index)};
    campaign.streamed.reset();
    ExperimentRecord& record = campaign.records.front();
    if (options.table == "loops" && !record.loop)
      record.loop = loop_of(campaign, record);
  }
  bool heading_only = true;
  const auto write_table = [&](const auto& write) {
    std::size_t lines = 0;
    write_csv_table(campaign, options.table, [&](std::string_view line) {
      write(line);
      ++lines;
    });
    heading_only = lines <= 1;
  };
  if (options.output.empty())
    write_table(print_result);
  else
    write_text(options.output, write_table);
  if (heading_only)
    print_note(
        fmt::format("warning: the table {} is empty: {} has no such data\n", options.table, options.archive));
  return ExitCode::done;
}

}  // namespace

void add_export(CommandSet& commands) {
  const auto options = std::make_shared<ExportArguments>();
  CLI::App& app = commands.add("export", "Write a table of an archive as CSV, for Octave and spreadsheets",
                               [options] { return export_table(*options); });
  add_archive(app, options->archive);
  add_trust(app);
  app.add_option("--table", options->table,
                 "experiments, findings, loops (the stored ones; with --index any), or the name of a method")
      ->capture_default_str();
  app.add_option("--index", options->index, "Only this experiment; not for the findings")
      ->check(whole_number(0, 1000000000));
  CLI::Option* const blind =
      app.add_flag("--blind", options->blind,
                   "Write the loops without the truth into the folder OUTPUT, for a blind assessment");
  app.add_flag("--calibration", options->parts.calibration,
               "With --blind: mix the calibration loops with the others")
      ->needs(blind);
  app.add_flag("--windows", options->parts.windows,
               "With --blind: also ask for verdicts on the moving windows of each loop")
      ->needs(blind);
  add_path(app, "--key", options->key,
           "With --blind: CSV file to write that maps each loop to its experiment, to train a method")
      ->needs(blind);
  add_path(app, "-o,--output", options->output, "File to write, with --blind a folder (default: stdout)");
  add_jobs(app, options->jobs, "With --blind: how many loops that were not stored run at once");
  add_quiet(app, options->quiet);
}

}  // namespace mpm
