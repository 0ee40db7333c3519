#include "bench/campaign/campaign_runner.hpp"

#include <chrono>
#include <ctime>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/campaign/comparison_runner.hpp"
#include "bench/campaign/outcome_collection.hpp"
#include "bench/execution/experiment_execution.hpp"
#include "bench/shards/shard_store.hpp"
#include "bench/version.hpp"

namespace mpm {
namespace {

void require_options(const RunOptions& options, const Study& study, std::int64_t count) {
  if (study.names_scenarios() && count > study.experiment_count())
    throw InputError("experiments", fmt::format("{}", count),
                     fmt::format("at most {}, the named scenarios of the study", study.experiment_count()));
  if (count < 1)
    throw InputError("experiments", fmt::format("{}", count), "a whole number >= 1");
  if (options.jobs < 1)
    throw InputError("jobs", fmt::format("{}", options.jobs), "a whole number >= 1");
  if (!(options.audit_share >= 0.0 && options.audit_share <= 1.0))
    throw InputError("audit share", fmt::format("{}", options.audit_share), "a number from 0 to 1");
}

void require_health(const BasisCase& basis, const RunOptions& options) {
  if (basis.healthy || (options.allow_unhealthy_basis && basis.trajectory.status == ControlStatus::ok))
    return;
  throw UnhealthyBasis("the basis case of the study fails its self-check: " + basis.explanation);
}

using Execution = decltype(&execute_in_threads);

/// Throws InputError for threads that the solver does not bear.
Execution execution_of(const RunOptions& options) {
  const bool safe = options.solver == "auto" || options.solver == "active-set";
  if (options.parallel == Parallel::threads && !safe)
    throw InputError("parallel", fmt::format("threads for the solver {}", options.solver),
                     "processes, or one of the solvers auto and active-set");
  return safe && options.parallel != Parallel::processes ? execute_in_threads : execute_in_processes;
}

std::vector<std::int64_t> all_of(std::int64_t count) {
  std::vector<std::int64_t> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// The basis case; with Ipopt it takes as long as an experiment, so that a stop must not wait for it.
BasisCase stoppable_basis_case(const Study& study, const QpSolverFactory& factory, const StopRequest& stop,
                               std::int64_t done, std::int64_t count) {
  return run_basis_case(study, factory, [&](const Mpc&) {
    if (requested(stop))
      throw Interrupted(done, count);
  });
}

/// Runs the experiments of the plan, which are what is missing of `count`, and brings all into order. Without
/// shards, outcomes wait in memory; with shards, on the disk, so that a campaign without kept loops needs no
/// more memory the longer it is.
OutcomeCollection run_experiments(const ExecutionPlan& plan, Execution execute, std::int64_t count,
                                  ShardStore* shards, const CampaignHooks& hooks) {
  std::int64_t done = count - static_cast<std::int64_t>(plan.indices.size());
  if (hooks.on_start)
    hooks.on_start(done, count);
  OutcomeCollection outcomes(count);
  const auto take = [&](ExperimentOutcome outcome) {
    ++done;
    if (hooks.on_done)
      hooks.on_done(outcome.record);
    if (shards != nullptr)
      shards->add(outcome);
    else
      outcomes.add(std::move(outcome));
  };
  if (!plan.indices.empty())
    execute(plan, hooks.stop, take);
  if (shards != nullptr)
    shards->flush();
  if (done < count)
    throw Interrupted(done, count);
  if (shards != nullptr)
    shards->read([&](ExperimentOutcome outcome) { outcomes.add(std::move(outcome)); });
  return outcomes;
}

/// How, when and by which program; without the times.
CampaignInfo info_of(const RunOptions& options) {
  CampaignInfo info;
  info.mpmbench_version = mpmbench_version();
  info.git_sha = source_revision();
  info.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  info.solver = options.solver;
  info.jobs = options.jobs;
  info.audit_share = audited_share(options);
  return info;
}

}  // namespace

Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                      const std::optional<std::filesystem::path>& shard_folder) {
  const auto start = std::chrono::steady_clock::now();
  Campaign campaign;
  campaign.study = study_to_run(std::move(study), options);
  const std::int64_t count = options.experiments.value_or(campaign.study.experiment_count());
  require_options(options, campaign.study, count);
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const Execution execute = execution_of(options);

  std::optional<ShardStore> shards;
  if (shard_folder)
    shards.emplace(*shard_folder, options, campaign.study, count, hooks.on_warning);
  const ExecutionPlan plan{campaign.study, campaign.basis, options,
                           shards ? shards->missing() : all_of(count)};
  const std::int64_t done = count - static_cast<std::int64_t>(plan.indices.size());
  campaign.basis = stoppable_basis_case(campaign.study, factory, hooks.stop, done, count);
  require_health(campaign.basis, options);
  OutcomeCollection outcomes = run_experiments(plan, execute, count, shards ? &*shards : nullptr, hooks);

  campaign.info = info_of(options);
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() +
                          (shards ? shards->earlier_seconds() : 0.0);
  campaign.methods = methods_of(campaign.study, "");
  outcomes.move_into(campaign);
  return campaign;
}

}  // namespace mpm
