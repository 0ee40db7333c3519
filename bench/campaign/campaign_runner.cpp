#include "bench/campaign/campaign_runner.hpp"

#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bench/campaign/calibration_runs.hpp"
#include "bench/campaign/campaign_steps.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/campaign/experiment_series.hpp"
#include "bench/campaign/streamed_records.hpp"
#include "bench/shards/shard_folder.hpp"
#include "scenarios/loop/calibration.hpp"

namespace mpm {
namespace {

void require_options(const RunOptions& options) {
  if (options.jobs < 1)
    throw InputError("jobs", fmt::format("{}", options.jobs), "a whole number >= 1");
  if (!(options.audit_share >= 0.0 && options.audit_share <= 1.0))
    throw InputError("audit share", fmt::format("{}", options.audit_share), "a number from 0 to 1");
  qp_solver_factory(options.solver);  // refuses one that there is not
}

}  // namespace

bool runs_in_threads(const Study& study, const RunOptions& options) {
  const bool safe = options.solver == "auto" || options.solver == "active-set";
  if (options.parallel == Parallel::threads && !safe)
    throw InputError("parallel", fmt::format("threads for the solver {}", options.solver),
                     "processes, or one of the solvers auto and active-set");
  const bool foreign = (study.nonlinear && study.nonlinear->model.foreign) || study.controller_program;
  return options.parallel == Parallel::by_solver ? safe && !foreign : options.parallel == Parallel::threads;
}

namespace {

/// The loops of a campaign, or of a part of it: its experiments, and its calibration loops.
class CampaignLoops {
 public:
  /// `study` must outlive it; the loops `part` only, where it is one.
  CampaignLoops(const Study& study, const RunOptions& options,
                const std::optional<std::filesystem::path>& shards, const ShardStore::Warn& warn,
                const LoopRanges* part = nullptr)
      : study_(study), options_(options) {
    require_options(options);
    execute_ = runs_in_threads(study, options) ? execute_in_threads : execute_in_processes;
    const std::int64_t count = experiment_count(study, options);
    experiments_.emplace(study, options, wanted(part, 0, count), shards, warn);
    if (!study.calibration)
      return;
    calibration_study_ = calibration_study(study);
    calibration_.emplace(calibration_study_, calibration_options(options),
                         wanted(part, count, count + calibration_study_.experiment_count()),
                         shards ? std::optional(calibration_shard_folder(*shards)) : std::nullopt, warn);
  }

  ExperimentTally tally() const {
    ExperimentTally tally = experiments_->tally();
    if (calibration_)
      tally += calibration_->tally();
    return tally;
  }

  double earlier_seconds() const {
    return experiments_->earlier_seconds() + (calibration_ ? calibration_->earlier_seconds() : 0.0);
  }

  /// The basis case, and then what is missing.
  BasisCase run(const CampaignHooks& hooks) {
    ExperimentTally tally = this->tally();
    BasisCase basis = checked_basis(study_, options_, hooks, tally);
    if (hooks.on_start)
      hooks.on_start(tally.done, tally.count);
    experiments_->run(study_, basis, execute_, hooks, tally);
    if (calibration_)
      calibration_->run(study_, basis, execute_, hooks, tally);
    return basis;
  }

  void move_into(Campaign& campaign) {
    experiments_->collect().move_into(campaign);
    if (!calibration_)
      return;
    Campaign loops;
    calibration_->collect().move_into(loops);
    campaign.calibration = calibration_of(calibration_study_, loops.records);
  }

  /// The same, but the records stay in the shards.
  void stream_into(Campaign& campaign, const StopRequest& stop) {
    take_records(campaign, experiments_->shards(), stop);
    if (calibration_)
      campaign.calibration = calibration_of(calibration_study_, records_in(calibration_->shards(), stop));
  }

  void compact() {
    experiments_->compact();
    if (calibration_)
      calibration_->compact();
  }

 private:
  static WantedLoops wanted(const LoopRanges* part, std::int64_t first, std::int64_t end) {
    return {end - first,
            part != nullptr ? indices_within(*part, first, end) : indices_within({{first, end}}, first, end)};
  }

  const Study& study_;
  const RunOptions& options_;
  Execution execute_ = nullptr;
  std::optional<ExperimentSeries> experiments_;
  Study calibration_study_;
  std::optional<ExperimentSeries> calibration_;
};

/// Says in a folder of shards of which campaign they are, so that what is done of it can be looked at;
/// without a shard to speak of it goes at the end.
class ShardsDescription {
 public:
  ShardsDescription(const std::filesystem::path& shards, const Study& study, RunOptions options)
      : shards_(shards) {
    options.experiments = experiment_count(study, options);
    PartFolder folder;
    folder.path = shards;
    folder.study = study;
    folder.options = options;
    folder.loops = *options.experiments + calibration_loops(study);
    folder.part.loops = {{0, folder.loops}};
    write_part_description(folder);
  }
  ~ShardsDescription() {
    std::error_code no_file;
    if (shards_in(shards_).empty() && shards_in(calibration_shard_folder(shards_)).empty())
      std::filesystem::remove(shards_ / kCampaignDescription, no_file);
  }
  ShardsDescription(const ShardsDescription&) = delete;
  ShardsDescription& operator=(const ShardsDescription&) = delete;

 private:
  std::filesystem::path shards_;
};

/// The campaign without its records, which collect(campaign, loops) brings.
template <class Collect>
Campaign run_to_end(Study study, const RunOptions& options, const CampaignHooks& hooks,
                    const std::optional<std::filesystem::path>& shards, const Collect& collect) {
  const auto start = std::chrono::steady_clock::now();
  Campaign campaign;
  campaign.study = study_to_run(std::move(study), options);
  CampaignLoops loops(campaign.study, options, shards, hooks.on_warning);
  std::optional<ShardsDescription> description;
  if (shards)
    description.emplace(*shards, campaign.study, options);
  campaign.basis = loops.run(hooks);
  campaign.info = info_of(campaign.study, options);
  campaign.methods = methods_of(campaign.study, "");
  collect(campaign, loops);
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() +
                          loops.earlier_seconds();
  if (hooks.on_end)
    hooks.on_end(campaign);
  return campaign;
}

}  // namespace

Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                      const std::optional<std::filesystem::path>& shards) {
  return run_to_end(std::move(study), options, hooks, shards,
                    [](Campaign& campaign, CampaignLoops& loops) { loops.move_into(campaign); });
}

void stream_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                     const std::filesystem::path& shards) {
  run_to_end(std::move(study), options, hooks, shards,
             [&](Campaign& campaign, CampaignLoops& loops) { loops.stream_into(campaign, hooks.stop); });
}

std::int64_t run_part(const PartFolder& part, const CampaignHooks& hooks) {
  CampaignLoops loops(part.study, part.options, part.path, hooks.on_warning, &part.part.loops);
  write_part_description(part);
  const ExperimentTally tally = loops.tally();
  if (tally.done < tally.count)
    loops.run(hooks);
  loops.compact();
  return tally.count - tally.done;
}

}  // namespace mpm
