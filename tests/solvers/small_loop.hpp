#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plants/linear/transfer_matrix.hpp"
#include "solvers/mpc.hpp"

namespace mpm::samples {

/// 2 CVs x 2 MVs x 1 MD with dead times, Ts = 2. At rest the cheapest targets have both CVs at their lower
/// soft limit of -0.5 and both MVs free.
TransferMatrix small_model();

MpcOptions small_options();

/// The back ends worth a closed loop: all but `ipopt-full`, which is `ipopt` without its working set and
/// slow.
std::vector<std::string> loop_back_ends();

/// What acts on a closed loop at sample k.
struct LoopInputs {
  std::function<double(int)> md = [](int) { return 0.0; };
  std::function<Eigen::Vector2d(int)> output_disturbance = [](int) { return Eigen::Vector2d(0, 0); };
};

/// Signals of a closed loop, one column a sample, and the worst status.
struct LoopRun {
  Eigen::MatrixXd y, u, u_target;
  bool ok = true;
};

/// `controller` on small_model() without mismatch from the steady state of its nominal targets on.
LoopRun run_small_loop(Mpc& controller, const LoopInputs& inputs, int samples);

}  // namespace mpm::samples
