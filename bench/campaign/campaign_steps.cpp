#include "bench/campaign/campaign_steps.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "bench/files/outside_files.hpp"
#include "bench/version.hpp"

namespace mpm {
namespace {

void require_health(const BasisCase& basis, const RunOptions& options) {
  if (basis.healthy || (options.allow_unhealthy_basis && basis.trajectory.status == ControlStatus::ok))
    return;
  throw UnhealthyBasis("the basis case of the study fails its self-check: " + basis.explanation);
}

}  // namespace

std::int64_t experiment_count(const Study& study, const RunOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiment_count());
  if (study.names_scenarios() && count > study.experiment_count())
    throw InputError("experiments", fmt::format("{}", count),
                     fmt::format("at most {}, the named scenarios of the study", study.experiment_count()));
  if (count < 1)
    throw InputError("experiments", fmt::format("{}", count), "a whole number >= 1");
  return count;
}

BasisCase checked_basis(const Study& study, const RunOptions& options, const CampaignHooks& hooks,
                        const ExperimentTally& tally) {
  BasisCase basis = run_basis_case(study, qp_solver_factory(options.solver), [&](const Controller&) {
    if (requested(hooks.stop))
      throw Interrupted(tally.done, tally.count);
  });
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

}  // namespace mpm
