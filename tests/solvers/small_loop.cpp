#include "tests/solvers/small_loop.hpp"

#include "solvers/qp_solver_factory.hpp"

namespace mpm::samples {

TransferMatrix small_model() {
  const auto channel = [](double gain, double time_constant, double dead_time) {
    return TransferFunction::first_order(gain, time_constant, dead_time);
  };
  return {{channel(2, 10, 2), channel(0.5, 15, 4), channel(1, 8, 6)},
          {channel(-0.6, 12, 0), channel(1.5, 20, 3), channel(0.5, 10, 2)}};
}

MpcOptions small_options() {
  MpcOptions options;
  options.sample_time = 2;
  options.prediction_horizon = 20;
  options.control_horizon = 4;
  options.move_suppression = Eigen::Vector2d(3, 5);
  options.target_weight = Eigen::Vector2d(1, 0.5);
  options.setpoint_weight = Eigen::Vector2d::Zero();
  options.slack_weight = Eigen::Vector2d(20, 30);
  options.mv_hard = {Eigen::Vector2d(-2, -2), Eigen::Vector2d(2, 2)};
  options.cv_hard = Limits::none(2);
  options.cv_soft = {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, 0.5)};
  options.mv_cost = Eigen::Vector2d(2, 1);
  return options;
}

std::vector<std::string> loop_back_ends() {
  std::vector<std::string> names;
  for (const std::string& name : qp_solver_names())
    if (name != "ipopt-full")
      names.push_back(name);
  return names;
}

LoopRun run_small_loop(Mpc& controller, const LoopInputs& inputs, int samples) {
  LinearPlant plant(small_model(), small_options().sample_time);
  Eigen::VectorXd input(3);
  Eigen::VectorXd d(1);
  d << 0.0;
  input << controller.nominal_target(d), d;
  plant.reset(input);
  controller.reset(input.head(2), d);

  LoopRun run{Eigen::MatrixXd::Zero(2, samples), Eigen::MatrixXd::Zero(2, samples),
              Eigen::MatrixXd::Zero(2, samples)};
  for (int k = 0; k < samples; ++k) {
    d << inputs.md(k);
    run.y.col(k) = plant.output() + inputs.output_disturbance(k);
    const ControlMove& move = controller.step(run.y.col(k), d);
    run.ok = run.ok && move.status == ControlStatus::ok;
    run.u.col(k) = move.u;
    run.u_target.col(k) = move.u_target;
    input << move.u, d;
    plant.advance(input);
  }
  return run;
}

}  // namespace mpm::samples
