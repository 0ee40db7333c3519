#include "analysis/methods/shared/outside_signals.hpp"

#include <vector>

#include "analysis/identification/noise_filter.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// The soft limits of the study, lower limits above upper limits, 2 ny x N; zero where there is no limit.
Eigen::MatrixXd limit_signals(const Study& study, Eigen::Index samples) {
  Eigen::MatrixXd limits(2 * study.cv_count(), samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    const Limits at = soft_limits(study, k);
    limits.col(k) << at.lower, at.upper;
  }
  return limits.array().isFinite().select(limits, 0.0);
}

}  // namespace

OutsideSignals::OutsideSignals(const Study& study) : study_(study) {
  const Eigen::Index samples = study.simulation.samples;
  const Eigen::MatrixXd limits = moving_rows(limit_signals(study, samples));
  const Eigen::MatrixXd test_signals = dither(study);
  planned_.resize(limits.rows() + test_signals.rows(), samples);
  planned_.topRows(limits.rows()) = limits;
  if (test_signals.rows() > 0)
    planned_.bottomRows(test_signals.rows()) = test_signals;
}

Eigen::MatrixXd OutsideSignals::setpoints_of(const AssessedLoop& loop) const {
  std::vector<Eigen::Index> cvs;
  for (const Eigen::Index cv : loop.setpoint_cvs())
    if (study_.controller.has_setpoint(cv))
      cvs.push_back(cv);
  if (cvs.empty())
    return Eigen::MatrixXd(0, loop.samples());
  return moving_rows(loop.y_set(cvs, Eigen::all));
}

Eigen::MatrixXd OutsideSignals::of(const AssessedLoop& loop) const {
  const Eigen::MatrixXd y_set = setpoints_of(loop);
  const Eigen::Index planned = planned_.cols() == loop.samples() ? planned_.rows() : 0;
  Eigen::MatrixXd signals(loop.d.rows() + y_set.rows() + planned, loop.samples());
  signals.topRows(loop.d.rows()) = loop.d;
  signals.middleRows(loop.d.rows(), y_set.rows()) = y_set;
  if (planned > 0)
    signals.bottomRows(planned) = planned_;
  return moving_rows(signals);
}

}  // namespace mpm
