#include "analysis/control_structure.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

/// Targets and MVs are exact to the tolerance of the solver; a limit is met well above that.
constexpr double kLimitTolerance = 1e-5;

bool at_or_beyond(double value, double lower, double upper) {
  const auto tolerance = [](double limit) { return kLimitTolerance * std::max(1.0, std::abs(limit)); };
  return value <= lower + tolerance(lower) || value >= upper - tolerance(upper);
}

/// What decides whether a CV is active, ny x N.
Eigen::MatrixXd deciding_outputs(const Study& study, const Trajectory& loop,
                                 const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  if (!study.controller.has_targets())
    return loop.y;
  const Eigen::MatrixXd gain = study.plant.G.static_gain();
  return gain.leftCols(study.mv_count()) * loop.u_target + gain.rightCols(study.md_count()) * loop.d +
         loop.y - y_sim;
}

}  // namespace

std::vector<ControlStructure> control_structures(const Study& study, const Trajectory& loop,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  const MpcOptions& options = study.controller;
  const Eigen::MatrixXd y = deciding_outputs(study, loop, y_sim);
  const Eigen::MatrixXd& u = options.has_targets() ? loop.u_target : loop.u;
  std::vector<ControlStructure> structures(static_cast<std::size_t>(y.cols()));
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    ControlStructure& structure = structures[static_cast<std::size_t>(k)];
    for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
      const double lower = options.cv_soft.lower(cv), upper = options.cv_soft.upper(cv);
      if (options.has_setpoint(cv))
        structure.active.push_back({cv, ReferenceKind::setpoint});
      else if (at_or_beyond(y(cv, k), lower, upper))
        structure.active.push_back({cv, y(cv, k) - lower > upper - y(cv, k) ? ReferenceKind::upper_limit
                                                                            : ReferenceKind::lower_limit});
    }
    for (Eigen::Index mv = 0; mv < u.rows(); ++mv)
      if (at_or_beyond(u(mv, k), options.mv_hard.lower(mv), options.mv_hard.upper(mv)))
        structure.fixed_mvs.push_back(mv);
  }
  return structures;
}

}  // namespace mpm
