#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/basis_case.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The records of one closed loop, as a method of assessment sees them: what a historian of the plant keeps,
/// and what follows from it and the nominal model.
///
/// | symbol | member | shape  | meaning                                                       |
/// |--------|--------|--------|---------------------------------------------------------------|
/// | y      | y      | ny x N | measured CVs; NaN where a sample is missing                   |
/// | u      | u      | nu x N | MVs, u(k) acts from sample k on                               |
/// | u_target | u_target | nu x N | targets of the optimizer; zero without one               |
/// | d      | d      | nd x N | measured disturbances, d(k) acts from sample k on             |
/// | y_sim  | y_sim  | ny x N | G0 (u, d)                                              (6.4)  |
/// | y_set  | y_set  | ny x N | setpoints; NaN for a CV without one, see AssessmentSetpoints  |
///
/// Of a window that moves over a record these are its samples, and `whole` is the record. A method that
/// filters or simulates the loop does so from the start of the record, from_start(), where the loop was at
/// its operating point, and judges the samples of the window.
struct AssessedLoop {
  Eigen::MatrixXd y, u, u_target, d, y_sim, y_set;
  /// Further signals that the historian keeps and the model does not know, a row each; 0 x 0 without any.
  Eigen::MatrixXd candidates = {};
  const AssessedLoop* whole = nullptr;  ///< the record that this is a window of; null: it is whole
  Eigen::Index first = 0;               ///< sample of it at which the window begins

  const AssessedLoop& from_start() const { return whole ? *whole : *this; }
  /// The columns of the window out of a signal of the record, one column a sample.
  auto in_window(const Eigen::MatrixXd& signal) const { return signal.middleCols(first, samples()); }

  Eigen::Index samples() const { return y.cols(); }
  bool has_setpoint(Eigen::Index cv) const;
  /// The CVs with a setpoint, in their order.
  std::vector<Eigen::Index> setpoint_cvs() const;
};

/// The records `loop` of a loop of `study` (recorded()) that ran to its end and starts at the operating point
/// `point`. The setpoint of a CV in a range is, where `study.assessment.setpoints` wants that of the
/// optimizer, optimizer_steady_state(); NaN when it does not, or when the controller has no targets.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const Trajectory& loop);

/// The samples of a record of the plant that only fill the memory of the model: none of one that begins at
/// rest at the operating point, otherwise the settling time of the slowest channel. With
/// RecordStart::automatic the record begins at rest when each MV and MD does within half of its standard
/// deviation.
Eigen::Index samples_to_settle(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                               RecordStart start);

/// A record of the plant, of recorded_study(), as the methods see it. The first `unjudged` samples of the CVs
/// are missing; with some, the model rests at the first values of MVs and MDs before the record, without any
/// at the operating point. y_sim and targets are those of the record where it has them.
AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                           Eigen::Index unjudged);

/// The window of `samples` samples of a record from sample `first` on. `record` must outlive it.
AssessedLoop window_of(const AssessedLoop& record, Eigen::Index first, Eigen::Index samples);

/// Each row of `signals` with its gaps (NaN) closed along straight lines, held where it begins or ends with
/// one; a row without any value stays as it is.
Eigen::MatrixXd gaps_closed(Eigen::MatrixXd signals);

/// What a method may know besides the records of the loop that it assesses. `study` and `basis` must outlive
/// it.
struct AssessmentContext {
  const Study& study;      ///< the nominal model, the controller and the options of the methods
  const BasisCase& basis;  ///< the operating point and T0
  QpSolverFactory factory;
  /// A period in which the controller did what it was designed for; none known: no such period.
  std::optional<AssessedLoop> benchmark = {};
};

/// The CVs of the basis case as the historian keeps them, ny x N: what a method may know of them.
Eigen::MatrixXd recorded_basis(const AssessmentContext& context);

/// The context of the loops of `study`, whose benchmark is the record of the basis case: nothing is wrong in
/// it.
AssessmentContext assessment_context(const Study& study, const BasisCase& basis, QpSolverFactory factory);

}  // namespace mpm
