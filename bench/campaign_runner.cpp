#include "bench/campaign_runner.hpp"

#include <chrono>
#include <ctime>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/experiment_execution.hpp"
#include "bench/outcome_collection.hpp"
#include "bench/shard_store.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

void require_health(const BasisCase& basis, const CampaignOptions& options) {
  if (basis.healthy || (options.allow_unhealthy_basis && basis.trajectory.status == ControlStatus::ok))
    return;
  throw UnhealthyBasis("the basis case of the study fails its self-check: " + basis.explanation);
}

bool is_thread_safe(const std::string& solver) {
  return solver == "auto" || solver == "active-set";
}

bool runs_in_threads(const CampaignOptions& options) {
  const bool safe = is_thread_safe(options.solver);
  if (options.parallel == Parallel::threads && !safe)
    throw InputError("parallel", fmt::format("threads for the solver {}", options.solver),
                     "processes, or one of the solvers auto and active-set");
  return safe && options.parallel != Parallel::processes;
}

void require_options(const CampaignOptions& options, const Study& study, std::int64_t count) {
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

std::vector<std::int64_t> all_of(std::int64_t count) {
  std::vector<std::int64_t> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// The basis case; with Ipopt it takes as long as an experiment, so that a stop must not wait for it.
BasisCase stoppable_basis_case(const Study& study, const QpSolverFactory& factory, const StopRequest& stop,
                               std::int64_t done, std::int64_t count) {
  return run_basis_case(study, factory, [&](const Mpc&) {
    if (stop && stop())
      throw Interrupted(done, count);
  });
}

/// Runs what no shard has yet, and brings everything into order. Without shards, outcomes wait in memory;
/// with shards, on the disk, so that a campaign without kept loops needs no more memory the longer it is.
OutcomeCollection run_experiments(ExecutionPlan plan, bool threads, std::int64_t count, ShardStore* shards,
                                  const CampaignOptions& options) {
  plan.indices = shards != nullptr ? shards->missing() : all_of(count);
  std::int64_t done = count - static_cast<std::int64_t>(plan.indices.size());
  if (options.on_start)
    options.on_start(done);
  OutcomeCollection outcomes(count);
  const auto take = [&](ExperimentOutcome outcome) {
    ++done;
    if (options.on_done)
      options.on_done(outcome.record);
    if (shards != nullptr)
      shards->add(outcome);
    else
      outcomes.add(std::move(outcome));
  };
  if (!plan.indices.empty())
    (threads ? execute_in_threads : execute_in_processes)(plan, take);
  if (shards != nullptr)
    shards->flush();
  if (done < count)
    throw Interrupted(done, count);
  if (shards != nullptr)
    shards->read([&](ExperimentOutcome outcome) { outcomes.add(std::move(outcome)); });
  return outcomes;
}

}  // namespace

Interrupted::Interrupted(std::int64_t done, std::int64_t count)
    : std::runtime_error(fmt::format("stopped when {} of {} experiments were done", done, count)) {}

Campaign run_campaign(Study study, const CampaignOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiment_count());
  require_options(options, study, count);

  const auto start = std::chrono::steady_clock::now();
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const bool threads = runs_in_threads(options);
  const SolverPlan solver{options.solver, options.solver == "auto" ? options.audit_share : 0.0};
  std::optional<ShardStore> shards;
  if (options.shards)
    shards.emplace(*options.shards, shard_identity(study, solver, options.store), count, options.on_warning);

  Campaign campaign;
  campaign.study = std::move(study);
  const std::int64_t done =
      shards ? count - static_cast<std::int64_t>(shards->missing().size()) : std::int64_t{0};
  campaign.basis = stoppable_basis_case(campaign.study, factory, options.stop, done, count);
  require_health(campaign.basis, options);
  const ExecutionPlan plan{campaign.study, campaign.basis, solver, options.store, {},
                           options.jobs,   options.stop};
  run_experiments(plan, threads, count, shards ? &*shards : nullptr, options).move_into(campaign);

  campaign.info.mpmbench_version = mpmbench_version();
  campaign.info.git_sha = source_revision();
  campaign.info.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  campaign.info.solver = options.solver;
  campaign.info.jobs = options.jobs;
  campaign.info.audit_share = solver.audit_share;
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() +
                          (shards ? shards->earlier_seconds() : 0.0);
  return campaign;
}

}  // namespace mpm
