#include "bench/campaign/campaign_runner.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "base/system/surroundings.hpp"
#include "bench/cache/loop_memory.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/execution/second_try.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "scenarios/loop/world.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

void require_health(const BasisCase& basis, const RunOptions& options) {
  if (basis.healthy || (options.allow_unhealthy_basis && basis.trajectory.status == ControlStatus::ok))
    return;
  throw UnhealthyBasis("the basis case of the study fails its self-check: " + basis.explanation);
}

/// The world of a loop.
int world_of(const CampaignLoops& loops, std::int64_t key) {
  return world_of(key < kCalibrationKeys ? loops.study() : loops.calibration(), key % kCalibrationKeys);
}

/// Returns the keys in the order in which their loops run. The loops of one world follow each other, so that
/// methods learn from its benchmark only once, and a program is told it only once.
std::vector<std::int64_t> in_turn(const CampaignLoops& loops, std::vector<std::int64_t> keys) {
  if (!loops.study().world)
    return keys;
  std::vector<std::pair<int, std::int64_t>> by_world;
  for (const std::int64_t key : keys)
    by_world.emplace_back(world_of(loops, key), key);
  std::sort(by_world.begin(), by_world.end());
  std::transform(by_world.begin(), by_world.end(), keys.begin(),
                 [](const auto& each) { return each.second; });
  return keys;
}

/// Runs the basis case, and then those of the loops with these keys that the store lacks.
BasisCase run_loops(const CampaignLoops& loops, ShardStore& store, const std::vector<std::int64_t>& keys,
                    const CampaignHooks& hooks) {
  const std::int64_t count = std::ssize(keys);
  BasisCase basis =
      checked_basis(loops.study(), loops.options(), hooks, count - std::ssize(store.missing(keys)), count);
  std::optional<LoopMemory> memory;
  if (loops.options().cache && LoopMemory::may_keep(loops.study(), loops.options()))
    memory.emplace(loops.study(), loops.calibrates() ? &loops.calibration() : nullptr, loops.options());
  LoopWork work = loops.work(basis, hooks.on_warning, memory ? &*memory : nullptr);
  work.stop = hooks.stop;
  work.on_start = hooks.on_start;
  work.on_done = hooks.on_done;
  if (loops.study().world)  // experiments and calibration loops have benchmarks of their own
    work.group = [&loops](std::int64_t key) { return 2 * world_of(loops, key) + (key < kCalibrationKeys); };
  const KeepAtEnd keeper(memory ? &*memory : nullptr, hooks.on_warning);
  run_missing(store, in_turn(loops, keys), work);
  return basis;
}

/// Writes into a folder of shards a description of their campaign, so that finished work can be looked at.
/// Removes the description at the end if there is no shard.
class ShardsDescription {
 public:
  ShardsDescription(const std::filesystem::path& shards, const CampaignLoops& loops) : shards_(shards) {
    PartFolder folder{shards, loops.study(), loops.options(), loops.count(), {{{0, loops.count()}}}};
    folder.options.experiments = loops.experiments();
    write_part_description(folder);
  }
  ~ShardsDescription() {
    std::error_code no_file;
    if (shards_in(shards_).empty())
      std::filesystem::remove(shards_ / kCampaignDescription, no_file);
  }
  ShardsDescription(const ShardsDescription&) = delete;
  ShardsDescription& operator=(const ShardsDescription&) = delete;

 private:
  std::filesystem::path shards_;
};

Campaign run_to_end(Study study, const RunOptions& options, const CampaignHooks& hooks,
                    const std::optional<std::filesystem::path>& shards, bool in_memory) {
  const auto start = std::chrono::steady_clock::now();
  const CampaignLoops loops(study_to_run(std::move(study), options), options);
  ShardStore store = shards ? loops.open(*shards, hooks.on_warning) : loops.in_memory();
  const double earlier_seconds = store.seconds();
  std::optional<ShardsDescription> description;
  if (shards)
    description.emplace(*shards, loops);
  Campaign campaign;
  campaign.study = loops.study();
  campaign.basis = run_loops(loops, store, loops.keys({{0, loops.count()}}), hooks);
  campaign.info = info_of(campaign.study, options);
  campaign.methods = methods_of(campaign.study, "");
  loops.take(campaign, store, hooks.stop, in_memory);
  campaign.info.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() + earlier_seconds;
  if (hooks.on_end)
    hooks.on_end(campaign);
  return campaign;
}

}  // namespace

BasisCase checked_basis(const Study& study, const RunOptions& options, const CampaignHooks& hooks,
                        std::int64_t done, std::int64_t count) {
  const auto look = [&](const Controller&) {
    if (requested(hooks.stop))
      throw Interrupted(done, count);
  };
  const auto warn = [&](const std::exception& error) {
    if (hooks.on_warning)
      hooks.on_warning(fmt::format("{}; the basis case is run once more", what_happened(error)));
  };
  BasisCase basis =
      second_try([&] { return run_basis_case(study, qp_solver_factory(options.solver), look); }, warn);
  if (hooks.on_basis)
    hooks.on_basis(study, basis);
  require_health(basis, options);
  return basis;
}

CampaignInfo info_of(const Study& study, const RunOptions& options) {
  CampaignInfo info;
  info.mpmbench_version = mpmbench_version();
  info.git_sha = source_revision();
  info.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  info.outside_files = outside_files(study);
  info.solver = options.solver;
  info.jobs = options.jobs;
  info.audit_share = audited_share(study, options);
  return info;
}

Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                      const std::optional<std::filesystem::path>& shards) {
  return run_to_end(std::move(study), options, hooks, shards, true);
}

void stream_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                     const std::filesystem::path& shards) {
  run_to_end(std::move(study), options, hooks, shards, false);
}

std::int64_t run_part(const PartFolder& part, const CampaignHooks& hooks) {
  const CampaignLoops loops(part.study, part.options);
  ShardStore store = loops.open(part.path, hooks.on_warning);
  const std::vector<std::int64_t> keys = loops.keys(part.part.loops);
  const std::int64_t missing = std::ssize(store.missing(keys));
  write_part_description(part);
  if (missing > 0)
    run_loops(loops, store, keys, hooks);
  store.compact();
  return missing;
}

}  // namespace mpm
