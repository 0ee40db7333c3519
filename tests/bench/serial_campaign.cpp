#include "tests/bench/serial_campaign.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/basis/basis_runs.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/execution/experiment_work.hpp"
#include "scenarios/loop/calibration.hpp"
#include "solvers/qp_solver.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm::testing {

Campaign run_serially(Study study, const RunOptions& options) {
  Campaign campaign;
  campaign.study = study_to_run(std::move(study), options);
  campaign.methods = methods_of(campaign.study, "");
  const QpSolverFactory factory = qp_solver_factory(options.solver);
  campaign.basis = run_basis_case(campaign.study, factory);

  ExperimentWork work(campaign.study, campaign.study, campaign.basis, options, factory);
  const std::int64_t count = options.experiments.value_or(campaign.study.experiment_count());
  for (std::int64_t index = 0; index < count; ++index) {
    ExperimentOutcome outcome = work.run(index);
    work.audit(outcome);
    campaign.records.push_back(std::move(outcome.record));
    campaign.audit.insert(campaign.audit.end(), outcome.audited.begin(), outcome.audited.end());
  }
  if (!campaign.study.calibration)
    return campaign;
  const Study loops = calibration_study(campaign.study);
  const RunOptions calibrating = calibration_options(options);
  ExperimentWork calibration(loops, campaign.study, campaign.basis, calibrating, factory);
  std::vector<ExperimentRecord> records;
  for (std::int64_t index = 0; index < loops.experiment_count(); ++index)
    records.push_back(calibration.run(index).record);
  campaign.calibration = calibration_of(loops, records);
  return campaign;
}

}  // namespace mpm::testing
