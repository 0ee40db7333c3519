#include "analysis/basis/basis_runs.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/basis/self_check.hpp"
#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "base/error.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study_controller.hpp"

namespace mpm {
namespace {

/// A CV without an active limit has T0 = 0, which no multiplier changes.
void require_active(const Study& study, const NominalSensitivity& sensitivity) {
  for (const Eigen::Index cv : study.s0_perturbation.cvs)
    if (std::none_of(sensitivity.active.begin(), sensitivity.active.end(),
                     [cv](const ActiveConstraint& reference) { return reference.cv == cv; }))
      throw InputError("s0_perturbation.cvs",
                       fmt::format("'{}', which is at no setpoint and no soft limit",
                                   study.plant.cvs[static_cast<std::size_t>(cv)].name),
                       "CVs at a setpoint or an active soft limit");
}

/// If a plant without a fault cannot rest where the loops begin, the study is wrong.
void require_start(const Trajectory& loop) {
  if (loop.failure == LoopFailure::no_steady_state)
    throw InputError("the study's loop without a fault", loop.message,
                     "a plant with a steady state at the first setpoints and limits");
}

/// A controller that runs on the plant only has no S0: the study must not ask for what needs one.
void refuse_without_sensitivity(const Study& study) {
  const std::string found = "a program that cannot run on its model (on_model is false)";
  if (study.diagnosis.self_check == SelfCheck::ivar)
    throw InputError("controller.program", found,
                     "with diagnosis.self_check = \"repeat\" or \"none\": Ivar of the nominal loop needs S0");
  if (!study.s0_perturbation.multipliers.empty())
    throw InputError("controller.program", found, "without s0_perturbation: there is no S0 to be modified");
}

/// Runs the loop without a fault, and diagnoses and checks it.
void run_loop(const Study& study, const QpSolverFactory& factory, const StepObserver& observer,
              BasisCase& basis) {
  basis.trajectory = simulate_experiment(study, basis_draw(), factory, observer);
  require_start(basis.trajectory);
  if (basis.trajectory.status == ControlStatus::ok) {
    basis.nominal =
        NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(basis.trajectory);
    if (basis.sensitivity.is_known)
      basis.diagnosis = DiagnosisChain(study).diagnose(basis.trajectory.y, basis.nominal);
  }
  check_basis(study, factory, basis);
}

}  // namespace

BasisCase run_basis_case(const Study& study, const QpSolverFactory& factory, const StepObserver& observer) {
  if (study.simulation.excitation == SignalSequence::each)
    return run_basis_case(with_excitation(study, kBasisIndex), factory, observer);
  BasisCase basis;
  basis.point = operating_point(study, factory);
  if (!runs_on_model(study)) {
    refuse_without_sensitivity(study);
    basis.point.active.clear();
    basis.sensitivity = {.cv_count = study.cv_count(), .active = {}, .step_response = {}, .is_known = false};
    run_loop(study, factory, observer, basis);
    return basis;
  }
  const bool identified = study.sensitivity.form == SensitivityForm::box_jenkins;
  const auto sensitivity = identified ? box_jenkins_sensitivity : nominal_sensitivity;
  basis.sensitivity = sensitivity(study, basis.point, factory, observer);
  if (identified)
    basis.sensitivity_direct = nominal_sensitivity(study, basis.point, factory, observer);
  require_active(study, basis.sensitivity);
  if (!study.s0_perturbation.fixed_mvs.empty())
    basis.sensitivity_fixed = sensitivity(study, with_fixed_mvs(study, basis.point), factory, observer);
  basis.trajectory = simulate_experiment(study, basis_draw(), factory, observer);
  require_start(basis.trajectory);
  if (basis.trajectory.status == ControlStatus::ok) {
    basis.nominal =
        NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(basis.trajectory);
    DiagnosisChain chain(study);
    basis.diagnosis = chain.diagnose(basis.trajectory.y, basis.nominal);
  }
  check_basis(study, factory, basis);
  return basis;
}

BasisCase world_basis(const Study& study, const BasisCase& basis, int world, const QpSolverFactory& factory) {
  BasisCase own = basis;
  own.world = world;
  own.trajectory = simulate_experiment(study, basis_draw(world), factory);
  if (own.trajectory.status != ControlStatus::ok) {
    own.healthy = false;
    own.explanation = fmt::format("the benchmark of world {} does not run to its end", world);
    return own;
  }
  own.nominal = NominalEstimator(study, own.point, own.sensitivity, factory).estimate(own.trajectory);
  return own;
}

}  // namespace mpm
