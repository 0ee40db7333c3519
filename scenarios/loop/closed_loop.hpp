#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/plant.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/controller.hpp"

namespace mpm {

/// How hard the optimisation problems of a closed loop were, and how well they were solved.
struct SolverStatistics {
  std::int64_t steps = 0;
  std::int64_t iterations = 0;
  std::int64_t fallbacks = 0;         ///< problems whose answer is Ipopt's (CertifiedSolver)
  double largest_kkt_residual = 0.0;  ///< NaN if solutions have no certificate

  void add(const SolverStatistics& other);
};

/// What made a closed loop fail.
enum class LoopFailure {
  none,
  solver,           ///< the solver gave no answer
  plant,            ///< the plant could not be integrated
  no_steady_state,  ///< the plant cannot rest where the loop begins
  controller,       ///< the external controller program gave no move
};

template <>
inline constexpr auto kWords<LoopFailure> = word_list("none", "solver", "plant", "no_steady_state",
                                                      "controller");

/// The data of one closed loop; one row a variable, one column a sample.
///
/// | symbol   | member   | shape  | meaning                                      |
/// |----------|----------|--------|----------------------------------------------|
/// | y        | y        | ny x N | measured CVs, noise included; as analysers show them |
/// | u        | u        | nu x N | MVs, u(k) acts from sample k on              |
/// | u_target | u_target | nu x N | targets of the optimizer                     |
/// | d        | d        | nd x N | measured disturbances, d(k) acts from k on; as analysers show them |
/// | y_set    | y_set    | ny x N | setpoints; empty when no CV has one          |
///
/// They are what a historian of the loop records: for a valve that sticks or an MV with a disturbance, what
/// the controller asked for; for an MV that is held, the value at which it is held; for MDs, the
/// measurements.
struct Trajectory {
  ControlStatus status = ControlStatus::ok;
  Eigen::Index samples_done = 0;  ///< columns after these are zero when the status is not `ok`
  Eigen::MatrixXd y, u, u_target, d, y_set;
  /// The CVs at the times of the rows of the record, noise included; empty if these are the times of the
  /// samples.
  Eigen::MatrixXd y_sampled = {};
  SolverStatistics solver;
  LoopFailure failure = LoopFailure::none;  ///< not `none` if and only if the status is `failed`
  std::string message = {};                 ///< what failed, for people; empty when nothing did
};

/// Faults of a loop besides those in its signals: at most one of each sort, from its sample on.
struct LoopFaults {
  struct Valve {
    Eigen::Index mv;
    OtherFault fault;
    int sample;
  };
  struct Hold {
    Eigen::Index mv;
    int sample;
  };
  struct LimitShift {
    Eigen::Index cv;
    double shift;  ///< of both soft limits, CV unit
    int sample;
  };

  struct StuckSensor {
    Eigen::Index cv;
    int sample;
  };

  std::optional<Valve> valve = {};
  std::optional<StuckSensor> stuck = {};  ///< shows what it measured at this sample
  std::optional<Hold> hold = {};          ///< the MV stays where it is, and the record shows it
  std::optional<LimitShift> limit = {};
};

/// The signals that act on a loop from outside.
struct LoopSignals {
  Eigen::MatrixXd d;        ///< measured disturbances, nd x N
  Eigen::MatrixXd noise;    ///< added to the measurements, ny x N
  Eigen::MatrixXd y_d;      ///< unmeasured disturbances, added to the outputs, ny x N
  Eigen::MatrixXd y_set{};  ///< setpoints, ny x N; empty: they stay as they are at the start
  /// Unmeasured disturbances that act within the plant: its inputs after the MVs and MDs, one column a
  /// sample; column k acts from sample k on. Empty: they stay zero.
  Eigen::MatrixXd within_plant{};
  /// Test signals that are added to the moves of the controller, nu x N; empty: none.
  Eigen::MatrixXd dither{};
  Eigen::MatrixXd u_d{};         ///< added to the MVs on their way to the plant, nu x N; empty: nothing
  Eigen::MatrixXd d_measured{};  ///< MDs as they are measured, nd x N; empty: as `d`
  LoopFaults faults{};
  Eigen::VectorXd valve_curvature{};  ///< of each MV (WorldRanges), nu; empty: valves are linear
  /// What is added to the outputs of the plant at the times of the rows of the record, ny x N; empty: the
  /// loop has no such rows.
  Eigen::MatrixXd y_rows{};
};

/// Called after each step with the controller, whose two problems and answers it may look at.
using StepObserver = std::function<void(const Controller& controller)>;

/// Runs the controller of the study on `plant`, whose inputs are the MVs and then the MDs of the study. The
/// loop starts at the steady state of the nominal model at zero disturbances that
/// Controller::nominal_target() gives for the first setpoints. The soft limits are those of soft_limits() at
/// each sample.
///
/// `[[simulation.off]]` switches variables off, each from the sample of its table on. An MV that is off has
/// no dither; without a level it keeps its last value (Controller::set_off()).
///
/// The move of the controller plus the dither, within the hard limits of the MV, acts on the plant and is in
/// the record. The controller knows the dither, as in an announced plant test: its model gets the MVs that
/// act, but it plans without the dither.
///
/// Stops at the first sample whose problem is infeasible or cannot be solved, or over which the plant cannot
/// be integrated (status `failed`). Does not begin if the plant has no steady state at the start (`failed` as
/// well). Throws InputError if a signal does not have the shape that the study asks for, or if the plant has
/// another sample time, other outputs or fewer inputs.
///
/// A controller with a linear model works with deviations: pass a nonlinear plant as a DeviationPlant.
///
/// A `recorder` is the same plant, sampled as by the historian (record_plant()). It gets the inputs of the
/// plant; its outputs are the rows of the record, and the controller never sees them.
Trajectory run_closed_loop(const Study& study, Plant& plant, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer = {},
                           Plant* recorder = nullptr);

/// The same on the linear plant with these transfer functions.
Trajectory run_closed_loop(const Study& study, const TransferMatrix& plant, const LoopSignals& signals,
                           const QpSolverFactory& factory, const StepObserver& observer = {});

/// The plant of one experiment: the plant of its world, with the mismatches or changed parameters of the
/// experiment from the onset on.
std::unique_ptr<Plant> experiment_plant(const Study& study, const ExperimentDraw& draw);

/// The same plant with outputs at the times of the rows of the record, apart from shifts by whole samples;
/// null if the plant itself has these outputs.
std::unique_ptr<Plant> record_plant(const Study& study, const ExperimentDraw& draw);

/// The signals that act on the loop of one experiment, from (study, draw) alone; `y_d` includes the errors of
/// its sensors.
LoopSignals experiment_signals(const Study& study, const ExperimentDraw& draw);

/// The closed loop of one experiment: its controller, its plant and its signals, from (study, draw) alone.
Trajectory simulate_experiment(const Study& study, const ExperimentDraw& draw, const QpSolverFactory& factory,
                               const StepObserver& observer = {});

}  // namespace mpm
