#include "bench/sweep_command.hpp"

#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/campaign_runner.hpp"
#include "bench/progress.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/summary/summary_parts.hpp"
#include "results/summary/sweep_table.hpp"
#include "scenarios/sweep_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw ArchiveError(fmt::format("{}: no archives can be written: {}", folder.string(), error.message()));
}

std::string label(const SweepVariant& variant) {
  return variant.choice.empty() ? "as shipped" : fmt::format("{} = {}", variant.choice, variant.value);
}

Campaign run_variant(const SweepVariant& variant, const SweepCommand& command) {
  CampaignOptions options;
  options.experiments = command.experiments;
  options.solver = command.solver;
  options.jobs = command.jobs;
  options.store = StorePolicy::none;
  options.allow_unhealthy_basis = true;
  Progress progress(command.experiments.value_or(variant.study.experiment_count()),
                    command.quiet ? Progress::Mode::quiet : Progress::Mode::automatic);
  options.on_done = [&](const ExperimentRecord& record) {
    progress.advance(record.status == ExperimentStatus::failed);
  };
  Campaign campaign = run_campaign(variant.study, options);
  progress.finish();
  return campaign;
}

}  // namespace

void run_sweep(const SweepCommand& command, const std::string& command_line) {
  const Sweep sweep = find_sweep(command.sweep);
  const fs::path folder = command.output;
  make_folder(folder);
  std::vector<SweepRow> rows;
  for (std::size_t i = 0; i < sweep.variants.size(); ++i) {
    const SweepVariant& variant = sweep.variants[i];
    if (!command.quiet)
      fmt::print(stderr, "study {} of {}: {}\n", i + 1, sweep.variants.size(), label(variant));
    Campaign campaign = run_variant(variant, command);
    campaign.info.command = command_line;
    write_archive(folder / fmt::format("{:02}.h5", i), campaign);
    rows.push_back({variant.choice, variant.value, campaign.basis.healthy,
                    named_values(aggregate(campaign.study, campaign.records))});
  }
  const std::string table = sweep_table(rows);
  write_file_atomically(folder / "sweep.md", std::as_bytes(std::span(table)));
  fmt::print("{}\n{}", sweep.title, table);
}

}  // namespace mpm
