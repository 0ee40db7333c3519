#include "analysis/sensitivity/control_structure.hpp"

#include "analysis/sensitivity/active_limit.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {

Eigen::MatrixXd optimizer_steady_state(const Study& study, const Trajectory& loop,
                                       const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  const Eigen::MatrixXd gain = study.plant.G.steady_gain();
  Eigen::MatrixXd y = gain.leftCols(study.mv_count()) * loop.u_target +
                      gain.rightCols(study.md_count()) * loop.d + loop.y - y_sim;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    if (study.plant.G.is_integrating(cv))
      y.row(cv) = loop.y.row(cv);
  return y;
}

std::vector<ControlStructure> control_structures(const Study& study, const Trajectory& loop,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  const MpcOptions& options = study.controller;
  // The outputs and inputs that decide which CVs are active and which MVs are fixed.
  const Eigen::MatrixXd y = options.has_targets() ? optimizer_steady_state(study, loop, y_sim) : loop.y;
  const Eigen::MatrixXd& u = options.has_targets() ? loop.u_target : loop.u;
  std::vector<ControlStructure> structures(static_cast<std::size_t>(y.cols()));
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    ControlStructure& structure = structures[static_cast<std::size_t>(k)];
    const Limits soft = soft_limits(study, k);
    for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
      const double lower = soft.lower(cv), upper = soft.upper(cv);
      if (is_off(study, VariableSort::cv, cv, k))
        continue;
      if (options.has_setpoint(cv))
        structure.active.push_back({cv, ConstraintKind::setpoint});
      else if (at_or_above(y(cv, k), upper))
        structure.active.push_back({cv, ConstraintKind::upper_limit});
      else if (at_or_below(y(cv, k), lower))
        structure.active.push_back({cv, ConstraintKind::lower_limit});
    }
    for (Eigen::Index mv = 0; mv < u.rows(); ++mv)
      if (at_or_below(u(mv, k), options.mv_hard.lower(mv)) ||
          at_or_above(u(mv, k), options.mv_hard.upper(mv)) || is_off(study, VariableSort::mv, mv, k))
        structure.fixed_mvs.push_back(mv);
  }
  return structures;
}

}  // namespace mpm
