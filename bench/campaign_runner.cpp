#include "bench/campaign_runner.hpp"

#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/record_bytes.hpp"
#include "bench/version.hpp"
#include "bench/worker_pool.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

void require_health(const BasisCase& basis, const CampaignOptions& options) {
  if (basis.healthy || (options.allow_unhealthy_basis && basis.trajectory.status == ControlStatus::ok))
    return;
  throw UnhealthyBasis("the basis case of the study fails its self-check: " + basis.explanation);
}

ExperimentRecord lost_record(const Study& study, std::int64_t index, std::string why) {
  ExperimentRecord record;
  record.draw = draw_experiment(study, index);
  record.status = ExperimentStatus::failed;
  record.message = std::move(why);
  return record;
}

}  // namespace

Campaign run_campaign(Study study, const CampaignOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiments.total());
  if (count < 1)
    throw InputError("experiments", fmt::format("{}", count), "a whole number >= 1");
  if (options.jobs < 1)
    throw InputError("jobs", fmt::format("{}", options.jobs), "a whole number >= 1");

  const auto start = std::chrono::steady_clock::now();
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  Campaign campaign;
  campaign.study = std::move(study);
  campaign.basis = run_basis_case(campaign.study, factory);
  require_health(campaign.basis, options);

  ExperimentRunner runner(campaign.study, campaign.basis, factory);
  campaign.records.resize(static_cast<std::size_t>(count));
  run_in_workers(
      count, options.jobs, [&](std::int64_t index) { return to_bytes(runner.run(index, options.store)); },
      [&](TaskResult result) {
        ExperimentRecord& record = campaign.records[static_cast<std::size_t>(result.index)];
        record = result.crashed ? lost_record(campaign.study, result.index, std::move(result.bytes))
                                : record_from_bytes(result.bytes);
        if (options.on_done)
          options.on_done(record);
      });

  campaign.info.mpmbench_version = mpmbench_version();
  campaign.info.git_sha = source_revision();
  campaign.info.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  campaign.info.solver = options.solver;
  campaign.info.jobs = options.jobs;
  campaign.info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return campaign;
}

}  // namespace mpm
