#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/fault_cost.hpp"
#include "analysis/experiment/loop_conditions.hpp"
#include "analysis/experiment/repair_gain.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/sensitivity/s0_perturbation.hpp"
#include "base/enum_words.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"

namespace mpm {

enum class ExperimentStatus : std::int8_t {
  ok = 0,
  infeasible = 1,  ///< some MPC problem had no solution; the experiment is left out, as in the thesis
  failed = 2,      ///< the solver gave no answer, the plant could not be integrated or had no steady state to
                   ///< begin at, or the process that ran the experiment died
  unstable = 3,  ///< the loop is not stable, with its fault or in its world without it, and the study leaves
                 ///< such loops out (UnstableLoops)
};

template <>
inline constexpr auto kWords<ExperimentStatus> = word_list("ok", "infeasible", "failed", "unstable");

/// The loops whose data an archive keeps: none, those with a wrong verdict of the first method, all, or all
/// with their LoopTruth.
enum class StorePolicy { none, flagged, all, truth };

/// The data of one closed loop as they are kept in an archive.
struct LoopRecord {
  Trajectory trajectory;
  Eigen::MatrixXd y_sim;  ///< ny x N
};

/// What only a simulation knows about a loop, y = G(u, d) + y_d + v with the plant G: no method sees it.
struct LoopTruth {
  /// A loop with only one of two faults; empty in an experiment with one fault or none, and if the loop with
  /// both does not run to its end.
  struct Alone {
    Eigen::MatrixXd y, u;  ///< ny x N and nu x N, as in Trajectory
  };

  Eigen::MatrixXd v;    ///< measurement noise, ny x N
  Eigen::MatrixXd y_d;  ///< sum of the unmeasured disturbances and errors of sensors on the CVs, ny x N
  Alone mpm_alone = {}, ud_alone = {};
};

/// Everything about one experiment: the draw, how it ended, the truth, and the answer of each method of the
/// study.
///
/// In an experiment with mismatch and disturbance on one CV the loop is run three times: with both, with the
/// mismatch alone and with the disturbance alone. The methods see the loop with both; from the other two the
/// chain of the thesis says how much the mismatch dominates (FaultsAlone).
///
/// If the tuning is changed, the methods know the S0 of tuned_basis(). If the controller then does not run on
/// its own model, the experiment is infeasible.
struct ExperimentRecord {
  ExperimentDraw draw;
  ExperimentStatus status = ExperimentStatus::failed;
  std::string message;        ///< why it failed, or that its world is not stable; empty otherwise
  LoopConditions conditions;  ///< of the loop that was assessed
  /// basis_variance_indices() or, in a world, FaultCost::variance_ratio, ny; empty unless the status is ok.
  Eigen::VectorXd ivar_basis;
  std::optional<FaultCost> cost = {};         ///< of the faults; only in a world, with status ok
  RepairGains repair = {};                    ///< of the channels, in a world; empty: not computed
  std::vector<AssessmentRecord> assessments;  ///< by each method of the study, in their order
  PerturbedIvar perturbed;  ///< of the affected CV under a modified S0; empty if this is not asked for, or if
                            ///< its record has gaps
  SolverStatistics solver;  ///< of all loops of the experiment
  /// The assessed loop as it was measured, if it was requested. recorded() gives the loop that the methods
  /// saw.
  std::optional<LoopRecord> loop;
  std::optional<LoopTruth> truth = {};  ///< of that loop, if it was requested

  /// The answer of the method of this name; null if it is not one of the study.
  const AssessmentRecord* by(std::string_view method) const;
  /// The answer of the method that diagnoses (diagnoses()); null if the study has none.
  const AssessmentRecord* diagnosed() const;
  /// The same; an answer without a form if the study has none.
  const AssessmentRecord& chain() const;
};

}  // namespace mpm
