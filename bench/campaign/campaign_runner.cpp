#include "bench/campaign/campaign_runner.hpp"

#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/campaign/calibration_runs.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/campaign/experiment_series.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/version.hpp"
#include "scenarios/calibration.hpp"

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

/// In processes also where somebody else simulates the plant or is the controller: such loops wait for other
/// processes, and these are made without other threads at work. Throws InputError for threads that the solver
/// does not bear.
Execution execution_of(const Study& study, const RunOptions& options) {
  const bool safe = options.solver == "auto" || options.solver == "active-set";
  if (options.parallel == Parallel::threads && !safe)
    throw InputError("parallel", fmt::format("threads for the solver {}", options.solver),
                     "processes, or one of the solvers auto and active-set");
  const bool foreign = (study.nonlinear && study.nonlinear->model.foreign) || study.controller_program;
  const bool in_threads =
      options.parallel == Parallel::by_solver ? safe && !foreign : options.parallel == Parallel::threads;
  return in_threads ? execute_in_threads : execute_in_processes;
}

/// The basis case; with Ipopt it takes as long as an experiment, so that a stop must not wait for it.
BasisCase stoppable_basis_case(const Study& study, const QpSolverFactory& factory, const StopRequest& stop,
                               const ExperimentTally& tally) {
  return run_basis_case(study, factory, [&](const Controller&) {
    if (requested(stop))
      throw Interrupted(tally.done, tally.count);
  });
}

/// How, when and by which program; without the times.
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

/// The calibration loops of a campaign.
struct CalibrationSeries {
  Study study;
  ExperimentSeries series;

  CalibrationSeries(const Study& of, const RunOptions& options,
                    const std::optional<std::filesystem::path>& shards, const ShardStore::Warn& warn)
      : study(calibration_study(of)),
        series(study, calibration_options(options), study.experiment_count(),
               shards ? std::optional(calibration_shard_folder(*shards)) : std::nullopt, warn) {}

  Calibration run(const BasisCase& basis, Execution execute, const CampaignHooks& hooks,
                  ExperimentTally& tally) {
    Campaign loops;
    series.run(basis, execute, hooks, tally).move_into(loops);
    return calibration_of(study, loops.records);
  }
};

}  // namespace

Campaign run_campaign(Study study, const RunOptions& options, const CampaignHooks& hooks,
                      const std::optional<std::filesystem::path>& shard_folder) {
  const auto start = std::chrono::steady_clock::now();
  Campaign campaign;
  campaign.study = study_to_run(std::move(study), options);
  const std::int64_t count = options.experiments.value_or(campaign.study.experiment_count());
  require_options(options, campaign.study, count);
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const Execution execute = execution_of(campaign.study, options);

  ExperimentSeries experiments(campaign.study, options, count, shard_folder, hooks.on_warning);
  std::optional<CalibrationSeries> calibration;
  if (campaign.study.calibration)
    calibration.emplace(campaign.study, options, shard_folder, hooks.on_warning);
  ExperimentTally tally = experiments.tally();
  if (calibration)
    tally += calibration->series.tally();
  campaign.basis = stoppable_basis_case(campaign.study, factory, hooks.stop, tally);
  if (hooks.on_basis)
    hooks.on_basis(campaign.study, campaign.basis);
  require_health(campaign.basis, options);
  if (hooks.on_start)
    hooks.on_start(tally.done, tally.count);
  OutcomeCollection outcomes = experiments.run(campaign.basis, execute, hooks, tally);
  if (calibration)
    campaign.calibration = calibration->run(campaign.basis, execute, hooks, tally);

  campaign.info = info_of(campaign.study, options);
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() +
                          experiments.earlier_seconds() +
                          (calibration ? calibration->series.earlier_seconds() : 0.0);
  campaign.methods = methods_of(campaign.study, "");
  outcomes.move_into(campaign);
  if (hooks.on_end)
    hooks.on_end(campaign);
  return campaign;
}

}  // namespace mpm
