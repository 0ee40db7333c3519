#include "analysis/sensitivity/second_order_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"

namespace mpm {
namespace {

constexpr double kWidest = 100.0;  // factor of the limits of time constant and damping

void require_positive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InputError(name, fmt::format("{}", value), "a number > 0");
}

/// Residuals as a function of (log tau, log xi), in the form that Eigen's port of MINPACK requires.
struct Residual {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  static constexpr int InputsAtCompileTime = Eigen::Dynamic;
  static constexpr int ValuesAtCompileTime = Eigen::Dynamic;

  const Eigen::RowVectorXd& response;
  double sample_time;

  int inputs() const { return 2; }
  int values() const { return static_cast<int>(response.size()); }

  Eigen::Vector2d lowest() const { return {std::log(sample_time / kWidest), -std::log(kWidest)}; }
  Eigen::Vector2d highest() const {
    return {std::log(sample_time * kWidest * static_cast<double>(response.size())), std::log(kWidest)};
  }
  bool inside(const Eigen::VectorXd& x) const {
    return (x.array() > lowest().array()).all() && (x.array() < highest().array()).all();
  }
  /// Beyond a limit the function keeps its value at the limit, so that the method ends when it runs into one.
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    const Eigen::Vector2d at = x.cwiseMax(lowest()).cwiseMin(highest()).array().exp();
    residual = (second_order_response({at(0), at(1)}, sample_time, response.size()) - response).transpose();
    return 0;
  }
};

/// Returns the number of samples until the response first passes half of its last value.
double half_time(const Eigen::RowVectorXd& response) {
  const double half = 0.5 * response(response.size() - 1);
  Eigen::Index l = 0;
  while (l < response.size() - 1 && std::abs(response(l)) < std::abs(half))
    ++l;
  return static_cast<double>(l + 1);
}

}  // namespace

Eigen::RowVectorXd second_order_response(const SecondOrderModel& model, double sample_time,
                                         Eigen::Index samples) {
  const auto [tau, xi] = model;
  require_positive("time constant", tau);
  require_positive("damping", xi);
  const TransferMatrix T0{
      {TransferFunction(Eigen::VectorXd::Ones(1), Eigen::Vector3d(tau * tau, 2.0 * tau * xi, 1.0))}};
  return step_response(T0, sample_time, samples).front();
}

SecondOrderFit fit_second_order(const Eigen::Ref<const Eigen::RowVectorXd>& step_response,
                                double sample_time) {
  require_positive("sample time", sample_time);
  if (step_response.size() < 3)
    throw InputError("step response", fmt::format("{} samples", step_response.size()), "at least 3");
  SecondOrderFit best;
  if (!step_response.allFinite())
    return best;
  const Eigen::RowVectorXd response = step_response;
  const Residual residual{response, sample_time};
  const double half = sample_time * half_time(response);
  double least = kInfinity;
  for (const double xi : std::array{0.4, 0.8, 1.5, 4.0}) {
    // A response with this damping passes one half after about (0.6 + 1.1 xi) tau.
    Eigen::VectorXd x = Eigen::Vector2d(std::log(half / (0.6 + 1.1 * xi)), std::log(xi));
    Eigen::NumericalDiff<Residual, Eigen::Central> derivative(residual);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residual, Eigen::Central>> method(derivative);
    method.parameters.xtol = method.parameters.ftol = 1e-14;
    method.minimize(x);
    const double error = method.fnorm / std::sqrt(static_cast<double>(response.size()));
    if (!residual.inside(x) || !(error < least))
      continue;
    least = error;
    best = {FitStatus::ok, {std::exp(x(0)), std::exp(x(1))}, error};
  }
  return best;
}

}  // namespace mpm
