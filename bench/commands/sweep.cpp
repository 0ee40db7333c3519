#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/kept_campaign.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/replaced_archive.hpp"
#include "bench/parts/launcher.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/summary/sweep_document.hpp"
#include "scenarios/files/sweep_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  std::string sweep;
  std::string output;
  std::string shard;  ///< which of the studies are run; empty: all of them, and the table
  RunOptions run;
  bool overwrite = false;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

std::string label(const SweepVariant& variant) {
  return variant.choice.empty() ? "as shipped" : fmt::format("{} = {}", variant.choice, variant.value);
}

fs::path archive_of(const fs::path& folder, std::size_t place) {
  return folder / fmt::format("{:02}.h5", place);
}

std::vector<IntendedStudy> intended(const Sweep& sweep, const std::optional<PartNumber>& part,
                                    const fs::path& folder) {
  std::vector<IntendedStudy> studies;
  for (std::size_t i = 0; i < sweep.variants.size(); ++i)
    if (is_in_part(i, part))
      studies.push_back({label(sweep.variants[i]), sweep.variants[i].study, archive_of(folder, i)});
  return studies;
}

/// Runs every study and writes its archive, one after the other, and at the end the table of all of them
/// (`sweep.md`, and on stdout). A part of the studies leaves its archives only, which another call finds.
ExitCode run_sweep(const SweepArguments& options, const std::string& command_line) {
  const Sweep sweep = find_sweep(options.sweep);
  const std::optional<PartNumber> part = part_of_option(options.shard);
  const fs::path folder = options.output;
  if (options.dry_run) {
    Progress progress(options.quiet);
    print_result(dry_run_text(intended(sweep, part, folder), options.run, hooks_of(progress)));
    return ExitCode::done;
  }
  make_output_folder(folder, "archives");
  for (const IntendedStudy& study : intended(sweep, part, folder)) {
    require_output_archive(study.archive, "archive");
    if (!options.overwrite)
      require_replaceable(study.archive, study_to_run(study.study, options.run), Unreadable::replaced);
  }
  Progress progress(options.quiet);
  std::vector<SweepRow> rows;
  for (std::size_t i = 0; i < sweep.variants.size(); ++i) {
    if (!is_in_part(i, part))
      continue;
    const SweepVariant& variant = sweep.variants[i];
    const std::string name = fmt::format("study {} of {}: {}", i + 1, sweep.variants.size(), label(variant));
    SweepRow& row = rows.emplace_back(SweepRow{
        .choice = variant.choice, .value = variant.value, .healthy = true, .trouble = "", .findings = {}});
    try {
      KeptRun run = run_unless_kept(archive_of(folder, i), variant.study, options.run, hooks_of(progress),
                                    command_line, [&](bool) { progress.note(name); });
      row.trouble = std::move(run.trouble);
      if (run.campaign) {
        row.healthy = run.campaign->basis.healthy;
        row.findings = findings_of(*run.campaign).rows;
      }
    } catch (const Interrupted& error) {
      throw std::runtime_error(fmt::format("{}, in {}{}", progress.explain(error), name,
                                           how_to_go_on("in " + options.output, command_line)));
    }
    if (!row.trouble.empty())
      progress.warn(fmt::format("{}: {}", name, row.trouble));
  }
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
  options->run.allow_unhealthy_basis =
      true;  // marked in the table: how much a choice matters is the question
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
  add_dry_run(app, options->dry_run);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
