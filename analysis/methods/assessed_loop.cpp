#include "analysis/methods/assessed_loop.hpp"

#include <cmath>
#include <utility>

#include "analysis/sensitivity/control_structure.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/draw.hpp"
#include "scenarios/historian.hpp"

namespace mpm {

bool AssessedLoop::has_setpoint(Eigen::Index cv) const {
  return y_set.cols() > 0 && !std::isnan(y_set(cv, 0));
}

std::vector<Eigen::Index> AssessedLoop::setpoint_cvs() const {
  std::vector<Eigen::Index> cvs;
  for (Eigen::Index cv = 0; cv < y_set.rows(); ++cv)
    if (has_setpoint(cv))
      cvs.push_back(cv);
  return cvs;
}

AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const Trajectory& loop) {
  const Eigen::MatrixXd y_sim =
      simulated_output(study.plant.G, study.controller.sample_time, point.u, loop.u, loop.d);
  AssessedLoop assessed{
      .y = loop.y, .u = loop.u, .u_target = loop.u_target, .d = loop.d, .y_sim = y_sim, .y_set = {}};
  assessed.y_set =
      study.assessment.setpoints == AssessmentSetpoints::optimizer && study.controller.has_targets()
          ? optimizer_steady_state(study, loop, y_sim)
          : Eigen::MatrixXd::Constant(loop.y.rows(), loop.y.cols(), kNaN);
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    if (study.controller.has_setpoint(cv))
      assessed.y_set.row(cv) = loop.y_set.row(cv);
  return assessed;
}

AssessedLoop window_of(const AssessedLoop& record, Eigen::Index first, Eigen::Index samples) {
  const auto cut = [&](const Eigen::MatrixXd& signal) -> Eigen::MatrixXd {
    return signal.cols() == 0 ? signal : Eigen::MatrixXd(signal.middleCols(first, samples));
  };
  return {.y = cut(record.y),
          .u = cut(record.u),
          .u_target = cut(record.u_target),
          .d = cut(record.d),
          .y_sim = cut(record.y_sim),
          .y_set = cut(record.y_set),
          .candidates = cut(record.candidates),
          .whole = &record,
          .first = first};
}

Eigen::MatrixXd gaps_closed(Eigen::MatrixXd signals) {
  for (auto row : signals.rowwise()) {
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k < row.size(); ++k) {
      if (std::isnan(row(k)))
        continue;
      for (Eigen::Index gap = last + 1; gap < k; ++gap)
        row(gap) = last < 0 ? row(k)
                            : row(last) + (row(k) - row(last)) * static_cast<double>(gap - last) /
                                              static_cast<double>(k - last);
      last = k;
    }
    for (Eigen::Index gap = last + 1; last >= 0 && gap < row.size(); ++gap)
      row(gap) = row(last);
  }
  return signals;
}

Eigen::MatrixXd recorded_basis(const AssessmentContext& context) {
  return recorded(context.study, kBasisIndex, context.basis.trajectory).y;
}

AssessmentContext assessment_context(const Study& study, const BasisCase& basis, QpSolverFactory factory) {
  return {study, basis, std::move(factory),
          assessed_loop(study, basis.point, recorded(study, kBasisIndex, basis.trajectory))};
}

}  // namespace mpm
