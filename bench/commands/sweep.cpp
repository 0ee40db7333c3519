#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/campaign/campaign_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "results/archive/archive.hpp"
#include "results/summary/sweep_table.hpp"
#include "scenarios/sweep_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  std::string sweep;
  std::string output;
  RunOptions run;
  bool quiet = false;
};

std::string label(const SweepVariant& variant) {
  return variant.choice.empty() ? "as shipped" : fmt::format("{} = {}", variant.choice, variant.value);
}

/// Runs a study of the sweep; `name` says which one.
Campaign run_variant(const SweepVariant& variant, const std::string& name, const RunOptions& options,
                     Progress& progress) {
  progress.note(name);
  try {
    return run_campaign(variant.study, options, hooks_of(progress));
  } catch (const Interrupted& error) {
    throw std::runtime_error(fmt::format("{}, in {}", progress.explain(error), name));
  }
}

/// Runs every study and writes its archive, one after the other, and at the end the table of all of them
/// (`sweep.md`, and on stdout).
ExitCode run_sweep(const SweepArguments& options, const std::string& command_line) {
  const Sweep sweep = find_sweep(options.sweep);
  const fs::path folder = options.output;
  make_output_folder(folder, "archives");
  Progress progress(options.quiet);
  std::vector<SweepRow> rows;
  for (std::size_t i = 0; i < sweep.variants.size(); ++i) {
    const SweepVariant& variant = sweep.variants[i];
    const std::string name = fmt::format("study {} of {}: {}", i + 1, sweep.variants.size(), label(variant));
    Campaign campaign = run_variant(variant, name, options.run, progress);
    note_command(campaign, command_line);
    StudyFindings findings = findings_of(campaign);
    write_archive(folder / fmt::format("{:02}.h5", i), campaign, findings);
    rows.push_back({variant.choice, variant.value, campaign.basis.healthy, std::move(findings.rows)});
  }
  const std::string table = sweep_table(rows);
  write_text(folder / "sweep.md", table);
  print_result(fmt::format("{}\n{}", sweep.title, table));
  return ExitCode::done;
}

}  // namespace

void add_sweep(CommandSet& commands) {
  const auto options = std::make_shared<SweepArguments>();
  options->run.store = StorePolicy::none;
  options->run.allow_unhealthy_basis =
      true;  // marked in the table: how much a choice matters is the question
  CLI::App& app = commands.add("sweep", "Run a study once for each value of its open choices, and tabulate",
                               [options, &commands] { return run_sweep(*options, commands.command_line()); });
  add_path(app, "SWEEP", options->sweep, "Sweep file, or name of a shipped sweep")->required();
  add_path(app, "-o,--output", options->output, "Folder for the archives and the table")->required();
  add_experiments(app, options->run.experiments, "Run the first N experiments of each study");
  add_jobs(app, options->run.jobs, "How many experiments run at once");
  add_solver(app, options->run.solver);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
