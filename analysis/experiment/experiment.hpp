#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "analysis/basis/basis_case.hpp"
#include "analysis/indicators/diagnosis.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "analysis/sensitivity/s0_perturbation.hpp"
#include "scenarios/closed_loop.hpp"
#include "scenarios/draw.hpp"

namespace mpm {

enum class ExperimentStatus : std::int8_t {
  ok = 0,
  infeasible = 1,  ///< some MPC problem had no solution; the experiment is left out, as in the thesis
  failed = 2,      ///< the solver gave no answer, the plant could not be integrated or had no steady state to
                   ///< begin at, or the process that ran the experiment died
};

std::string_view to_string(ExperimentStatus status);
std::string_view to_string(ExperimentKind kind);
std::string_view to_string(MismatchParameter parameter);

/// Whose closed-loop data an archive keeps.
enum class StorePolicy { none, flagged, all };  // flagged: the experiments with a wrong verdict

/// The data of one closed loop as they are kept in an archive.
struct LoopRecord {
  Trajectory trajectory;
  Eigen::MatrixXd y_sim;  ///< ny x N
};

/// Everything that is known of one experiment.
///
/// In an experiment with mismatch and disturbance on one CV the loop is run three times: with both, with the
/// mismatch alone and with the disturbance alone. The diagnosis is that of the loop with both; the other two
/// give the dominance of the mismatch on the affected CV (6.23),
///     dominance_MPM = Ivar_diag^MPM / (Ivar_diag^MPM + Ivar_diag^UD).
///
/// In an experiment with a changed tuning the diagnosis takes the S0 of own_basis(), and an experiment whose
/// controller does not run on its own model is infeasible.
struct ExperimentRecord {
  ExperimentDraw draw;
  ExperimentStatus status = ExperimentStatus::failed;
  std::string message;  ///< why it failed; empty otherwise
  Diagnosis diagnosis;  ///< empty vectors unless the status is ok
  double ivar_diag_mpm_alone = std::numeric_limits<double>::quiet_NaN();
  double ivar_diag_ud_alone = std::numeric_limits<double>::quiet_NaN();
  double dominance_mpm = std::numeric_limits<double>::quiet_NaN();
  PerturbedIvar perturbed;  ///< of the affected CV when S0 is modified; empty when that is not asked for
  SolverStatistics solver;  ///< of all loops of the experiment
  std::optional<LoopRecord> loop;  ///< the loop that was diagnosed, when it was asked for

  /// The verdict is wrong: the experiment is impactful and the CV, or the source of a single fault, is not
  /// the true one, or there is no fault (healthy, or a bad tuning). Of a named scenario: a CV that is not
  /// affected is flagged, or an affected one is not, or has the wrong source (scenario_verdict()).
  bool wrong() const;
};

/// Runs experiments of one study; keeps workspaces between them. One a thread; results depend on the index
/// only.
class ExperimentRunner {
 public:
  /// `study` and `basis` must outlive the runner; the basis case must have status ok.
  ExperimentRunner(const Study& study, const BasisCase& basis, QpSolverFactory factory);

  /// Experiment `index`, with its loop record when the policy asks for it. `observer` sees each step of each
  /// of its loops.
  ExperimentRecord run(std::int64_t index, StorePolicy store, const StepObserver& observer = {});

 private:
  struct DiagnosedLoop {
    ExperimentStatus status;
    Diagnosis diagnosis;
    LoopRecord loop;
    std::string message;         ///< why it failed; empty otherwise
    SolverStatistics own_basis;  ///< of the loops that gave an S0 of its own
  };

  DiagnosedLoop run_loop(const ExperimentDraw& draw, const StepObserver& observer);

  const Study& study_;
  const BasisCase& basis_;
  QpSolverFactory factory_;
  NominalEstimator estimator_;
  DiagnosisChain chain_;
  S0Perturbation perturbation_;
};

}  // namespace mpm
