// The linear models of the quadruple tank.

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace mpm {
namespace {

void require_smooth(const Eigen::VectorXd& level, const Eigen::Ref<const Eigen::VectorXd>& u) {
  for (Eigen::Index j = 0; j < 2; ++j) {
    if (!(u(j) > 0))
      throw InputError(fmt::format("v{} to linearise at", j + 1), fmt::to_string(u(j)), "> 0");
    if (!(u(j + 2) > 0 && u(j + 2) < 1))
      throw InputError(fmt::format("x{} to linearise at", j + 1), fmt::to_string(u(j + 2)),
                       "above 0 and below 1");
  }
  for (Eigen::Index i = 0; i < level.size(); ++i)
    if (!(level(i) > QuadrupleTank::kShallow))
      throw InputError(fmt::format("h{} to linearise at", i + 1), fmt::format("{} cm", level(i)),
                       fmt::format("above {} cm", QuadrupleTank::kShallow));
}

// numerator / (s + rate): a tank with the outflow rate dq/dh / A.
TransferFunction tank(Eigen::VectorXd numerator, double rate) {
  return {std::move(numerator), Eigen::Vector2d(1, rate)};
}

// The same with the tank above it in between: numerator / ((s + upper) (s + lower)).
TransferFunction two_tanks(Eigen::VectorXd numerator, double upper, double lower) {
  return {std::move(numerator), Eigen::Vector3d(1, upper + lower, upper * lower)};
}

Eigen::VectorXd constant(double gain) {
  return Eigen::VectorXd::Constant(1, gain);
}

// gain * s
Eigen::VectorXd differentiated(double gain) {
  return Eigen::Vector2d(gain, 0);
}

/// The linear model with the first `flows` external flows as MDs.
PlantModel linear_model(const char* name, const char* set, std::size_t flows, const char* title) {
  const QuadrupleTank process(quadruple_tank_parameters(set));
  const TransferMatrix all = process.linearised(quadruple_tank_operating_point());
  TransferMatrix G(4, QuadrupleTank::kMvs + static_cast<Eigen::Index>(flows));
  for (Eigen::Index i = 0; i < G.rows(); ++i)
    for (Eigen::Index j = 0; j < G.cols(); ++j)
      G(i, j) = all(i, j);
  std::vector<PlantModel::Variable> mds;
  for (std::size_t i = 1; i <= flows; ++i)
    mds.push_back({fmt::format("F{}", i), "cm^3/s", fmt::format("External flow into tank {}", i)});
  return {.name = name,
          .title = title,
          .time_unit = "s",
          .cvs = {{"h1", "cm", "Level of tank 1"},
                  {"h2", "cm", "Level of tank 2"},
                  {"h3", "cm", "Level of tank 3, above tank 1"},
                  {"h4", "cm", "Level of tank 4, above tank 2"}},
          .mvs = {{"v1", "V", "Voltage of pump 1"},
                  {"v2", "V", "Voltage of pump 2"},
                  {"x1", "1", "Opening of the valve from pump 1 to tank 1"},
                  {"x2", "1", "Opening of the valve from pump 2 to tank 2"}},
          .mds = mds,
          .G = G};
}

}  // namespace

TransferMatrix QuadrupleTank::linearised(const Eigen::Ref<const Eigen::VectorXd>& u) const {
  const Eigen::VectorXd level = steady_state(u) + u.tail(kAdded);
  require_smooth(level, u);
  std::array<double, 4> slope{};  // dq_i/dh_i
  std::array<double, 4> rate{};   // 1 / time constant
  for (std::size_t i = 0; i < 4; ++i) {
    slope[i] = outflow_slope(i, level(static_cast<Eigen::Index>(i)));
    rate[i] = slope[i] / parameters_.area[i];
  }
  // d(flow into tank i) / d(input j): row i, column j.
  const double flow_1 = parameters_.pump[0] * u(0);
  const double flow_2 = parameters_.pump[1] * u(1);
  Eigen::MatrixXd into = Eigen::MatrixXd::Zero(4, kMvs + kFlows);
  into.leftCols(kMvs) << u(2) * parameters_.pump[0], 0, flow_1, 0,  //
      0, u(3) * parameters_.pump[1], 0, flow_2,                     //
      0, (1 - u(3)) * parameters_.pump[1], 0, -flow_2,              //
      (1 - u(2)) * parameters_.pump[0], 0, -flow_1, 0;
  into.rightCols(kFlows).setIdentity();

  TransferMatrix G(4, input_count());
  for (Eigen::Index j = 0; j < into.cols(); ++j)
    for (Eigen::Index i = 0; i < 4; ++i) {
      const auto t = static_cast<std::size_t>(i);
      // No input flows both into a tank and into the tank above it.
      if (into(i, j) != 0.0)
        G(i, j) = tank(constant(into(i, j) / parameters_.area[t]), rate[t]);
      else if (i < 2 && into(i + 2, j) != 0.0)
        G(i, j) =
            two_tanks(constant(into(i + 2, j) / parameters_.area[t + 2] * slope[t + 2] / parameters_.area[t]),
                      rate[t + 2], rate[t]);
    }
  for (Eigen::Index i = 0; i < kAdded; ++i) {
    const auto t = static_cast<std::size_t>(i);
    G(i, into.cols() + i) = tank(differentiated(1), rate[t]);
    if (i >= 2)
      G(i - 2, into.cols() + i) =
          two_tanks(differentiated(slope[t] / parameters_.area[t - 2]), rate[t], rate[t - 2]);
  }
  return G;
}

PlantModel quadruple_tank_table_2_6() {
  return linear_model("quadruple-tank", "table-2.6", 0,
                      "Quadruple tank, linearised with the parameters of table 2.6, 4 levels, 4 MVs");
}

PlantModel quadruple_tank_table_3_1() {
  return linear_model(
      "quadruple-tank-table-3.1", "table-3.1", 0,
      "Quadruple tank, linearised with the parameters of tables 3.1 and 5.9, 4 levels, 4 MVs");
}

PlantModel quadruple_tank_flows_table_2_6() {
  return linear_model("quadruple-tank-flows", "table-2.6", 2,
                      "Quadruple tank, parameters of table 2.6, 4 levels, 4 MVs, 2 external flows");
}

PlantModel quadruple_tank_flows_table_3_1() {
  return linear_model("quadruple-tank-flows-table-3.1", "table-3.1", 2,
                      "Quadruple tank, parameters of table 3.1, 4 levels, 4 MVs, 2 external flows");
}

}  // namespace mpm
