#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/study_files/sweep_file.hpp"
#include "bench/cache/cache_folder.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/failure_tally.hpp"
#include "bench/commands/study_series.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/parts/launcher.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/summary/sweep_document.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  std::string sweep;
  std::string output;
  std::string shard;  ///< which studies are run; empty: all of them, and the table is made
  RunOptions run;
  bool overwrite = false;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

std::string label(const SweepVariant& variant) {
  return variant.choice.empty() ? "as shipped" : fmt::format("{} = {}", variant.choice, variant.value);
}

/// Runs the studies one after the other and writes their archives, and at the end the table of all of them
/// (`sweep.md`, and on stdout). A part of the studies leaves only its archives, which another call finds.
ExitCode run_sweep(SweepArguments options, const std::string& command_line) {
  const Sweep sweep = find_sweep(options.sweep);
  options.run.cache = user_cache();
  const std::optional<PartNumber> part = part_of_option(options.shard);
  const fs::path folder = options.output;
  std::vector<const SweepVariant*> variants;
  std::vector<IntendedStudy> studies;
  for (std::size_t i = 0; i < sweep.variants.size(); ++i)
    if (is_in_part(i, part)) {
      const SweepVariant& variant = *variants.emplace_back(&sweep.variants[i]);
      studies.push_back({fmt::format("study {} of {}", i + 1, sweep.variants.size()), label(variant),
                         variant.study, folder / fmt::format("{:02}.h5", i)});
    }
  Progress progress(options.quiet);
  if (options.dry_run) {
    print_result(dry_run_text(studies, options.run, hooks_of(progress)));
    return ExitCode::done;
  }
  require_archives(studies, folder, options.run, options.overwrite);
  std::vector<SweepRow> rows;
  FailureTally failures;
  run_series(studies, options.run, progress, options.output, command_line,
             [&](std::size_t place, KeptRun run) {
               SweepRow& row = rows.emplace_back(SweepRow{.choice = variants[place]->choice,
                                                          .value = variants[place]->value,
                                                          .healthy = true,
                                                          .trouble = std::move(run.trouble),
                                                          .findings = {}});
               if (run.campaign) {
                 row.healthy = run.campaign->basis.healthy;
                 StudyFindings findings = findings_of(*run.campaign);
                 failures.add(findings);
                 row.findings = std::move(findings.rows);
               }
             });
  failures.tell(progress);
  if (part) {
    print_result(fmt::format("{}: {} of {} studies, part {} of {}\n", options.output, rows.size(),
                             sweep.variants.size(), part->number, part->of));
    return ExitCode::done;
  }
  const Document document = sweep_document(sweep.title, rows);
  const std::string table = document_markdown(document);
  write_text(folder / "sweep.md", table);
  print_result(options.json ? document_json(document) : fmt::format("{}\n{}", sweep.title, table));
  return ExitCode::done;
}

}  // namespace

void add_sweep(CommandSet& commands) {
  const auto options = std::make_shared<SweepArguments>();
  options->run.store = StorePolicy::none;
  options->run.allow_unhealthy_basis = true;  // the table marks it: the question is how much a choice matters
  CLI::App& app =
      commands.add("sweep", "Run a study once for each value of its open choices, and make a table",
                   [options, &commands] { return run_sweep(*options, commands.command_line()); });
  add_path(app, "SWEEP", options->sweep, "Sweep file, or name of a shipped sweep")->required();
  add_path(app, "-o,--output", options->output,
           "Folder for the archives and the table; finished studies in it are kept")
      ->required();
  add_experiments(app, options->run.experiments, "Run the first N experiments of each study");
  add_part_of(app, options->shard, "studies");
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_solver(app, options->run.solver);
  add_overwrite(app, options->overwrite);
  add_fresh(app, options->run.fresh);
  add_dry_run(app, options->dry_run);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
