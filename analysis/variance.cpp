#include "analysis/variance.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/signal_check.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

double zero_below(double floor, double value) {
  return value <= floor ? 0.0 : value;
}

}  // namespace

double variance(const Signal& signal) {
  require_signal("signal of a variance", signal, 2);
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
    return numerator == 0.0 ? std::numeric_limits<double>::quiet_NaN()
                            : std::numeric_limits<double>::infinity();
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

}  // namespace mpm
