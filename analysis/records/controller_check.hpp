#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/records/record_panel.hpp"

namespace mpm {

/// Below this agreement of some MV the controller of the study is not the one that ran. Of 54 healthy records
/// of ten imperfect plants, with the biases of a historian (tests/reliability/records.py, seed 1), the least
/// was -0.56; of records of other costs and of other setpoints the largest was -2.5.
inline constexpr double kLeastAgreement = -1.0;

/// Is the record of the controller of the study? It is run on the recorded CVs, MDs and setpoints; its model
/// is moved by the recorded MVs, operators take from it what they had taken, and its next move u_c is
/// compared with the recorded one.
struct ControllerCheck {
  /// 1 - sum (u - u_c)^2 / sum (u - mean u)^2 of each MV, nu, over the samples at which all CVs are there and
  /// the controller has the MV;
  /// NaN of one that never moves. Moves would tell controllers apart more finely, but also the historian: of
  /// a record of this very controller with rounded and averaged columns they agree with -64 where levels do
  /// with 0.93.
  Eigen::VectorXd agreement;
  /// mean (u_c - u) in standard deviations of u, nu: a steady pull, as of costs that differ.
  Eigen::VectorXd pull;
  /// Is it that controller, or is some MV correlated with the errors of some CV, as feedback makes it?
  bool is_closed_loop = true;
  /// The CVs with a setpoint of the study, of which none was recorded, that stay away from it.
  std::vector<Eigen::Index> away;
  std::string failure = {};  ///< why there is no agreement: the controller gave no move

  /// Is it that controller, or is nothing known?
  bool is_alike() const;
  /// The MV with the least agreement; -1: none moves.
  Eigen::Index worst_mv() const;
};

ControllerCheck check_controller(const RecordFrame& frame, const PlantRecord& record,
                                 const AssessedLoop& loop);

}  // namespace mpm
