#include "analysis/basis/basis_case.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/draw.hpp"
#include "scenarios/study_controller.hpp"

namespace mpm {
namespace {

/// Ivar_basis (6.22) of the basis case with noise that no experiment has. A loop that does not run to its end
/// has none: NaN, outside of every band.
Eigen::VectorXd repeated_indices(const Study& study, const BasisCase& basis, const QpSolverFactory& factory) {
  ExperimentDraw again = basis_draw();
  again.index = kRepeatIndex;
  const Trajectory loop = simulate_experiment(study, again, factory);
  if (loop.status != ControlStatus::ok)
    return Eigen::VectorXd::Constant(study.cv_count(), kNaN);
  return basis_variance_indices(study, loop.y, basis.trajectory.y);
}

void check_health(const Study& study, const QpSolverFactory& factory, BasisCase& basis) {
  const DiagnosisOptions& options = study.diagnosis;
  if (basis.trajectory.failure == LoopFailure::plant || basis.trajectory.failure == LoopFailure::controller) {
    basis.explanation = fmt::format("the nominal loop fails at sample {}: {}", basis.trajectory.samples_done,
                                    basis.trajectory.message);
    return;
  }
  if (basis.trajectory.status != ControlStatus::ok) {
    basis.explanation =
        fmt::format("the nominal loop is {} at sample {}: its excitation is too strong for its limits",
                    to_string(basis.trajectory.status), basis.trajectory.samples_done);
    return;
  }
  if (options.self_check == SelfCheck::none) {
    basis.healthy = true;
    basis.explanation = "the study asks for no self-check of its basis case (diagnosis.self_check)";
    return;
  }
  const bool repeated = options.self_check == SelfCheck::repeat;
  const Eigen::VectorXd ivar = repeated ? repeated_indices(study, basis, factory) : basis.diagnosis.ivar;
  const std::string what =
      repeated ? "Ivar_basis of the nominal loop with other noise" : "Ivar of the nominal loop";
  std::string why = repeated ? "the record is too short to tell an impact from chance"
                             : "noise outweighs the excitation, and every verdict of this study would be "
                               "unreliable";
  if (!repeated && !study.simulation.is_excited())
    why += "; diagnosis.self_check = \"repeat\" is the check of a study without excitation";
  Eigen::Index worst = 0;
  (ivar.array() - 1.0).abs().maxCoeff(&worst);
  basis.healthy =
      (ivar.array() >= options.self_check_lower && ivar.array() <= options.self_check_upper).all();
  const std::string& name = study.plant.cvs[static_cast<std::size_t>(worst)].name;
  basis.explanation =
      basis.healthy ? fmt::format("{} lies within [{}, {}] for every CV; farthest from 1: {} with {:.3f}",
                                  what, options.self_check_lower, options.self_check_upper, name, ivar(worst))
                    : fmt::format("{} is {:.3f} for {}, outside [{}, {}]: {}", what, ivar(worst), name,
                                  options.self_check_lower, options.self_check_upper, why);
}

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

/// Without a fault, a plant that cannot rest where the loops begin is the study's.
void require_start(const Trajectory& loop) {
  if (loop.failure == LoopFailure::no_steady_state)
    throw InputError("the study's loop without a fault", loop.message,
                     "a plant with a steady state at the first setpoints and limits");
}

/// Of a controller that runs on the plant only there is no S0, and nothing that is made of it.
void refuse_without_sensitivity(const Study& study) {
  const std::string found = "a program that runs on the plant only (on_model is false)";
  if (study.diagnosis.self_check == SelfCheck::ivar)
    throw InputError("controller.program", found,
                     "with diagnosis.self_check = \"repeat\" or \"none\": Ivar of the nominal loop needs S0");
  if (!study.s0_perturbation.multipliers.empty())
    throw InputError("controller.program", found, "without s0_perturbation: there is no S0 to be modified");
}

/// The loop without a fault, and what is said of it.
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
  check_health(study, factory, basis);
}

}  // namespace

BasisCase run_basis_case(const Study& study, const QpSolverFactory& factory, const StepObserver& observer) {
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
  run_loop(study, factory, observer, basis);
  return basis;
}

}  // namespace mpm
