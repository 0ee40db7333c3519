#include "analysis/records/controller_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "analysis/validation/record_check.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/study/study_controller.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kAnswerLags = 3;  ///< samples within which a move answers an error
/// Standard errors of a correlation. White moves exceed it in 1 of 2000 pairs; all of 60 healthy closed loops
/// (tests/reliability/records.py, seed 1) exceeded it.
constexpr double kAnswer = 3.5;
constexpr Eigen::Index kFewestMoves = 50;
constexpr double kMoveRounding = 1e-12;  ///< relative to the range or the mean of an MV

/// The CVs as the controller gets them: the output of the model plus the last error replaces a missing
/// sample.
Eigen::MatrixXd measured(const AssessedLoop& loop, const Eigen::MatrixXd& y) {
  Eigen::MatrixXd all = y;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    double error = 0.0;
    for (Eigen::Index k = 0; k < y.cols(); ++k) {
      if (std::isnan(y(cv, k)))
        all(cv, k) = loop.y_sim(cv, k) + error;
      else
        error = y(cv, k) - loop.y_sim(cv, k);
    }
  }
  return all;
}

/// The MVs that the controller would have chosen; empty if it fails, with the reason in `failure`.
Eigen::MatrixXd chosen(const RecordFrame& frame, const PlantRecord& record, const AssessedLoop& loop,
                       std::string& failure) {
  const Study& study = frame.as_kept;
  const std::unique_ptr<Controller> controller = controller_of(study, study.controller, frame.factory);
  const Eigen::MatrixXd y_set = setpoints(study), y = measured(loop, record.y);
  const std::vector<LimitStep>& steps = study.simulation.limit_steps;
  controller->set_setpoints(study.simulation.initial_setpoint);
  controller->reset(record.u.col(0), record.d.col(0));
  OffSchedule schedule(study);
  Eigen::MatrixXd u(record.u.rows(), record.samples());
  for (Eigen::Index k = 0; k < record.samples(); ++k) {
    if (y_set.size() > 0)
      controller->set_setpoints(y_set.col(k));
    const bool switches = schedule.go_on(k, record.u.col(k));
    if (switches)
      controller->set_off(schedule.off());
    if (switches ||
        std::any_of(steps.begin(), steps.end(), [k](const LimitStep& step) { return step.sample == k; }))
      controller->set_cv_soft(soft_limits(study, k));
    const ControlMove& move = controller->step(y.col(k), record.d.col(k));
    if (move.status != ControlStatus::ok) {
      failure = fmt::format("it has no move at {} ({})", record.stamps[static_cast<std::size_t>(k)],
                            to_string(move.status));
      return {};
    }
    u.col(k) = move.u;
    controller->set_acting(record.u.col(k));
  }
  return u;
}

/// The MVs at the samples at which the controller has them, NaN elsewhere.
Eigen::MatrixXd moved_by_controller(const PlantRecord& record) {
  if (record.u_off.size() == 0)
    return record.u;
  return (record.u_off.array() == 1.0).select(kNaN, record.u.array());
}

/// 1 at samples at which moves are compared, 0 elsewhere: at samples that are not judged, and where the
/// controller may have seen other CVs or may have been off, at this sample or the one before.
Eigen::ArrayXd compared_samples(const RecordFrame& frame, const PlantRecord& record) {
  Eigen::ArrayXd counts = Eigen::ArrayXd::Ones(record.samples());
  counts.head(std::min(record.samples(), std::max<Eigen::Index>({1, frame.unjudged, frame.settling})))
      .setZero();
  for (Eigen::Index k = 0; k < record.samples(); ++k)
    if (record.y.col(k).array().isNaN().any())
      counts.segment(k, std::min<Eigen::Index>(2, record.samples() - k)).setZero();
  return counts;
}

/// Correlation over the `count` pairs of which both values are there; 0 if there are too few.
double correlation(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b, double& count) {
  const auto there = !(a.isNaN() || b.isNaN());
  count = there.cast<double>().sum();
  if (count < static_cast<double>(kFewestMoves))
    return 0.0;
  const double mean_a = there.select(a, 0.0).sum() / count, mean_b = there.select(b, 0.0).sum() / count;
  const double ab = there.select((a - mean_a) * (b - mean_b), 0.0).sum();
  const double aa = there.select((a - mean_a).square(), 0.0).sum();
  const double bb = there.select((b - mean_b).square(), 0.0).sum();
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

/// Returns whether moves of some MV follow errors of some CV. Without feedback from the CVs both are
/// independent, and the moves are nearly white.
bool answers(const Eigen::MatrixXd& u, const Eigen::MatrixXd& e) {
  const Eigen::Index N = u.cols();
  if (N < kFewestMoves + kAnswerLags)
    return true;
  const Eigen::MatrixXd moves = u.rightCols(N - 1) - u.leftCols(N - 1);
  const Eigen::MatrixXd errors = e.rightCols(N - 1);
  for (Eigen::Index mv = 0; mv < u.rows(); ++mv)
    for (Eigen::Index cv = 0; cv < e.rows(); ++cv)
      for (Eigen::Index lag = 0; lag < kAnswerLags; ++lag) {
        double count = 0.0;
        const double r = correlation(moves.row(mv).tail(N - 1 - lag).transpose().array(),
                                     errors.row(cv).head(N - 1 - lag).transpose().array(), count);
        if (count < static_cast<double>(kFewestMoves) || std::abs(r) * std::sqrt(count) > kAnswer)
          return true;
      }
  return false;
}

}  // namespace

bool ControllerCheck::is_alike() const {
  if (!failure.empty())
    return false;
  const Eigen::Index worst = worst_mv();
  return worst < 0 || agreement(worst) >= kLeastAgreement;
}

Eigen::Index ControllerCheck::worst_mv() const {
  Eigen::Index worst = -1;
  for (Eigen::Index mv = 0; mv < agreement.size(); ++mv)
    if (!std::isnan(agreement(mv)) && (worst < 0 || agreement(mv) < agreement(worst)))
      worst = mv;
  return worst;
}

ControllerCheck check_controller(const RecordFrame& frame, const PlantRecord& record,
                                 const AssessedLoop& loop) {
  const Eigen::Index nu = record.u.rows();
  ControllerCheck check{.agreement = Eigen::VectorXd::Constant(nu, kNaN),
                        .pull = Eigen::VectorXd::Constant(nu, kNaN),
                        .is_closed_loop = answers(moved_by_controller(record), loop.y - loop.y_sim),
                        .away = cvs_away_from_setpoints(frame.as_kept, record)};
  const Eigen::MatrixXd u = chosen(frame, record, loop, check.failure);
  if (u.size() == 0)
    return check;
  const Eigen::ArrayXd compared = compared_samples(frame, record);
  for (Eigen::Index mv = 0; mv < nu; ++mv) {
    Eigen::ArrayXd counts = compared;
    for (Eigen::Index k = 0; k < record.samples(); ++k)
      counts(k) *= record.has_mv_off(mv, k) ? 0.0 : 1.0;
    if (counts.sum() < static_cast<double>(kFewestMoves))
      continue;
    const Eigen::ArrayXd there = record.u.row(mv).transpose();
    const Eigen::ArrayXd off = u.row(mv).transpose().array() - there;
    const double count = counts.sum(), mean = (counts * there).sum() / count;
    const double variance = (counts * (there - mean).square()).sum() / count;
    const Limits& hard = frame.as_kept.controller.mv_hard;
    const double width =
        std::isfinite(hard.upper(mv) - hard.lower(mv)) ? hard.upper(mv) - hard.lower(mv) : 0.0;
    if (std::sqrt(variance) <= kMoveRounding * std::max(width, std::abs(mean)))
      continue;  // the MV rests
    check.agreement(mv) = 1.0 - (counts * off.square()).sum() / count / variance;
    check.pull(mv) = (counts * off).sum() / count / std::sqrt(variance);
  }
  check.is_closed_loop = check.is_closed_loop || (check.worst_mv() >= 0 && check.is_alike());
  return check;
}

}  // namespace mpm
