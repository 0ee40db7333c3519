#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/basis_case.hpp"
#include "base/derived_values.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The records of one closed loop as a method sees them: the record of the historian, and the response of the
/// nominal model to it.
///
/// | symbol | member | shape  | meaning                                                       |
/// |--------|--------|--------|---------------------------------------------------------------|
/// | y      | y      | ny x N | measured CVs; NaN where a sample is missing, or where the     |
/// |        |        |        | analyser of the CV took none: analyses stand where the        |
/// |        |        |        | stream was sampled, not where they became known               |
/// | u      | u      | nu x N | MVs, u(k) acts from sample k on                               |
/// | u_target | u_target | nu x N | targets of the optimizer; of a record without targets the |
/// |        |        |        | operating point                                               |
/// | d      | d      | nd x N | measured disturbances, d(k) acts from sample k on             |
/// | y_sim  | y_sim  | ny x N | G0 (u, d)                                              (6.4)  |
/// | y_set  | y_set  | ny x N | setpoints; NaN for a CV without one, see AssessmentSetpoints  |
///
/// The simulated output y_sim of a CV that integrates would drift without end because of unknown inputs, and
/// y drifts with its inputs. For such a CV y, y_sim and y_set stand here behind the washout of
/// Study::assessed_model(), so that the part of y that y_sim does not explain stays bounded. from_washout()
/// undoes the washout.
///
/// For a moving window these are the samples of the window, and `whole` is the record. A method that filters
/// or simulates the loop starts at the beginning of the record (from_start()), where the loop was at its
/// operating point, and judges only the samples of the window.
struct AssessedLoop {
  Eigen::MatrixXd y, u, u_target, d, y_sim, y_set;
  /// Further signals of the historian that are not in the model, one row each; 0 x 0 if there are none.
  Eigen::MatrixXd candidates = {};
  /// For each CV the directions of y - y_sim that a plant record leaves open, c x N: a constant, and the
  /// initial memory of its model; orthogonal, with a mean square of 1. y_sim already contains the part of the
  /// errors along these directions, fitted by least squares. Empty: none.
  std::vector<Eigen::MatrixXd> untold = {};
  const AssessedLoop* whole = nullptr;  ///< the record of this window; null: this is a whole record
  Eigen::Index first = 0;               ///< sample of that record at which the window begins
  /// What several methods derive from these records under one context (nominal loops, corrections, answers of
  /// other methods). It is computed once while a panel assesses the loop (MethodPanel).
  DerivedValues derived = {};

  const AssessedLoop& from_start() const { return whole ? *whole : *this; }
  /// The window's columns of a signal of the record, one column for each sample.
  auto in_window(const Eigen::MatrixXd& signal) const { return signal.middleCols(first, samples()); }

  /// Is this the record of a plant, whose noise nobody has stated?
  bool has_unknown_noise() const { return !from_start().untold.empty(); }

  Eigen::Index samples() const { return y.cols(); }
  bool has_setpoint(Eigen::Index cv) const;
  /// The CVs with a setpoint, in their order.
  std::vector<Eigen::Index> setpoint_cvs() const;
};

/// A loop of `study` as the methods see it. Its records `loop` (recorded()) must start at the operating point
/// `point`, and the loop must have run to its end. The setpoint of a CV in a range is
/// optimizer_steady_state() if `study.assessment.setpoints` is AssessmentSetpoints::optimizer and the
/// controller has targets; otherwise NaN.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const Trajectory& loop);

/// Puts the rows of `signals` (ny x N) of CVs that integrate behind their washout, which starts at the first
/// value of the row.
Eigen::MatrixXd behind_washout(const Study& study, Eigen::MatrixXd signals);

/// The CVs that integrate as they were before the washout, minus their start. The gaps (NaN) of all `signals`
/// are closed.
Eigen::MatrixXd from_washout(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& signals);

/// Samples until the slowest channel of the model has settled (settling_time()).
Eigen::Index slowest_settling(const Study& study);

/// The number of samples at the start of a plant record that only initialise the model: 0 for a record that
/// begins at rest at the operating point, otherwise the settling time of the slowest channel. With
/// RecordStart::automatic a record begins at rest if each MV and MD begins within half of its standard
/// deviation of the operating point.
Eigen::Index samples_to_settle(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                               RecordStart start);

/// A plant record, from recorded_study(), as the methods see it. The first `unjudged` samples of the CVs are
/// missing. Before the record the model rests at the first values of the MVs and MDs if `unjudged` is above
/// 0, otherwise at the operating point. y_sim and the targets are those of the record if it has them.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                           Eigen::Index unjudged);

/// The window of `samples` samples of a record from sample `first` on. `record` must outlive it.
AssessedLoop window_of(const AssessedLoop& record, Eigen::Index first, Eigen::Index samples);

/// The sample from which an analysis is held: the one at which it was taken, or the one at which it was
/// shown.
enum class AnalysesHeld { from_taken, from_shown };

/// `record` if `loop` is a whole record; if `loop` is a window, the same window of `record`, which keeps the
/// record alive. `record` must come from the record of `loop`, sample by sample. The result keeps
/// derived values.
std::shared_ptr<AssessedLoop> same_window(const AssessedLoop& loop, AssessedLoop record);

/// The loop in which each analysis of a CV with an analyser, and y_sim at the sample of the analysis, is held
/// until the next analysis, so that an exact model has no errors between analyses. NaN where an analysis is
/// missing. The result is a value derived from `loop`.
std::shared_ptr<const AssessedLoop> with_analyses_held(const Study& study, const AssessedLoop& loop,
                                                       AnalysesHeld from);

/// What is known about the errors of the model while nothing is wrong.
class ModelCorrection {
 public:
  ModelCorrection() = default;
  ModelCorrection(const ModelCorrection&) = default;
  ModelCorrection& operator=(const ModelCorrection&) = default;
  virtual ~ModelCorrection() = default;

  /// The loop in which y_sim includes the part of y - y_sim that these errors explain: what remains is new.
  /// The result is a value derived from `loop`.
  virtual std::shared_ptr<const AssessedLoop> corrected(const AssessedLoop& loop) const = 0;
};

/// What a method may know besides the records of the loop. `study` and `basis` must outlive it. `derived`
/// holds what methods compute once for all loops under this context. `of_benchmark` holds what they compute
/// from benchmark, correction and model alone; contexts of other excitations share it. A context with a
/// changed benchmark or correction needs a new one. Both keep their values only in a panel (MethodPanel).
struct AssessmentContext {
  const Study& study;      ///< the nominal model, the controller and the options of the methods
  const BasisCase& basis;  ///< the operating point and T0
  QpSolverFactory factory;
  /// A period in which the controller worked as designed; none if no such period is known.
  std::optional<AssessedLoop> benchmark = {};
  /// The study of the benchmark loop, if its excitation is different; null: `study`.
  std::shared_ptr<const Study> benchmark_study = {};
  /// The errors of the model that the benchmark shows; null: the model is taken to be exact.
  std::shared_ptr<const ModelCorrection> correction = {};
  std::shared_ptr<const DerivedValues> of_benchmark = std::make_shared<const DerivedValues>();
  DerivedValues derived = {};

  const Study& study_of_benchmark() const { return benchmark_study ? *benchmark_study : study; }
};

/// The largest value with which methods can compute: sums of its fourth power are still finite.
inline constexpr double kLargestValue = 1e60;

/// "y1 of 1e+160 at sample 3": the first value of a record of the loop, from its start on, that is not finite
/// or beyond kLargestValue; none if there is no such value. CVs, targets, setpoints and candidates may be
/// missing (NaN).
std::optional<std::string> out_of_proportion(const Study& study, const AssessedLoop& loop);

/// The CVs of the basis case as the historian keeps them, ny x N; a method sees no other CVs of it.
Eigen::MatrixXd recorded_basis(const AssessmentContext& context);

}  // namespace mpm
