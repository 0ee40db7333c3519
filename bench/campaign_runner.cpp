#include "bench/campaign_runner.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <tuple>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/experiment_execution.hpp"
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

void require_options(const CampaignOptions& options, std::int64_t count) {
  if (count < 1)
    throw InputError("experiments", fmt::format("{}", count), "a whole number >= 1");
  if (options.jobs < 1)
    throw InputError("jobs", fmt::format("{}", options.jobs), "a whole number >= 1");
  if (!(options.audit_share >= 0.0 && options.audit_share <= 1.0))
    throw InputError("audit share", fmt::format("{}", options.audit_share), "a number from 0 to 1");
}

bool earlier(const AuditedStep& one, const AuditedStep& other) {
  return std::tie(one.experiment, one.step) < std::tie(other.experiment, other.step);
}

}  // namespace

Campaign run_campaign(Study study, const CampaignOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiments.total());
  require_options(options, count);

  const auto start = std::chrono::steady_clock::now();
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  const bool threads = runs_in_threads(options);
  Campaign campaign;
  campaign.study = std::move(study);
  campaign.basis = run_basis_case(campaign.study, factory);
  require_health(campaign.basis, options);

  campaign.info.audit_share = options.solver == "auto" ? options.audit_share : 0.0;
  const ExecutionPlan plan{campaign.study, campaign.basis, {options.solver, campaign.info.audit_share},
                           options.store,  count,          options.jobs};
  campaign.records.resize(static_cast<std::size_t>(count));
  (threads ? execute_in_threads : execute_in_processes)(plan, [&](ExperimentOutcome outcome) {
    ExperimentRecord& record = campaign.records[static_cast<std::size_t>(outcome.record.draw.index)];
    record = std::move(outcome.record);
    campaign.audit.insert(campaign.audit.end(), outcome.audited.begin(), outcome.audited.end());
    campaign.info.audit_seconds += outcome.audit_seconds;
    if (options.on_done)
      options.on_done(record);
  });
  std::sort(campaign.audit.begin(), campaign.audit.end(), earlier);

  campaign.info.mpmbench_version = mpmbench_version();
  campaign.info.git_sha = source_revision();
  campaign.info.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  campaign.info.solver = options.solver;
  campaign.info.jobs = options.jobs;
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return campaign;
}

}  // namespace mpm
