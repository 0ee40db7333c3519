#include "bench/campaign/kept_campaign.hpp"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/broken_promise.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

/// Whether the campaign has the loops that this run would make.
bool has_loops_of(const Campaign& campaign, const Study& study, const RunOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiment_count());
  return campaign.study.source == study.source && campaign.study.seed == study.seed &&
         campaign.info.solver == options.solver && campaign.info.outside_files == outside_files(study) &&
         campaign.info.mpmbench_version == mpmbench_version() && campaign.info.git_sha == source_revision() &&
         static_cast<std::int64_t>(records_of(campaign).size()) == count;
}

}  // namespace

std::vector<std::string> methods_without(const Campaign& campaign, const Study& study) {
  std::vector<std::string> methods;
  for (const std::string& name : study.methods) {
    const auto kept =
        std::find_if(campaign.methods.begin(), campaign.methods.end(),
                     [&name](const auto& method) { return method.form->method().name == name; });
    if (kept == campaign.methods.end() ||
        kept->form->method().fingerprint != method_table(study.assessment).method(name).fingerprint)
      methods.push_back(name);
  }
  return methods;
}

std::optional<Campaign> kept_campaign(const fs::path& archive, const Study& study, const RunOptions& options,
                                      const std::function<void(const std::string&)>& warn) {
  std::optional<Campaign> campaign = kept_loops(archive, study, options, warn);
  if (campaign) {
    const Study wanted = study_to_run(study, options);
    if (method_names(*campaign) != wanted.methods || !methods_without(*campaign, wanted).empty())
      return std::nullopt;
    std::error_code no_status;
    if (fs::exists(shard_folder_of(archive), no_status))
      remove_shards(archive);  // a run that was killed between archive and clean-up left them
  }
  return campaign;
}

std::optional<Campaign> kept_loops(const fs::path& archive, const Study& study, const RunOptions& options,
                                   const std::function<void(const std::string&)>& warn) {
  std::error_code no_status;
  if (!fs::is_regular_file(archive, no_status))
    return std::nullopt;
  try {
    Campaign campaign = stream_archive(archive);
    if (!has_loops_of(campaign, study_to_run(study, options), options))
      return std::nullopt;
    return campaign;
  } catch (const ArchiveError& error) {
    if (warn)
      warn(fmt::format("{}; it is made again", error.what()));
    return std::nullopt;
  }
}

Campaign run_and_keep(const fs::path& archive, const Study& study, RunOptions options, CampaignHooks hooks,
                      const std::string& command) {
  hooks.on_end = [&](Campaign& campaign) {
    note_command(campaign, command);
    write_archive(archive, campaign, findings_of(campaign));
  };
  options.leftovers = Leftovers::renew;
  stream_campaign(study, options, hooks, shard_folder_of(archive));
  remove_shards(archive);
  return stream_archive(archive);
}

KeptRun run_unless_kept(const fs::path& archive, const Study& study, const RunOptions& options,
                        const CampaignHooks& hooks, const std::string& command,
                        const std::function<void(bool is_there)>& on_start) {
  try {
    std::optional<Campaign> campaign = kept_campaign(archive, study, options, hooks.on_warning);
    on_start(campaign.has_value());
    if (!campaign)
      campaign = run_and_keep(archive, study, options, hooks, command);
    return {.campaign = std::move(campaign)};
  } catch (const BrokenPromise&) {
    throw;
  } catch (const InputError& error) {
    remove_shards(archive);
    std::error_code no_file;
    fs::remove(archive, no_file);  // an archive of another run: the table says that there is none
    return {.trouble = error.what()};
  }
}

}  // namespace mpm
