#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"
#include "plants/linear/plant_model.hpp"
#include "plants/nonlinear/nonlinear_model.hpp"
#include "plants/nonlinear/ode_integrator.hpp"
#include "scenarios/controller/controller_program.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/fault_ranges.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/faults/tuning.hpp"
#include "scenarios/faults/world_ranges.hpp"
#include "scenarios/random/distribution.hpp"
#include "scenarios/study/assessment_options.hpp"
#include "scenarios/study/data_options.hpp"
#include "scenarios/study/record_options.hpp"
#include "scenarios/study/simulation_options.hpp"
#include "solvers/mpc_options.hpp"

namespace mpm {

/// How many experiments of each kind make one full study.
struct ExperimentCounts {
  int mpm = 0;
  int ud = 0;
  int mpm_ud = 0;
  int healthy = 0;  ///< nothing is wrong
  int tuning = 0;
  int other = 0;

  int total() const { return mpm + ud + mpm_ud + healthy + tuning + other; }
  int of(ExperimentKind kind) const {
    switch (kind) {
      case ExperimentKind::healthy:
        return healthy;
      case ExperimentKind::mpm:
        return mpm;
      case ExperimentKind::ud:
        return ud;
      case ExperimentKind::mpm_ud:
        return mpm_ud;
      case ExperimentKind::tuning:
        return tuning;
      case ExperimentKind::other:
        return other;
    }
    return 0;
  }

  bool operator==(const ExperimentCounts&) const = default;
};

/// Which way the active soft limit is stepped when T0 is determined. A range MPC answers the two differently:
/// a limit that moves into the range pushes the CV through the soft constraint, a limit that moves out of it
/// only lets the CV follow its target (docs/methods.md).
enum class StepDirection { into_range, out_of_range, mean };

/// The constraint set from which S0 is taken (3.3.3).
enum class SensitivityStructure {
  operating_point,  ///< the set of the basis case throughout
  by_instant,       ///< the set that is active at each sample, from the data
};

/// What is switched when the constraint set changes (analysis/sensitivity/nominal_estimator).
enum class SensitivitySwitching { output, input };

/// What T0 is: the step responses of the controller on its own model, or Box-Jenkins models identified in a
/// record of it (A3.1, A3.2).
enum class SensitivityForm { step_response, box_jenkins };

/// How T0 is determined (appendix A3).
struct SensitivityOptions {
  SensitivityForm form = SensitivityForm::step_response;
  int samples = 150;       ///< length of the step responses; the static gain holds after it
  double step_size = 0.1;  ///< of the active soft limit, in CV units
  StepDirection step_direction = StepDirection::out_of_range;
  /// CVs whose soft limit is taken as active, by index; empty: those that the basis case holds at a limit.
  std::vector<Eigen::Index> active_cvs;
  std::vector<Eigen::Index> fixed_mvs;  ///< MVs that are held while T0 is determined
  SensitivityStructure structure = SensitivityStructure::operating_point;
  SensitivitySwitching switching = SensitivitySwitching::output;

  bool operator==(const SensitivityOptions&) const = default;
};

/// Deliberate errors in S0, to see their effect ("Sensitivity of S0" in section 6.5.2).
struct S0PerturbationOptions {
  std::vector<double> multipliers;      ///< of time constant and damping in (6.24), ascending; empty: none
  std::vector<Eigen::Index> cvs;        ///< CVs whose experiments are used; empty: all at an active limit
  double tolerance_lower = 0.75;        ///< the method should tolerate all multipliers
  double tolerance_upper = 1.25;        ///< within [tolerance_lower, tolerance_upper]
  std::vector<Eigen::Index> fixed_mvs;  ///< MVs held in a second control structure; empty: there is none
  std::vector<Eigen::Index> fixed_active_cvs;  ///< CVs at an active soft limit in that structure

  bool operator==(const S0PerturbationOptions&) const = default;
};

/// How the distance of Ivar_diag from 1 is measured when the CV is located.
enum class LocationDistance { linear, logarithmic };

/// The point about which the variances of a CV with a setpoint are taken. For a CV in a range it is always
/// the mean.
enum class VarianceCentre { setpoint, mean };

/// The experiments over which the rates of I_MPM are counted.
enum class SourcePopulation { impactful, feasible };

/// What happens to loops that are not stable.
enum class UnstableLoops : std::int8_t {
  keep,
  exclude,  ///< they are left out, as infeasible ones are
};

/// How a study checks its basis case.
enum class SelfCheck {
  ivar,    ///< Ivar of the chain is in the band for every CV: what the verdicts of the thesis need
  repeat,  ///< so is Ivar_basis (6.22) of the basis case with other noise: what the truth of impact needs
  none,
};

/// The measure by which a fault has an impact in a world: the variance of a CV, or its cost in the controller
/// (cv_costs()). The cost of the whole loop counts with either.
enum class ImpactMeasure : std::int8_t { variance, cost };

template <>
inline constexpr auto kWords<ImpactMeasure> = word_list("variance", "cost");

/// The open choices of the diagnosis chain.
struct DiagnosisOptions {
  double impact_lower = 0.8;  ///< Ivar outside [impact_lower, impact_upper] is impactful
  double impact_upper = 1.2;
  ImpactMeasure impact = ImpactMeasure::variance;
  VarianceCentre variance_centre = VarianceCentre::setpoint;  ///< (3.24), (4.14); mean: (2.20)
  LocationDistance location_distance = LocationDistance::linear;
  double shortest_window = 0.5;  ///< of the moving windows, in prediction horizons
  double longest_window = 2.0;
  int window_stride = 1;  ///< samples between window lengths
  SourcePopulation source_population = SourcePopulation::impactful;
  UnstableLoops unstable = UnstableLoops::keep;
  SelfCheck self_check = SelfCheck::ivar;
  double self_check_lower = 0.8;  ///< the index of the self-check must lie in this band for every CV
  double self_check_upper = 1.2;

  /// Does this Ivar lie outside the band of impact? False for NaN.
  bool has_impact(double ivar) const { return ivar < impact_lower || ivar > impact_upper; }

  bool operator==(const DiagnosisOptions&) const = default;
};

/// How aggregates get their intervals.
struct AggregateOptions {
  double confidence = 0.95;
  int bootstrap_replications = 2000;

  bool operator==(const AggregateOptions&) const = default;
};

/// The loops on which the thresholds of the methods are calibrated: loops without a fault, and with a
/// disturbance alone, drawn under another seed (scenarios/loop/calibration.hpp).
struct CalibrationOptions {
  double false_alarms = 0.05;              ///< share of healthy loops that a calibrated threshold may flag
  int healthy = 200;                       ///< loops without a fault
  int ud = 100;                            ///< loops with an unmeasured disturbance alone
  std::optional<std::uint64_t> seed = {};  ///< none: derived from that of the study
  std::optional<int> worlds = {};          ///< number of worlds; none: as many as in the study

  bool operator==(const CalibrationOptions&) const = default;
};

/// How methods watch a loop while it runs: each assesses the last `window` samples, every `stride` samples.
struct MonitoringOptions {
  int window = 200;  ///< samples
  int stride = 50;   ///< samples from one window to the next

  /// Number of windows in a record.
  int count(int samples) const { return (samples - window) / stride + 1; }
  /// First sample of a window, and the one after its last.
  int begin(int number) const { return number * stride; }
  int end(int number) const { return begin(number) + window; }

  bool operator==(const MonitoringOptions&) const = default;
};

/// A published number for this study. `name` is the finding beside which it is shown.
struct ReportedValue {
  std::string name;
  double value;
  std::int64_t of = 0;     ///< experiments behind a share; 0: not known
  std::string where = {};  ///< "FILE:LINE: KEY", for an error message; not compared

  bool operator==(const ReportedValue& other) const {
    return name == other.name && value == other.value && of == other.of;
  }
};

/// The nonlinear plant that is simulated instead of the linear model; the controller and y_sim still use the
/// linear model.
struct NonlinearSimulation {
  NonlinearModel model;
  OdeOptions integration;

  bool operator==(const NonlinearSimulation&) const = default;
};

/// A whole study as read from its file: every number that decides its result.
struct Study {
  std::string name;
  std::string title;
  std::uint64_t seed = 0;
  PlantModel plant;                              ///< the nominal model G0
  std::optional<NonlinearSimulation> nonlinear;  ///< none: the plant is linear as well
  MpcOptions controller;
  std::optional<ControllerProgram> controller_program;  ///< none: the controller is the built-in one
  SimulationOptions simulation;
  RecordOptions record;
  ExperimentCounts experiments;     ///< of random experiments; all 0 in a study of named scenarios
  std::vector<Scenario> scenarios;  ///< the experiments of a study of named scenarios, in their order
  MismatchRanges mismatch;
  DisturbanceRanges disturbance;
  TuningRanges tuning;
  OtherRanges other;
  OnsetRanges onset;
  std::optional<WorldRanges> world;  ///< none: the model is exact except for the faults
  SensitivityOptions sensitivity;
  S0PerturbationOptions s0_perturbation;
  DiagnosisOptions diagnosis;
  std::vector<std::string> methods{"botelho"};    ///< of assessment, by name; "all" alone: every one
  AssessmentOptions assessment;                   ///< options of the methods
  std::optional<MonitoringOptions> monitoring;    ///< none: methods see whole records only
  std::optional<CalibrationOptions> calibration;  ///< none: methods have only their own thresholds
  AggregateOptions aggregate;
  DataOptions data;                     ///< how a file of records of its loop is read
  std::vector<ReportedValue> reported;  ///< shown beside the results, never used to make them
  std::string source;                   ///< the full text of the file

  bool names_scenarios() const { return !scenarios.empty(); }
  /// True when every random experiment has at most one changed parameter of one channel and white noise on
  /// one CV, from the start and as drawn, so that a few numbers describe it.
  bool has_plain_faults() const;
  /// True when sizes of faults are scaled until the loops have the effect that the study asks for.
  bool asks_for_impact() const { return mismatch.impact || disturbance.impact || other.impact; }
  /// Experiments of one full run.
  int experiment_count() const {
    return names_scenarios() ? static_cast<int>(scenarios.size()) : experiments.total();
  }
  /// A channel of the model as methods of assessment see it (assessed_model()).
  TransferFunction assessed_channel(Eigen::Index cv, Eigen::Index input) const;
  /// G0, with every channel of an integrating CV behind a washout, so that y_sim and y - y_sim do not drift
  /// without end, as they would in an open-loop simulation of G0.
  TransferMatrix assessed_model() const;
  /// Time constant of that washout.
  double washout() const;

  Eigen::Index cv_count() const { return static_cast<Eigen::Index>(plant.cvs.size()); }
  Eigen::Index mv_count() const { return static_cast<Eigen::Index>(plant.mvs.size()); }
  Eigen::Index md_count() const { return static_cast<Eigen::Index>(plant.mds.size()); }

  bool operator==(const Study&) const = default;
};

}  // namespace mpm
