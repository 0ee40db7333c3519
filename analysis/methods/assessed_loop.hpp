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
/// |        |        |        | stream was sampled, not where they were known                 |
/// | u      | u      | nu x N | MVs, u(k) acts from sample k on                               |
/// | u_target | u_target | nu x N | targets of the optimizer; zero without one               |
/// | d      | d      | nd x N | measured disturbances, d(k) acts from sample k on             |
/// | y_sim  | y_sim  | ny x N | G0 (u, d)                                              (6.4)  |
/// | y_set  | y_set  | ny x N | setpoints; NaN for a CV without one, see AssessmentSetpoints  |
///
/// Of a CV that integrates y_sim drifts without end under what is not known of its inputs, and y wanders with
/// them: y, y_sim and y_set stand here behind the washout of Study::assessed_model(), so that all that y_sim
/// does not explain stays where it is. from_washout() undoes it.
///
/// For a moving window these are the samples of the window, and `whole` is the record. A method that filters
/// or simulates the loop starts at the beginning of the record (from_start()), where the loop was at its
/// operating point, and judges the samples of the window only.
struct AssessedLoop {
  Eigen::MatrixXd y, u, u_target, d, y_sim, y_set;
  /// Further signals of the historian that are not in the model, one row each; 0 x 0 without any.
  Eigen::MatrixXd candidates = {};
  /// For each CV the directions of y - y_sim that the record of a plant leaves open, c x N: a constant, and
  /// the initial memory of its model; orthogonal, with a mean square of 1. y_sim contains them by least
  /// squares. Empty: none.
  std::vector<Eigen::MatrixXd> untold = {};
  const AssessedLoop* whole = nullptr;  ///< the record that this is a window of; null: it is whole
  Eigen::Index first = 0;               ///< sample of it at which the window begins
  /// What several methods make of these records under one context (nominal loops, corrections, answers of
  /// other methods) is made once while a panel assesses the loop (MethodPanel).
  DerivedValues derived = {};

  const AssessedLoop& from_start() const { return whole ? *whole : *this; }
  /// The window's columns of a signal of the record, one column for each sample.
  auto in_window(const Eigen::MatrixXd& signal) const { return signal.middleCols(first, samples()); }

  /// Is it the record of a plant, whose noise nobody has stated?
  bool has_unknown_noise() const { return !from_start().untold.empty(); }

  Eigen::Index samples() const { return y.cols(); }
  bool has_setpoint(Eigen::Index cv) const;
  /// The CVs with a setpoint, in their order.
  std::vector<Eigen::Index> setpoint_cvs() const;
};

/// The records `loop` of a loop of `study` (recorded()) that ran to its end and starts at the operating point
/// `point`. The setpoint of a CV in a range is, where `study.assessment.setpoints` wants that of the
/// optimizer, optimizer_steady_state(); NaN when it does not, or when the controller has no targets.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const Trajectory& loop);

/// `signals` of the CVs (ny x N), those that integrate behind their washout, from their first value on.
Eigen::MatrixXd behind_washout(const Study& study, Eigen::MatrixXd signals);

/// CVs that integrate as they were before the washout, less their start; the gaps of `signals` (NaN) are
/// closed.
Eigen::MatrixXd from_washout(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& signals);

/// Samples until the slowest channel of the model has settled (settling_time()).
Eigen::Index slowest_settling(const Study& study);

/// The number of first samples of a plant record that only initialise the model: 0 for a record that begins
/// at rest at the operating point, otherwise the settling time of the slowest channel. With
/// RecordStart::automatic a record begins at rest when each MV and MD begins within half of its standard
/// deviation of the operating point.
Eigen::Index samples_to_settle(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                               RecordStart start);

/// A plant record, of recorded_study(), as the methods see it. The first `unjudged` samples of the CVs are
/// missing. Before the record the model rests at the first values of the MVs and MDs if `unjudged` is above
/// 0, otherwise at the operating point. y_sim and targets are those of the record if it has them.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                           Eigen::Index unjudged);

/// The window of `samples` samples of a record from sample `first` on. `record` must outlive it.
AssessedLoop window_of(const AssessedLoop& record, Eigen::Index first, Eigen::Index samples);

/// From where on an analysis is held: the sample at which it was taken, or that at which it was shown.
enum class AnalysesHeld { from_taken, from_shown };

/// `record` where `loop` is whole, and of a window this window of it, which keeps the record alive: for a
/// record that was made from that of `loop`, sample by sample. Derived values are kept.
std::shared_ptr<AssessedLoop> same_window(const AssessedLoop& loop, AssessedLoop record);

/// The loop with each analysis of a CV of an analyser, and y_sim at its sample, held to the next one, so that
/// an exact model has no errors between them; NaN where an analysis is missing. It is derived from `loop`.
std::shared_ptr<const AssessedLoop> with_analyses_held(const Study& study, const AssessedLoop& loop,
                                                       AnalysesHeld from);

/// What is known about the errors of the model where nothing is wrong.
class ModelCorrection {
 public:
  ModelCorrection() = default;
  ModelCorrection(const ModelCorrection&) = default;
  ModelCorrection& operator=(const ModelCorrection&) = default;
  virtual ~ModelCorrection() = default;

  /// The loop after the part of y - y_sim that these errors explain was added to y_sim: the rest is new. It
  /// is derived from `loop`.
  virtual std::shared_ptr<const AssessedLoop> corrected(const AssessedLoop& loop) const = 0;
};

/// What a method may know besides the records of the loop. `study` and `basis` must outlive it. What methods
/// make of it once for all loops under it is in `derived`. What they make of benchmark, correction and model
/// alone is in `of_benchmark`, which contexts of other excitations share; a context whose benchmark or
/// correction is changed needs a new one. Neither keeps anything but in a panel (MethodPanel).
struct AssessmentContext {
  const Study& study;      ///< the nominal model, the controller and the options of the methods
  const BasisCase& basis;  ///< the operating point and T0
  QpSolverFactory factory;
  /// A period in which the controller worked as designed; none if no such period is known.
  std::optional<AssessedLoop> benchmark = {};
  /// The study of the benchmark loop, if its excitation is different; null: `study`.
  std::shared_ptr<const Study> benchmark_study = {};
  /// What the benchmark shows of the errors of the model; null: the model is taken to be exact.
  std::shared_ptr<const ModelCorrection> correction = {};
  std::shared_ptr<const DerivedValues> of_benchmark = std::make_shared<const DerivedValues>();
  DerivedValues derived = {};

  const Study& study_of_benchmark() const { return benchmark_study ? *benchmark_study : study; }
};

/// The largest value with which methods can compute: sums of its fourth power are numbers.
inline constexpr double kLargestValue = 1e60;

/// "y1 of 1e+160 at sample 3": the first value of a record of the loop, from its start on, that is not finite
/// or beyond kLargestValue; none where all have numbers. CVs, setpoints and candidates may be missing (NaN).
std::optional<std::string> out_of_proportion(const Study& study, const AssessedLoop& loop);

/// The CVs of the basis case as the historian keeps them, ny x N; a method knows no others.
Eigen::MatrixXd recorded_basis(const AssessmentContext& context);

}  // namespace mpm
