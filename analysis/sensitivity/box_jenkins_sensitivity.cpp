#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "analysis/sensitivity/identified_sensitivity.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kShortestRecord = 600;

/// A CV has begun to move when its deviation exceeds this share of the largest one. The share is above
/// rounding and above a creep that nobody would model.
constexpr double kBegun = 1e-3;

/// Returns the number of samples from the first move of the reference to the first answer of the output, at
/// least 1.
Eigen::Index begin_of_answer(const Eigen::RowVectorXd& moves, const Eigen::RowVectorXd& y) {
  Eigen::Index moved = 0, answered = 0;
  while (moved + 1 < moves.size() && moves(moved) == 0.0)
    ++moved;
  const double level = kBegun * y.cwiseAbs().maxCoeff();
  while (answered + 1 < y.size() && std::abs(y(answered)) <= level)
    ++answered;
  return std::max<Eigen::Index>(1, answered - moved);
}

Eigen::MatrixXd identified_response(const Study& study, const OperatingPoint& point,
                                    const ActiveConstraint& reference, bool into_range,
                                    const QpSolverFactory& factory, const StepObserver& observer) {
  const Eigen::RowVectorXd moves = identification_moves(study, reference, into_range);
  const Eigen::MatrixXd y = reference_record(study, point, reference, moves, factory, observer);
  IdentifiedSensitivityOptions options;
  options.samples = study.sensitivity.samples;
  Eigen::MatrixXd response(y.rows(), options.samples);
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    const Eigen::Index delay = begin_of_answer(moves, y.row(cv));
    options.orders = {{0}, {8}, {4, 5, 6}, {1}, {1}, {1}};
    if (delay > 1)
      options.orders.delay.push_back(delay);
    const IdentifiedSensitivity found = identified_sensitivity(moves, y.row(cv), options);
    response.row(cv) = found.step_response.front().row(0);
    if (!response.row(cv).allFinite())
      throw InputError(
          "sensitivity.form",
          fmt::format("box-jenkins, and no usable model of {} for the {} of {} ({})",
                      study.plant.cvs[static_cast<std::size_t>(cv)].name, to_string(reference.kind),
                      study.plant.cvs[static_cast<std::size_t>(reference.cv)].name,
                      to_string(found.rows.front().identification.status)),
          "step-response, or another length or step size");
  }
  return response;
}

}  // namespace

Eigen::RowVectorXd identification_moves(const Study& study, const ActiveConstraint& reference,
                                        bool into_range) {
  const Eigen::Index length = study.sensitivity.samples;
  const Eigen::Index N = std::max(kShortestRecord, 4 * length);
  const Eigen::Index shortest = std::max<Eigen::Index>(1, length / 12);
  const Eigen::Index longest = std::max<Eigen::Index>(shortest, length / 2);
  const bool upwards = (reference.kind == ConstraintKind::upper_limit) != into_range;
  RandomStream stream(study.seed, static_cast<std::uint64_t>(reference.cv), StreamId::identification);
  Eigen::RowVectorXd moves = Eigen::RowVectorXd::Zero(N);
  double level = 0.0;
  for (Eigen::Index k = 1; k < N;) {
    if (reference.kind == ConstraintKind::setpoint)
      level = study.sensitivity.step_size * stream.uniform(-1.0, 1.0);
    else
      level += (upwards ? 0.5 : -0.5) * study.sensitivity.step_size * stream.uniform();
    const auto hold = shortest + static_cast<Eigen::Index>(
                                     stream.below(static_cast<std::uint64_t>(longest - shortest + 1)));
    const Eigen::Index end = std::min(N, k + hold);
    moves.segment(k, end - k).setConstant(level);
    k = end;
  }
  return moves;
}

NominalSensitivity box_jenkins_sensitivity(const Study& study, const OperatingPoint& point,
                                           const QpSolverFactory& factory, const StepObserver& observer) {
  NominalSensitivity sensitivity{study.cv_count(), point.active, {}};
  const StepDirection direction = study.sensitivity.step_direction;
  for (const ActiveConstraint& reference : point.active) {
    const auto response = [&](bool into_range) {
      return identified_response(study, point, reference, into_range, factory, observer);
    };
    const bool both = direction == StepDirection::mean && reference.kind != ConstraintKind::setpoint;
    sensitivity.step_response.push_back(both ? Eigen::MatrixXd(0.5 * (response(true) + response(false)))
                                             : response(direction == StepDirection::into_range));
  }
  return sensitivity;
}

Eigen::VectorXd largest_differences(const NominalSensitivity& a, const NominalSensitivity& b) {
  assert(a.step_response.size() == b.step_response.size());
  Eigen::VectorXd largest(static_cast<Eigen::Index>(a.step_response.size()));
  for (std::size_t i = 0; i < a.step_response.size(); ++i)
    largest(static_cast<Eigen::Index>(i)) = (a.step_response[i] - b.step_response[i]).cwiseAbs().maxCoeff();
  return largest;
}

}  // namespace mpm
