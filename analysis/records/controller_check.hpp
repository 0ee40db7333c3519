#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/records/record_panel.hpp"

namespace mpm {

/// If the agreement of some MV is below this, the controller of the study is not the one that ran. In 54
/// healthy records of ten imperfect plants, with the biases of a historian (tests/reliability/records.py,
/// seed 1), the smallest agreement was -0.56; in records with other costs and other setpoints the largest was
/// -2.5.
inline constexpr double kLeastAgreement = -1.0;

/// Checks whether the record comes from the controller of the study. This controller is run on the recorded
/// CVs, MDs and setpoints. The recorded MVs move its model, what operators had switched off is off, and its
/// next move u_c is compared with the recorded one.
struct ControllerCheck {
  /// 1 - sum (u - u_c)^2 / sum (u - mean u)^2 of each MV, nu, over the samples at which all CVs are there and
  /// the controller has the MV; NaN for an MV that never moves. Moves would tell controllers apart more
  /// finely than levels, but they are sensitive to the historian as well: in a record of this very controller
  /// with rounded and averaged columns the agreement of moves is -64, that of levels 0.93.
  Eigen::VectorXd agreement;
  /// mean (u_c - u) in standard deviations of u, nu: a steady pull, as costs that differ cause it.
  Eigen::VectorXd pull;
  /// True if it is that controller, or if some MV is correlated with the errors of some CV, as under
  /// feedback.
  bool is_closed_loop = true;
  /// The CVs that stay away from their setpoint, if it is the study's and none was recorded.
  std::vector<Eigen::Index> away;
  std::string failure = {};  ///< why there is no agreement: the controller gave no move

  /// Returns true if it is that controller, or if nothing is known.
  bool is_alike() const;
  /// The MV with the least agreement; -1: none moves.
  Eigen::Index worst_mv() const;
};

ControllerCheck check_controller(const RecordFrame& frame, const PlantRecord& record,
                                 const AssessedLoop& loop);

}  // namespace mpm
