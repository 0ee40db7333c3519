#pragma once

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Signals that act on a loop and on which the loop does not act: measured disturbances, setpoints of the
/// controller, soft limits that an operator moves, and test signals. Setpoints of an optimizer follow from
/// the measurements, so they belong to the loop.
class OutsideSignals {
 public:
  /// `study` must outlive the object.
  explicit OutsideSignals(const Study& study);

  /// The outside signals of this record that move, one row each; 0 rows if none moves. Limits and test
  /// signals come from the study: they are the same in every loop of its length. `loop` is a whole record.
  Eigen::MatrixXd of(const AssessedLoop& loop) const;
  /// The setpoints of the controller in this record that move.
  Eigen::MatrixXd setpoints_of(const AssessedLoop& loop) const;

 private:
  const Study& study_;
  Eigen::MatrixXd planned_;  ///< moving limits and test signals, one row each
};

}  // namespace mpm
