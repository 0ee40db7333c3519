#include "tests/solvers/p1_controller.hpp"

namespace mpm::samples {

MpcOptions p1_options() {
  MpcOptions options;
  options.sample_time = 4;
  options.prediction_horizon = 75;
  options.control_horizon = 15;
  options.mv_cost = Eigen::Vector3d(8, 3, 4);
  options.target_weight = Eigen::Vector3d::Constant(1);
  options.move_suppression = Eigen::Vector3d::Constant(25);
  options.setpoint_weight = Eigen::VectorXd::Zero(7);
  options.slack_weight = Eigen::VectorXd::Constant(7, 100);
  options.mv_hard = {Eigen::Vector3d::Constant(-0.5), Eigen::Vector3d::Constant(0.5)};
  options.cv_hard = {Eigen::VectorXd::Constant(7, -1), Eigen::VectorXd::Constant(7, 1)};
  options.cv_soft = {Eigen::VectorXd::Constant(7, -0.5), Eigen::VectorXd::Constant(7, 0.5)};
  options.cv_soft.lower.head(2).setZero();  // y1, y2
  options.cv_soft.upper(6) = 0;             // y7
  return options;
}

}  // namespace mpm::samples
