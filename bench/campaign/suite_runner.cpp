#include "bench/campaign/suite_runner.hpp"

#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "bench/campaign/kept_campaign.hpp"
#include "bench/shards/shard_folder.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace fs = std::filesystem;

fs::path suite_archive(const Suite& suite, const SuiteCell& cell, const fs::path& folder) {
  return folder / fmt::format("{}.h5", suite.name_of(cell));
}

std::vector<CellScores> run_suite(const Suite& suite, const SuiteRun& options) {
  std::vector<CellScores> scores;
  for (std::size_t place = 0; place < suite.cells.size(); ++place) {
    if (options.is_wanted && !options.is_wanted(place))
      continue;
    const SuiteCell& cell = suite.cells[place];
    const fs::path archive = suite_archive(suite, cell, options.folder);
    const std::optional<Campaign> kept =
        kept_campaign(archive, cell.study, options.run, options.hooks.on_warning);
    if (options.on_cell)
      options.on_cell(place, kept.has_value());
    if (kept) {
      scores.push_back(cell_scores(cell, findings_of(*kept)));
      continue;
    }
    try {
      const Campaign campaign =
          run_and_keep(archive, cell.study, options.run, options.hooks, options.command);
      scores.push_back(cell_scores(cell, findings_of(campaign)));
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
