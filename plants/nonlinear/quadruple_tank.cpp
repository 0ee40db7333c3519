#include "plants/nonlinear/quadruple_tank.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kTanks = 4;

double voltage(double v) {
  return std::max(v, 0.0);
}

double opening(double x) {
  return std::clamp(x, 0.0, 1.0);
}

// The flow; if it is taken out, the part of it that the tank can give. Below it, the slope of this part.
double available(double flow, double level) {
  return flow < 0.0 ? flow * std::clamp(level / QuadrupleTank::kShallow, 0.0, 1.0) : flow;
}

double available_slope(double flow, double level) {
  const bool short_of_it = level > 0.0 && level < QuadrupleTank::kShallow;
  return flow < 0.0 && short_of_it ? flow / QuadrupleTank::kShallow : 0.0;
}

}  // namespace

QuadrupleTank::QuadrupleTank(const QuadrupleTankParameters& parameters) : parameters_(parameters) {
  parameters_.validate();
}

// Below e = kShallow, q is cd times the parabola a h + b h^2 with a = (2 - n) e^(n-1), b = (n - 1) e^(n-2)
// for the exponent n.
double QuadrupleTank::outflow(std::size_t tank, double level) const {
  const double n = parameters_.exponent[tank];
  const double cd = parameters_.discharge[tank];
  if (level >= kShallow)
    return cd * std::pow(level, n);
  const double part = std::max(level / kShallow, 0.0);
  return cd * std::pow(kShallow, n) * part * (2 - n + (n - 1) * part);
}

double QuadrupleTank::outflow_slope(std::size_t tank, double level) const {
  const double n = parameters_.exponent[tank];
  const double cd = parameters_.discharge[tank];
  if (level >= kShallow)
    return cd * n * std::pow(level, n - 1);
  if (level <= 0.0)
    return 0.0;
  return cd * std::pow(kShallow, n - 1) * (2 - n + 2 * (n - 1) * level / kShallow);
}

// What the pumps bring into each tank.
Eigen::Vector4d QuadrupleTank::inflow(const Eigen::Ref<const Eigen::VectorXd>& u) const {
  const double pump_1 = parameters_.pump[0] * voltage(u(0));
  const double pump_2 = parameters_.pump[1] * voltage(u(1));
  const double x_1 = opening(u(2));
  const double x_2 = opening(u(3));
  return {x_1 * pump_1, x_2 * pump_2, (1 - x_2) * pump_2, (1 - x_1) * pump_1};
}

void QuadrupleTank::derivative(const Eigen::Ref<const Eigen::VectorXd>& x,
                               const Eigen::Ref<const Eigen::VectorXd>& u,
                               Eigen::Ref<Eigen::VectorXd> dx) const {
  const Eigen::Vector4d pumped = inflow(u);
  Eigen::Vector4d out;
  for (Eigen::Index i = 0; i < kTanks; ++i)
    out(i) = outflow(static_cast<std::size_t>(i), x(i) + u(kMvs + kFlows + i));
  for (Eigen::Index i = 0; i < kTanks; ++i) {
    const double from_above = i < 2 ? out(i + 2) : 0.0;
    dx(i) = (from_above - out(i) + pumped(i) + available(u(kMvs + i), x(i) + u(kMvs + kFlows + i))) /
            parameters_.area[static_cast<std::size_t>(i)];
  }
}

void QuadrupleTank::jacobian(const Eigen::Ref<const Eigen::VectorXd>& x,
                             const Eigen::Ref<const Eigen::VectorXd>& u,
                             Eigen::Ref<Eigen::MatrixXd> J) const {
  J.setZero();
  for (Eigen::Index i = 0; i < kTanks; ++i) {
    const auto tank = static_cast<std::size_t>(i);
    const double level = x(i) + u(kMvs + kFlows + i);
    const double slope = outflow_slope(tank, level);
    J(i, i) = (available_slope(u(kMvs + i), level) - slope) / parameters_.area[tank];
    if (i >= 2)
      J(i - 2, i) = slope / parameters_.area[tank - 2];
  }
}

void QuadrupleTank::output(const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& u, Eigen::Ref<Eigen::VectorXd> y) const {
  y = (x + u.tail(kAdded)).cwiseMax(0.0);
}

Eigen::VectorXd QuadrupleTank::steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const {
  const Eigen::Vector4d pumped = inflow(u);
  Eigen::Vector4d level;
  Eigen::Vector4d out;
  for (Eigen::Index i = kTanks - 1; i >= 0; --i) {
    const auto tank = static_cast<std::size_t>(i);
    out(i) = pumped(i) + u(kMvs + i) + (i < 2 ? out(i + 2) : 0.0);
    if (!(out(i) >= 0.0))
      throw NoSteadyState(fmt::format("steady inflow of tank {}", i + 1), fmt::format("{} cm^3/s", out(i)),
                          "0 or more: no more can be taken out than flows in");
    level(i) = std::pow(out(i) / parameters_.discharge[tank], 1 / parameters_.exponent[tank]);
    if (level(i) < kShallow) {
      if (u(kMvs + i) < 0.0)
        throw NoSteadyState(fmt::format("steady level of tank {}", i + 1), fmt::format("{} cm", level(i)),
                            fmt::format("{} cm or more where a flow is taken out", kShallow));
      // a h + b h^2 = out / cd, see outflow(); the form without cancellation.
      const double n = parameters_.exponent[tank];
      const double relative = out(i) / (parameters_.discharge[tank] * std::pow(kShallow, n));
      const double root = std::sqrt((2 - n) * (2 - n) + 4 * (n - 1) * relative);
      level(i) = kShallow * 2 * relative / (2 - n + root);
    }
  }
  return level - u.tail(kAdded);
}

Eigen::VectorXd quadruple_tank_operating_point() {
  return (Eigen::VectorXd(12) << 3.2, 3.15, 0.43, 0.34, 0, 0, 0, 0, 0, 0, 0, 0).finished();
}

NonlinearModel quadruple_tank_nonlinear(const std::string& set, std::size_t flows) {
  const QuadrupleTankParameters nominal = quadruple_tank_parameters(set);
  NonlinearModel model;
  for (const auto& [name, value] : named_parameters(nominal))
    model.parameters.push_back({name, value});
  for (std::size_t i = flows + 1; i <= std::size_t{QuadrupleTank::kFlows}; ++i)
    model.inner_inputs.push_back(fmt::format("F{}", i));
  for (std::size_t i = 1; i <= std::size_t{QuadrupleTank::kAdded}; ++i)
    model.inner_inputs.push_back(fmt::format("D{}", i));
  model.operating_input = quadruple_tank_operating_point();
  model.make_system = [nominal](const std::vector<ParameterChange>& changes) {
    QuadrupleTankParameters parameters = nominal;
    for (const ParameterChange& change : changes)
      parameters = with_parameter(parameters, change.name, change.value);
    return std::make_shared<const QuadrupleTank>(parameters);
  };
  return model;
}

}  // namespace mpm
