#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace mpm {
namespace {

constexpr double kLevelTolerance =
    1e-7;  // cm: 100 times the tolerance of the integration at levels of some cm

std::shared_ptr<const QuadrupleTank> tank(const std::string& set = "table-2.6") {
  return std::make_shared<QuadrupleTank>(quadruple_tank_parameters(set));
}

Eigen::VectorXd no_pumps() {
  return Eigen::VectorXd::Zero(12);
}

Eigen::VectorXd derivative(const QuadrupleTank& process, const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  Eigen::VectorXd dx(4);
  process.derivative(x, u, dx);
  return dx;
}

/// What flows into the system less what leaves it from tanks 1 and 2, cm^3/s; levels above kShallow.
double net_flow(const QuadrupleTankParameters& p, const Eigen::VectorXd& h, const Eigen::VectorXd& u) {
  return p.pump[0] * u(0) + p.pump[1] * u(1) + u.segment(4, 4).sum() -
         p.discharge[0] * std::pow(h(0), p.exponent[0]) - p.discharge[1] * std::pow(h(1), p.exponent[1]);
}

double volume(const QuadrupleTankParameters& p, const Eigen::VectorXd& h) {
  return Eigen::Map<const Eigen::Vector4d>(p.area.data()).dot(h);
}

}  // namespace

TEST_CASE("a tank without inflow drains as Torricelli's law has it", "[quadruple-tank]") {
  // A dh/dt = -cd h^n has h^(1-n) = h_0^(1-n) - (1-n) cd/A t.
  const double exponent = GENERATE(0.5, 0.1, 0.85);
  QuadrupleTankParameters p = with_parameter(quadruple_tank_parameters("table-2.6"), "exp3", exponent);
  OdePlant plant(std::make_shared<QuadrupleTank>(p), 5.0);
  plant.set_state(Eigen::Vector4d(0, 0, 9, 4));
  for (int k = 1; k <= 8; ++k) {
    REQUIRE(plant.advance(no_pumps()) == PlantStatus::ok);
    const double root = std::pow(9.0, 1 - exponent) - (1 - exponent) * p.discharge[2] / p.area[2] * 5.0 * k;
    REQUIRE(root > 0);
    INFO("exponent " << exponent << ", sample " << k);
    CHECK(std::abs(plant.output()(2) - std::pow(root, 1 / (1 - exponent))) < kLevelTolerance);
    CHECK(std::abs(std::sqrt(plant.output()(3)) - (2 - p.discharge[3] / (2 * p.area[3]) * 5.0 * k)) < 1e-7);
  }
}

TEST_CASE("no level is ever negative, whatever is taken out", "[quadruple-tank]") {
  OdePlant plant(tank(), 10.0);
  plant.set_state(Eigen::Vector4d(1, 1, 0.5, 0.5));
  Eigen::VectorXd u = no_pumps();
  u.segment(4, 4).setConstant(-5);  // cm^3/s out of each tank
  for (int k = 0; k < 30; ++k) {
    REQUIRE(plant.advance(u) == PlantStatus::ok);
    CHECK(plant.output().minCoeff() >= 0);
    CHECK(plant.state().minCoeff() > -1e-8);  // 100 times the absolute tolerance
  }
  CHECK(plant.output().maxCoeff() < 1e-6);  // all empty
  u = quadruple_tank_operating_point();
  for (int k = 0; k < 200; ++k)
    REQUIRE(plant.advance(u) == PlantStatus::ok);
  CHECK((plant.output() - tank()->steady_state(u)).lpNorm<Eigen::Infinity>() < 1e-6);  // filled again
}

TEST_CASE("pumps do not suck and valves do not open beyond their ends", "[quadruple-tank]") {
  const Eigen::Vector4d h(3, 4, 5, 6);
  Eigen::VectorXd beyond = no_pumps();
  beyond.head(4) << -2, 3, 0.5, 1.4;
  Eigen::VectorXd within = no_pumps();
  within.head(4) << 0, 3, 0.5, 1;
  CHECK(derivative(*tank(), h, beyond) == derivative(*tank(), h, within));
}

TEST_CASE("the volume changes by what flows in and out of the system", "[quadruple-tank]") {
  const QuadrupleTankParameters p = quadruple_tank_parameters("table-3.1");
  const QuadrupleTank process(p);
  Eigen::VectorXd u = quadruple_tank_operating_point();
  u.segment(4, 4) << 1, -0.5, 0.7, 0.2;
  for (const double level : {0.01, 1.0, 7.0}) {  // at a point: rounding only
    const Eigen::VectorXd h = level * Eigen::Vector4d(1, 2, 0.5, 1.5);
    CHECK(std::abs(volume(p, derivative(process, h, u)) - net_flow(p, h, u)) < 1e-13);
  }

  const double step = 0.5;  // along a solution, the flow by Simpson's rule: error of step^4 / 180, 200 s
  OdePlant plant(tank("table-3.1"), step);
  plant.set_state(Eigen::Vector4d(5, 4, 3, 2));
  const double before = volume(p, plant.state());
  double flow = 0;
  for (int k = 0; k < 200; ++k) {
    const double first = net_flow(p, plant.state(), u);
    REQUIRE(plant.advance(u) == PlantStatus::ok);
    const double middle = net_flow(p, plant.state(), u);
    REQUIRE(plant.advance(u) == PlantStatus::ok);
    flow += step / 3 * (first + 4 * middle + net_flow(p, plant.state(), u));
  }
  CHECK(std::abs(volume(p, plant.state()) - before - flow) < 1e-5);
}

TEST_CASE("the Jacobian is the derivative of the right side, shallow levels included", "[quadruple-tank]") {
  const QuadrupleTank process(
      with_parameter(with_parameter(quadruple_tank_parameters("table-2.6"), "exp2", 0.85), "exp4", 1.3));
  Eigen::VectorXd u = quadruple_tank_operating_point();
  u.segment(4, 4) << -1, 2, -3, 4;
  u.tail(4) << 1, -0.5, 2, 0;
  const double e = QuadrupleTank::kShallow;
  for (const double level : {5.0, 0.1, 0.6 * e, 0.01 * e, -0.3 * e}) {
    const Eigen::VectorXd h = level * Eigen::Vector4d(1, 1.2, 0.9, 1.1) - u.tail(4);
    Eigen::MatrixXd J(4, 4);
    process.jacobian(h, u, J);
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double step = 1e-4 * std::abs(level);
      Eigen::VectorXd up = h;
      Eigen::VectorXd down = h;
      up(j) += step;
      down(j) -= step;
      const Eigen::VectorXd slope = (derivative(process, up, u) - derivative(process, down, u)) / (2 * step);
      INFO("level " << level << ", column " << j);
      // Central differences: step^2 relative, and rounding of 1e-16 / step.
      CHECK((J.col(j) - slope).lpNorm<Eigen::Infinity>() < 1e-6 * (1 + J.col(j).lpNorm<Eigen::Infinity>()));
    }
  }
}

TEST_CASE("the outlet of a nearly empty tank goes over smoothly into the power law", "[quadruple-tank]") {
  const double exponent = GENERATE(0.1, 0.5, 0.85, 1.5);
  const QuadrupleTank process(with_parameter(quadruple_tank_parameters("table-2.6"), "exp4", exponent));
  const double e = QuadrupleTank::kShallow;
  const auto rate = [&](double level) {
    return derivative(process, Eigen::Vector4d(1, 1, 1, level), no_pumps())(3);
  };
  const double h = 1e-6 * e;
  const double at = rate(e);
  CHECK(std::abs(rate(e - h) - at) < 3e-6 * std::abs(at));              // no jump
  CHECK(std::abs((at - rate(e - h)) / (rate(e + h) - at) - 1) < 1e-4);  // nor one of the slope
  CHECK(rate(0) == 0);
  CHECK(rate(-0.5 * e) == 0);
}

TEST_CASE("the steady state is one", "[quadruple-tank]") {
  for (const std::string& set : quadruple_tank_parameter_sets()) {
    const QuadrupleTank process(
        with_parameter(with_parameter(quadruple_tank_parameters(set), "exp3", 0.1), "exp2", 0.85));
    Eigen::VectorXd u = quadruple_tank_operating_point();
    u.segment(4, 4) << 1, -2, 0.5, 0;
    u.tail(4) << -1, 0, 2, 1;
    CHECK(derivative(process, process.steady_state(u), u).lpNorm<Eigen::Infinity>() < 1e-13);
    for (const double voltage : {0.0, 1e-4, 1e-3}) {  // nearly empty tanks
      u = no_pumps();
      u.head(4) << voltage, 2 * voltage, 0.5, 0.5;
      CHECK(derivative(process, process.steady_state(u), u).lpNorm<Eigen::Infinity>() < 1e-15);
    }
  }
  Eigen::VectorXd u = no_pumps();
  u(4) = -1;
  CHECK_THROWS_AS(tank()->steady_state(u), NoSteadyState);
  CHECK_THROWS_WITH(tank()->steady_state(u), Catch::Contains("tank 1") && Catch::Contains("-1 cm^3/s"));
  u(6) = 1.00001;
  CHECK_THROWS_WITH(tank()->steady_state(u), Catch::Contains("steady level of tank 1"));
}

TEST_CASE("parameters are selected and changed by name", "[quadruple-tank]") {
  const QuadrupleTankParameters p = quadruple_tank_parameters("table-2.6");
  CHECK(p.pump[0] == 3.14);
  CHECK(p.area[1] == 32);
  CHECK(quadruple_tank_parameters("table-3.1").pump[1] == 3.35);
  CHECK(quadruple_tank_parameters("table-3.1").area[1] == 28);
  const QuadrupleTankParameters m1 = with_parameter(p, "cd2", 6.47);  // M1 of table 2.8
  CHECK(m1.discharge[1] == 6.47);
  CHECK(m1.discharge[0] == p.discharge[0]);
  CHECK(with_parameter(p, "A3", 182).area[2] == 182);
  CHECK(with_parameter(p, "k2", 3).pump[1] == 3);
  using Catch::Contains;
  CHECK_THROWS_WITH(quadruple_tank_parameters("table-9"), Contains("\"table-9\"") && Contains("table-3.1"));
  CHECK_THROWS_WITH(with_parameter(p, "cd5", 1), Contains("\"cd5\"") && Contains("cd4"));
  CHECK_THROWS_WITH(with_parameter(p, "A1", -28), Contains("A1 of the quadruple tank") && Contains("-28"));
  CHECK_THROWS_WITH(with_parameter(p, "exp4", 2), Contains("below 2"));
  CHECK_THROWS_AS(with_parameter(p, "cd1", NAN), InputError);
}

}  // namespace mpm
