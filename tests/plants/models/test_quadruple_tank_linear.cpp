#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"
#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace mpm {
namespace {

/// gain and rate of a channel gain / (s + rate).
struct Lag {
  double gain, rate;
};

Lag lag(const TransferFunction& channel) {
  REQUIRE(channel.order() == 1);
  REQUIRE(channel.numerator().size() == 1);
  return {channel.numerator()(0) / channel.denominator()(0),
          channel.denominator()(1) / channel.denominator()(0)};
}

Eigen::VectorXd steady_difference(const QuadrupleTank& process, Eigen::Index input, double step) {
  Eigen::VectorXd up = quadruple_tank_operating_point();
  Eigen::VectorXd down = up;
  up(input) += step;
  down(input) -= step;
  Eigen::VectorXd high(4);
  Eigen::VectorXd low(4);
  process.output(process.steady_state(up), up, high);
  process.output(process.steady_state(down), down, low);
  return (high - low) / (2 * step);
}

}  // namespace

TEST_CASE("table 2.6 gives the levels and the entries that (2.31) prints right", "[quadruple-tank]") {
  const QuadrupleTank process(quadruple_tank_parameters("table-2.6"));
  const Eigen::VectorXd level = process.steady_state(quadruple_tank_operating_point());
  const Eigen::Vector4d printed(12.593, 13.423, 4.730, 5.145);
  CHECK((level - printed).lpNorm<Eigen::Infinity>() <= 0.5e-3);  // half a unit of the last digit

  const TransferMatrix G = benchmark_plant("quadruple-tank").G;
  const auto last = 0.5e-3 + 1e-4;  // printed to three decimals, some of them cut off
  CHECK(std::abs(lag(G(0, 0)).gain - 0.048) <= last);
  CHECK(std::abs(lag(G(0, 0)).rate - 0.016) <= last);
  CHECK(std::abs(lag(G(0, 2)).gain - 0.359) <= last);
  CHECK(std::abs(lag(G(1, 1)).gain - 0.035) <= last);
  CHECK(std::abs(lag(G(1, 1)).rate - 0.011) <= last);
  CHECK(std::abs(lag(G(1, 3)).gain - 0.324) <= last);
  CHECK(std::abs(lag(G(2, 1)).gain - 0.078) <= last);
  CHECK(std::abs(lag(G(2, 3)).gain + 0.370) <= last);
  CHECK(std::abs(lag(G(2, 3)).rate - 0.026) <= last);
  CHECK(std::abs(lag(G(3, 2)).gain + 0.314) <= last);
  const TransferFunction& through = G(1, 2);  // -0.0055 / (s^2 + 0.0282 s + 0.00019)
  CHECK(std::abs(through.numerator()(0) + 0.0055) <= 0.5e-4);
  CHECK(std::abs(through.denominator()(1) - 0.0282) <= 0.5e-4);
  CHECK(std::abs(through.denominator()(2) - 0.00019) <= 0.5e-5);
  CHECK(G(2, 0).is_zero());
  CHECK(G(2, 2).is_zero());
  CHECK(G(3, 1).is_zero());
  CHECK(G(3, 3).is_zero());
}

TEST_CASE("the parameters of table 3.1 do not give them", "[quadruple-tank]") {
  const TransferMatrix G = benchmark_plant("quadruple-tank-table-3.1").G;
  CHECK(std::abs(lag(G(0, 0)).gain - 0.048) > 1e-3);
  CHECK(std::abs(lag(G(2, 3)).gain + 0.370) > 1e-2);
}

TEST_CASE("the linearisation has the static gains of the nonlinear steady states", "[quadruple-tank]") {
  for (const std::string& set : quadruple_tank_parameter_sets()) {
    const QuadrupleTank process(
        with_parameter(with_parameter(quadruple_tank_parameters(set), "exp1", 0.7), "cd4", 4.0));
    const Eigen::MatrixXd gain = process.linearised(quadruple_tank_operating_point()).static_gain();
    for (Eigen::Index j = 0; j < 12; ++j) {
      INFO(set << ", input " << j);
      // Central differences with a step of 1e-4: 1e-8 relative, and rounding of 1e-15 / 1e-4.
      CHECK((gain.col(j) - steady_difference(process, j, 1e-4)).lpNorm<Eigen::Infinity>() < 1e-6);
    }
  }
}

TEST_CASE("a small step of the nonlinear plant is the step of its linearisation", "[quadruple-tank]") {
  const auto process = std::make_shared<QuadrupleTank>(quadruple_tank_parameters("table-2.6"));
  const Eigen::VectorXd u = quadruple_tank_operating_point();
  const auto linear = step_response(process->linearised(u), 10.0, 40);
  const double step = 1e-3;
  const OdeOptions accurate{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13};
  for (Eigen::Index j = 0; j < 12; ++j) {
    Eigen::MatrixXd response[2];
    for (const int sign : {0, 1}) {  // up and down: their mean has no second-order part
      DeviationPlant plant(std::make_unique<OdePlant>(process, 10.0, accurate), u);
      Eigen::VectorXd input = Eigen::VectorXd::Zero(12);
      input(j) = sign == 0 ? step : -step;
      response[sign].resize(4, 40);
      for (Eigen::Index k = 0; k < 40; ++k) {
        REQUIRE(plant.advance(input) == PlantStatus::ok);
        response[sign].col(k) = plant.output() / input(j);
      }
    }
    const Eigen::MatrixXd mean = 0.5 * (response[0] + response[1]);
    INFO("input " << j);
    // Third-order part: step^2 relative to responses of up to 25; integration: some 1e-9 / step.
    CHECK((mean - linear[static_cast<std::size_t>(j)]).cwiseAbs().maxCoeff() < 1e-5);
  }
}

TEST_CASE("there is no linearisation at a kink", "[quadruple-tank]") {
  using Catch::Contains;
  const QuadrupleTank process(quadruple_tank_parameters("table-2.6"));
  Eigen::VectorXd u = quadruple_tank_operating_point();
  u(0) = 0;
  CHECK_THROWS_WITH(process.linearised(u), Contains("v1 to linearise at"));
  u(0) = 3;
  u(3) = 1;
  CHECK_THROWS_WITH(process.linearised(u), Contains("x2 to linearise at"));
  u(3) = 1 - 1e-9;
  CHECK_THROWS_WITH(process.linearised(u), Contains("h3 to linearise at"));
}

TEST_CASE("deviation variables are those of the plant less its operating point", "[deviation-plant]") {
  const auto process = std::make_shared<QuadrupleTank>(quadruple_tank_parameters("table-3.1"));
  const Eigen::VectorXd u = quadruple_tank_operating_point();
  OdePlant plain(process, 10.0);
  DeviationPlant plant(std::make_unique<OdePlant>(process, 10.0), u);
  CHECK(plant.output() == Eigen::VectorXd::Zero(4));
  CHECK(plant.sample_time() == 10.0);
  Eigen::VectorXd du = Eigen::VectorXd::Zero(12);
  du(0) = 0.3;
  plain.reset(u + du);
  plant.reset(du);
  du(2) = -0.1;
  CHECK(plain.advance(u + du) == PlantStatus::ok);
  CHECK(plant.advance(du) == PlantStatus::ok);
  CHECK((plant.output() + process->steady_state(u) - plain.output()).lpNorm<Eigen::Infinity>() < 1e-14);
  CHECK_THROWS_AS(plant.advance(Eigen::VectorXd::Zero(4)), InputError);
  CHECK_THROWS_AS(plant.reset(Eigen::VectorXd::Zero(4)), InputError);
  CHECK_THROWS_WITH(DeviationPlant(nullptr, u), Catch::Contains("plant"));
}

}  // namespace mpm
