#include "bench/campaign/suite_runner.hpp"

#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

fs::path archive_of(const Suite& suite, const SuiteCell& cell, const SuiteRun& options) {
  return options.folder / fmt::format("{}.h5", suite.name_of(cell));
}

/// Is it what this run would make of the cell?
bool is_of(const Campaign& campaign, const SuiteCell& cell, const RunOptions& options) {
  const Study study = study_to_run(cell.study, options);
  const std::int64_t count = options.experiments.value_or(study.experiment_count());
  return campaign.study.source == study.source && campaign.study.seed == study.seed &&
         method_names(campaign) == study.methods && campaign.info.solver == options.solver &&
         campaign.info.mpmbench_version == mpmbench_version() && campaign.info.git_sha == source_revision() &&
         static_cast<std::int64_t>(campaign.records.size()) == count;
}

/// The archive of the cell, when it is there and whole and of this run.
std::optional<Campaign> kept_archive(const fs::path& path, const SuiteCell& cell, const RunOptions& options) {
  std::error_code no_status;
  if (!fs::is_regular_file(path, no_status))
    return std::nullopt;
  try {
    Campaign campaign = read_archive(path);
    return is_of(campaign, cell, options) ? std::optional(std::move(campaign)) : std::nullopt;
  } catch (const ArchiveError&) {
    return std::nullopt;  // it is replaced
  }
}

/// Goes on with the shards that an interrupted run has left, unless they are of another study or program.
Campaign run_cell(const SuiteCell& cell, const SuiteRun& options, const fs::path& archive) {
  RunOptions run = options.run;
  run.leftovers = Leftovers::resume;
  const auto once = [&] { return run_campaign(cell.study, run, options.hooks, shard_folder_of(archive)); };
  if (!has_shards(archive))
    return once();
  try {
    return once();
  } catch (const UnhealthyBasis&) {
    throw;
  } catch (const InputError&) {
    run.leftovers = Leftovers::discard;
    return once();
  }
}

}  // namespace

std::vector<CellScores> run_suite(const Suite& suite, const SuiteRun& options) {
  std::vector<CellScores> scores;
  for (std::size_t place = 0; place < suite.cells.size(); ++place) {
    const SuiteCell& cell = suite.cells[place];
    const fs::path archive = archive_of(suite, cell, options);
    const std::optional<Campaign> kept = kept_archive(archive, cell, options.run);
    if (options.on_cell)
      options.on_cell(place, kept.has_value());
    if (kept) {
      remove_shards(archive);  // a run that was killed between archive and clean-up
      scores.push_back(cell_scores(cell, findings_of(*kept)));
      continue;
    }
    try {
      Campaign campaign = run_cell(cell, options, archive);
      note_command(campaign, options.command);
      const StudyFindings findings = findings_of(campaign);
      write_archive(archive, campaign, findings);
      remove_shards(archive);
      remove_abandoned_files(archive);
      scores.push_back(cell_scores(cell, findings));
    } catch (const InputError& error) {
      remove_shards(archive);
      std::error_code no_file;
      fs::remove(archive, no_file);  // of another run: the leaderboard says that there is none
      scores.push_back(
          {.plant = cell.plant, .family = cell.family, .seed = cell.study.seed, .trouble = error.what()});
    }
  }
  return scores;
}

}  // namespace mpm
