#include "analysis/experiment/experiment.hpp"

#include <utility>

#include "analysis/basis/own_basis.hpp"
#include "analysis/experiment/scenario_verdict.hpp"

namespace mpm {
namespace {

ExperimentStatus experiment_status(ControlStatus status) {
  return status == ControlStatus::ok           ? ExperimentStatus::ok
         : status == ControlStatus::infeasible ? ExperimentStatus::infeasible
                                               : ExperimentStatus::failed;
}

}  // namespace

std::string_view to_string(ExperimentStatus status) {
  switch (status) {
    case ExperimentStatus::ok:
      return "ok";
    case ExperimentStatus::infeasible:
      return "infeasible";
    case ExperimentStatus::failed:
      return "failed";
  }
  return "unknown";
}

std::string_view to_string(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::none:
      return "none";
    case ExperimentKind::mpm:
      return "mpm";
    case ExperimentKind::ud:
      return "ud";
    case ExperimentKind::mpm_ud:
      return "mpm_ud";
    case ExperimentKind::tuning:
      return "tuning";
  }
  return "unknown";
}

std::string_view to_string(MismatchParameter parameter) {
  switch (parameter) {
    case MismatchParameter::gain:
      return "gain";
    case MismatchParameter::time_constant:
      return "time_constant";
    case MismatchParameter::dead_time:
      return "dead_time";
    case MismatchParameter::channel:
      return "channel";
  }
  return "unknown";
}

bool ExperimentRecord::wrong() const {
  if (status != ExperimentStatus::ok || (!draw.named && !diagnosis.impactful))
    return false;
  if (draw.named)
    return !scenario_verdict(*this).right();
  if (is_faultless(draw.kind))
    return true;
  const bool single_fault = draw.kind == ExperimentKind::mpm || draw.kind == ExperimentKind::ud;
  return diagnosis.predicted_cv != draw.true_cv() ||
         (single_fault && diagnosis.predicted_source != draw.kind);
}

ExperimentRunner::ExperimentRunner(const Study& study, const BasisCase& basis, QpSolverFactory factory)
    : study_(study),
      basis_(basis),
      factory_(std::move(factory)),
      estimator_(study, basis.point, basis.sensitivity, factory_),
      chain_(study),
      perturbation_(study, basis.sensitivity) {}

ExperimentRunner::DiagnosedLoop ExperimentRunner::run_loop(const ExperimentDraw& draw,
                                                           const StepObserver& observer) {
  DiagnosedLoop result;
  result.loop.trajectory = simulate_experiment(study_, draw, factory_, observer);
  const Trajectory& loop = result.loop.trajectory;
  result.status = experiment_status(loop.status);
  result.message = loop.message;
  if (result.status != ExperimentStatus::ok) {
    result.loop.y_sim = estimator_.simulated(loop);
    return result;
  }
  const std::optional<OwnBasis> own = own_basis(study_, draw, factory_);
  std::optional<NominalEstimator> own_estimator;
  if (own) {
    result.own_basis = own->solver;
    result.status = experiment_status(own->basis.trajectory.status);
    if (result.status != ExperimentStatus::ok) {
      if (result.status == ExperimentStatus::failed)
        result.message = "no S0 of its own: " + own->basis.explanation;
      result.loop.y_sim = estimator_.simulated(loop);
      return result;
    }
    own_estimator.emplace(own->study, own->basis.point, own->basis.sensitivity, factory_);
  }
  const NominalOutputs nominal = (own_estimator ? *own_estimator : estimator_).estimate(loop);
  result.loop.y_sim = nominal.y_sim;
  result.diagnosis = chain_.diagnose(loop.y, nominal, basis_.trajectory.y);
  if (draw.named)
    result.diagnosis.cvs = chain_.diagnose_each(loop.y, nominal, result.diagnosis.ivar_diag);
  return result;
}

ExperimentRecord ExperimentRunner::run(std::int64_t index, StorePolicy store, const StepObserver& observer) {
  ExperimentRecord record;
  record.draw = draw_experiment(study_, index);

  DiagnosedLoop main = run_loop(record.draw, observer);
  record.status = main.status;
  record.message = main.message;
  record.solver = main.loop.trajectory.solver;
  record.solver.add(main.own_basis);
  const Eigen::Index true_cv = record.draw.true_cv();
  if (record.draw.kind == ExperimentKind::mpm_ud && true_cv >= 0 && record.status == ExperimentStatus::ok) {
    const DiagnosedLoop mpm_alone = run_loop(record.draw.mismatch_alone(), observer);
    const DiagnosedLoop ud_alone = run_loop(record.draw.disturbance_alone(), observer);
    for (const DiagnosedLoop* part : {&mpm_alone, &ud_alone}) {
      record.solver.add(part->loop.trajectory.solver);
      record.status = std::max(record.status, part->status);
      if (record.message.empty())
        record.message = part->message;
    }
    if (record.status == ExperimentStatus::ok) {
      record.ivar_diag_mpm_alone = mpm_alone.diagnosis.ivar_diag(true_cv);
      record.ivar_diag_ud_alone = ud_alone.diagnosis.ivar_diag(true_cv);
      record.dominance_mpm =
          record.ivar_diag_mpm_alone / (record.ivar_diag_mpm_alone + record.ivar_diag_ud_alone);
    }
  }
  if (record.status == ExperimentStatus::ok) {
    record.diagnosis = std::move(main.diagnosis);
    if (true_cv >= 0)
      record.perturbed =
          perturbation_.ivar_diag(true_cv, Eigen::RowVectorXd(main.loop.trajectory.y.row(true_cv)),
                                  Eigen::RowVectorXd(main.loop.y_sim.row(true_cv)));
  }
  if (store == StorePolicy::all || (store == StorePolicy::flagged && record.wrong()))
    record.loop = std::move(main.loop);
  return record;
}

}  // namespace mpm
