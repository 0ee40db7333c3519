#include "bench/commands/experiment_loop.hpp"

#include <optional>
#include <utility>

#include "analysis/basis/tuned_basis.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "bench/commands/common_options.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {

LoopRecord loop_of(const Campaign& campaign, const ExperimentRecord& record) {
  if (record.loop)
    return *record.loop;
  ExperimentRunner runner(campaign.study, campaign.basis, {}, qp_solver_factory(campaign.info.solver));
  return std::move(*runner.run(record.draw.index, StorePolicy::all).loop);
}

NominalOutputs nominal_of(const Campaign& campaign, const ExperimentRecord& record, const LoopRecord& loop) {
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const std::optional<TunedBasis> own = tuned_basis(campaign.study, record.draw, factory);
  const bool takes_own = own && own->basis.trajectory.status == ControlStatus::ok;
  const Study& study = takes_own ? own->study : campaign.study;
  const BasisCase& basis = takes_own ? own->basis : campaign.basis;
  return NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(loop.trajectory);
}

}  // namespace mpm
