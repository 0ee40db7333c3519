#include "analysis/statistics/variance.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

double zero_below(double floor, double value) {
  return value <= floor ? 0.0 : value;
}

void require_setpoints(Eigen::Index cvs, const SetpointTrajectories& y_set) {
  const auto setpoints = static_cast<Eigen::Index>(y_set.size());
  if (setpoints != 0 && setpoints != cvs) {
    throw InputError("number of setpoints", fmt::format("{}", setpoints),
                     fmt::format("0 or {}, one a CV", cvs));
  }
}

/// Returns the setpoint of a CV, or null if it has none.
const Eigen::VectorXd* setpoint_of(Eigen::Index cv, const SetpointTrajectories& y_set) {
  return y_set.empty() || !y_set[static_cast<std::size_t>(cv)] ? nullptr
                                                               : &*y_set[static_cast<std::size_t>(cv)];
}

}  // namespace

double variance(const Signal& signal) {
  require_signal("signal of a variance", signal, 2);
  if (stands_still(signal)) {
    return 0.0;
  }
  return (signal.array() - signal.mean()).square().sum() / static_cast<double>(signal.size() - 1);
}

double variance_about(const Signal& signal, double setpoint) {
  require_signal("signal of a variance", signal, 1);
  if (!std::isfinite(setpoint)) {
    throw InputError("setpoint of a variance", fmt::format("{}", setpoint), "a finite number");
  }
  return (signal.array() - setpoint).square().mean();
}

double variance_about(const Signal& signal, const Signal& setpoint) {
  require_signal("signal of a variance", signal, 1);
  require_same_length("signal", signal, "setpoint", setpoint);
  require_signal("setpoint of a variance", setpoint, 1);
  return (signal - setpoint).squaredNorm() / static_cast<double>(signal.size());
}

double variance_ratio(double numerator, double denominator) {
  if (denominator == 0.0) {
    return numerator == 0.0 ? kNaN : kInfinity;
  }
  return numerator / denominator;
}

double variance_index(const Signal& y, const Signal& y_ref) {
  require_same_length("y", y, "y_ref", y_ref);
  return variance_ratio(zero_below(variance_floor(y), variance(y)),
                        zero_below(variance_floor(y_ref), variance(y_ref)));
}

double variance_index(const Signal& y, const Signal& y_ref, const Signal& y_set) {
  require_same_length("y", y, "y_ref", y_ref);
  return variance_ratio(zero_below(variance_floor(y), variance_about(y, y_set)),
                        zero_below(variance_floor(y_ref), variance_about(y_ref, y_set)));
}

Eigen::VectorXd variances(const Eigen::Ref<const Eigen::MatrixXd>& y, const SetpointTrajectories& y_set) {
  require_setpoints(y.rows(), y_set);
  Eigen::VectorXd found(y.rows());
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const Eigen::VectorXd of_y = y.row(i);
    const auto* const setpoint = setpoint_of(i, y_set);
    found[i] = setpoint ? variance_about(of_y, *setpoint) : variance(of_y);
  }
  return found;
}

Eigen::VectorXd variance_indices(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                 const Eigen::Ref<const Eigen::MatrixXd>& y_ref,
                                 const SetpointTrajectories& y_set) {
  if (y.rows() != y_ref.rows() || y.cols() != y_ref.cols()) {
    throw InputError("shapes of y and y_ref",
                     fmt::format("{} x {} and {} x {}", y.rows(), y.cols(), y_ref.rows(), y_ref.cols()),
                     "equal shapes");
  }
  require_setpoints(y.rows(), y_set);
  Eigen::VectorXd index(y.rows());
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const Eigen::VectorXd of_y = y.row(i);
    const Eigen::VectorXd of_ref = y_ref.row(i);
    const auto* const setpoint = setpoint_of(i, y_set);
    index[i] = setpoint ? variance_index(of_y, of_ref, *setpoint) : variance_index(of_y, of_ref);
  }
  return index;
}

}  // namespace mpm
