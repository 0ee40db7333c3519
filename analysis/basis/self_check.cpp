#include "analysis/basis/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"

namespace mpm {
namespace {

// Shares of a step of the reference. The shipped studies keep to all three by a factor of 50 or more;
// rounding of the solver is far below the last one.
constexpr double kSettled = 0.02;      // largest change of T0 in the last tenth of its step response
constexpr double kGainError = 0.05;    // largest distance of its end from 1
constexpr double kStandsStill = 1e-6;  // root mean square of a CV that does not move

/// What is wrong with the step response of a CV to its own reference; empty: nothing.
std::string trouble_of_response(const Eigen::Ref<const Eigen::RowVectorXd>& own, bool reaches_reference) {
  const Eigen::Index samples = own.size();
  const Eigen::Index tail = std::min(samples, 1 + std::max<Eigen::Index>(1, samples / 10));
  const double gain = own(samples - 1);
  const double drift = (own.tail(tail).array() - gain).abs().maxCoeff();
  if (!(own.cwiseAbs().maxCoeff() > kStandsStill))
    return "is zero";
  if (samples < 2 || !(drift <= kSettled))
    return fmt::format("has not settled after {} samples: it moves by {:.2g} of the step in their last tenth",
                       samples, drift);
  if (reaches_reference && !(std::abs(gain - 1.0) <= kGainError))
    return fmt::format("ends at {:.3g} of the step of its reference after {} samples, but must end at 1",
                       gain, samples);
  return "";
}

std::string trouble_of_sensitivity(const Study& study, const BasisCase& basis) {
  const NominalSensitivity& T0 = basis.sensitivity;
  if (!T0.is_known)
    return "";
  if (T0.active.empty())
    return "T0 is zero: no CV is at a setpoint or at a limit (sensitivity.active_cvs names those that are)";
  // A controller that is a program may leave an offset.
  const bool reachable = !study.controller_program &&
                         std::ssize(T0.active) + std::ssize(basis.point.fixed_mvs) <= study.mv_count();
  for (std::size_t a = 0; a < T0.active.size(); ++a) {
    const Eigen::Index cv = T0.active[a].cv;
    const std::string trouble = trouble_of_response(T0.step_response[a].row(cv), reachable);
    if (!trouble.empty())
      return fmt::format("T0 of {} {}; try more sensitivity.samples or another sensitivity.step_size",
                         study.plant.cvs[static_cast<std::size_t>(cv)].name, trouble);
  }
  return "";
}

bool is_at_rest(const Study& study, const Trajectory& loop) {
  const Eigen::MatrixXd deviations = loop.y.colwise() - loop.y.rowwise().mean();
  const Eigen::VectorXd rms =
      (deviations.rowwise().squaredNorm() / static_cast<double>(loop.y.cols())).cwiseSqrt();
  return rms.maxCoeff() <= kStandsStill * study.sensitivity.step_size;
}

/// Ivar_basis (6.22) of the basis case with noise that no experiment has. If its loop does not run to its
/// end, they are NaN, which is outside of every band.
Eigen::VectorXd repeated_indices(const Study& study, const BasisCase& basis, const QpSolverFactory& factory) {
  ExperimentDraw again = basis_draw();
  again.index = kRepeatIndex;
  const Trajectory loop = simulate_experiment(study, again, factory);
  if (loop.status != ControlStatus::ok)
    return Eigen::VectorXd::Constant(study.cv_count(), kNaN);
  return basis_variance_indices(study, loop.y, basis.trajectory.y);
}

}  // namespace

void check_basis(const Study& study, const QpSolverFactory& factory, BasisCase& basis) {
  const DiagnosisOptions& options = study.diagnosis;
  if (basis.trajectory.failure == LoopFailure::plant || basis.trajectory.failure == LoopFailure::controller) {
    basis.explanation = fmt::format("the nominal loop fails at sample {}: {}", basis.trajectory.samples_done,
                                    basis.trajectory.message);
    return;
  }
  if (basis.trajectory.status != ControlStatus::ok) {
    basis.explanation =
        fmt::format("the nominal loop is {} at sample {}: the excitation is too strong for the limits",
                    to_string(basis.trajectory.status), basis.trajectory.samples_done);
    return;
  }
  if (options.self_check == SelfCheck::none) {
    basis.healthy = true;
    basis.explanation = "the study asks for no self-check of its basis case (diagnosis.self_check)";
    return;
  }
  basis.explanation = trouble_of_sensitivity(study, basis);
  if (basis.explanation.empty() && is_at_rest(study, basis.trajectory))
    basis.explanation = "the nominal loop stands still: without noise and excitation no index is meaningful";
  if (!basis.explanation.empty())
    return;
  const bool repeated = options.self_check == SelfCheck::repeat;
  const Eigen::VectorXd ivar = repeated ? repeated_indices(study, basis, factory) : basis.diagnosis.ivar;
  const std::string what =
      repeated ? "Ivar_basis of the nominal loop with other noise" : "Ivar of the nominal loop";
  std::string why =
      repeated ? "the record is too short to tell an impact from chance"
               : "noise outweighs the excitation, so every verdict of this study would be unreliable";
  if (!repeated && !study.simulation.is_excited())
    why += "; diagnosis.self_check = \"repeat\" is the check of a study without excitation";
  Eigen::Index worst = 0;
  (ivar.array() - 1.0).abs().maxCoeff<Eigen::PropagateNaN>(&worst);
  basis.healthy =
      (ivar.array() >= options.self_check_lower && ivar.array() <= options.self_check_upper).all();
  const std::string& name = study.plant.cvs[static_cast<std::size_t>(worst)].name;
  basis.explanation =
      basis.healthy ? fmt::format("{} lies within [{}, {}] for every CV; farthest from 1: {} with {:.3f}",
                                  what, options.self_check_lower, options.self_check_upper, name, ivar(worst))
      : std::isnan(ivar(worst)) ? fmt::format("{} cannot be computed for {}: {}", what, name, why)
                                : fmt::format("{} is {:.3f} for {}, outside [{}, {}]: {}", what, ivar(worst),
                                              name, options.self_check_lower, options.self_check_upper, why);
}

}  // namespace mpm
