#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/nonlinear/ode_integrator.hpp"
#include "plants/nonlinear/ode_plant.hpp"

namespace mpm {
namespace {

/// A damped oscillator x'' + 2 xi x' + x = u, whose solution is known.
class Oscillator : public OdeSystem {
 public:
  static constexpr double kDamping = 0.1;

  Eigen::Index state_count() const override { return 2; }
  Eigen::Index input_count() const override { return 1; }
  Eigen::Index output_count() const override { return 1; }
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    dx << x(1), u(0) - x(0) - 2 * kDamping * x(1);
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>&, const Eigen::Ref<const Eigen::VectorXd>&,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    J << 0, 1, -1, -2 * kDamping;
  }
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>&,
              Eigen::Ref<Eigen::VectorXd> y) const override {
    y(0) = x(0);
  }
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    return Eigen::Vector2d(u(0), 0);
  }

  /// The state after the time t under the constant input u.
  static Eigen::Vector2d exact(const Eigen::Vector2d& start, double u, double t) {
    const double frequency = std::sqrt(1 - kDamping * kDamping);
    const double a = start(0) - u;
    const double b = (start(1) + kDamping * a) / frequency;
    const double cosine = std::cos(frequency * t);
    const double sine = std::sin(frequency * t);
    const double decay = std::exp(-kDamping * t);
    return {u + decay * (a * cosine + b * sine),
            decay * ((b * frequency - kDamping * a) * cosine - (a * frequency + kDamping * b) * sine)};
  }
};

/// Counts what the integrator asks for.
class CountedOscillator final : public Oscillator {
 public:
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    ++derivatives;
    Oscillator::derivative(x, u, dx);
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    ++jacobians;
    Oscillator::jacobian(x, u, J);
  }

  mutable int derivatives = 0;
  mutable int jacobians = 0;
};

/// dx/dt = x^2 from 1 has no solution beyond t = 1.
class Explosion final : public OdeSystem {
 public:
  Eigen::Index state_count() const override { return 1; }
  Eigen::Index input_count() const override { return 0; }
  Eigen::Index output_count() const override { return 1; }
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>&,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    dx(0) = x(0) * x(0);
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>&,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    J(0, 0) = 2 * x(0);
  }
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>&,
              Eigen::Ref<Eigen::VectorXd> y) const override {
    y = x;
  }
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>&) const override {
    return Eigen::VectorXd::Zero(1);
  }
};

Eigen::VectorXd input(double u) {
  return Eigen::VectorXd::Constant(1, u);
}

/// What a tenth of a second under the input `u` costs.
int derivatives_of(OdeIntegrator& integrator, const CountedOscillator& system, double u) {
  const int before = system.derivatives;
  REQUIRE(integrator.advance(input(u), 0.1) == OdeStatus::ok);
  return system.derivatives - before;
}

/// Largest error over 20 samples of 0.7 with an input that jumps at every second one.
double square_wave_error(OdeMethod method, double tolerance) {
  OdeIntegrator integrator(
      std::make_shared<Oscillator>(),
      {.method = method, .relative_tolerance = tolerance, .absolute_tolerance = tolerance});
  Eigen::Vector2d exact(1, 0);
  integrator.reset(exact);
  double error = 0;
  for (int k = 0; k < 20; ++k) {
    const double u = k / 2 % 2 == 0 ? 1.0 : -1.0;
    REQUIRE(integrator.advance(input(u), 0.7) == OdeStatus::ok);
    exact = Oscillator::exact(exact, u, 0.7);
    error = std::max(error, (integrator.state() - exact).lpNorm<Eigen::Infinity>());
  }
  return error;
}

/// What two threads may call: an output is not a number where a step fails.
std::vector<double> recorded(double gain, OdeMethod method) {
  OdePlant plant(std::make_shared<Oscillator>(), 0.5, {.method = method});
  std::vector<double> outputs;
  for (int k = 0; k < 400; ++k) {
    const bool advances = plant.advance(input(gain * std::sin(0.3 * k))) == PlantStatus::ok;
    outputs.push_back(advances ? plant.output()(0) : kNaN);
  }
  return outputs;
}

}  // namespace

TEST_CASE("a linear system is integrated to within its tolerance, also over jumps of the input", "[ode]") {
  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  double last = 1;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const double error = square_wave_error(method, tolerance);
    INFO("tolerance " << tolerance << ", error " << error << ", before " << last);
    // The tolerance bounds the local error; that of some hundred steps adds up, partly damped.
    CHECK(error < 300 * tolerance);
    CHECK(error < 0.1 * last);  // two more digits asked for, at least one had
    last = error;
  }
}

TEST_CASE("backward differentiation begins anew where the input changes, and only there", "[ode]") {
  const auto system = std::make_shared<CountedOscillator>();
  OdeIntegrator integrator(system, {.method = OdeMethod::bdf});
  integrator.reset(Eigen::Vector2d(1, 0));
  // Order 1 needs many short steps; what goes on at a high order passes a tenth of a second in a few.
  derivatives_of(integrator, *system, 0);
  const int going_on = derivatives_of(integrator, *system, 0);
  REQUIRE(going_on > 0);
  CHECK(derivatives_of(integrator, *system, 0) < 2 * going_on + 2);
  CHECK(derivatives_of(integrator, *system, 2) > 4 * going_on);
  CHECK(derivatives_of(integrator, *system, 2) < 2 * going_on + 2);
  CHECK(derivatives_of(integrator, *system, 0) > 4 * going_on);
  integrator.reset(integrator.state());
  CHECK(derivatives_of(integrator, *system, 0) > 4 * going_on);
  CHECK(system->jacobians > 0);  // Newton's method has the analytic one
}

TEST_CASE("a jump of the input costs Runge-Kutta nothing", "[ode]") {
  const auto system = std::make_shared<CountedOscillator>();
  OdeIntegrator integrator(system, {});
  integrator.reset(Eigen::Vector2d(1, 0));
  derivatives_of(integrator, *system, 0);  // finds the length of a step
  const int going_on = derivatives_of(integrator, *system, 0);
  REQUIRE(going_on > 0);
  for (const double u : {2.0, -2.0, 0.5})
    CHECK(derivatives_of(integrator, *system, u) <= 2 * going_on);
}

TEST_CASE("an integrator that is used again gives the bits of a new one", "[ode]") {
  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  const auto run = [](OdeIntegrator& integrator) {
    integrator.reset(Eigen::Vector2d(1, 0));
    for (int k = 0; k < 20; ++k)
      REQUIRE(integrator.advance(input(std::sin(0.3 * k)), 0.7) == OdeStatus::ok);
    return Eigen::Vector2d(integrator.state());
  };
  OdeIntegrator used(std::make_shared<Oscillator>(), {.method = method});
  const Eigen::Vector2d first = run(used);
  REQUIRE(used.advance(input(5), 30) == OdeStatus::ok);
  CHECK(run(used) == first);
}

TEST_CASE("samples of any length add up to the same time", "[ode]") {
  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  for (const double duration : {0.1, 1.0, 7.0}) {
    OdeIntegrator integrator(std::make_shared<Oscillator>(), {.method = method});
    integrator.reset(Eigen::Vector2d(1, 0));
    for (int k = 0; k < std::lround(7.0 / duration); ++k)
      REQUIRE(integrator.advance(input(0.5), duration) == OdeStatus::ok);
    const Eigen::Vector2d exact = Oscillator::exact({1, 0}, 0.5, 7);
    CHECK((integrator.state() - exact).lpNorm<Eigen::Infinity>() < 1e-7);  // 100 times the tolerance
  }
}

TEST_CASE("a solution that does not exist is a status, and reset recovers from it", "[ode]") {
  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  OdeIntegrator integrator(std::make_shared<Explosion>(), {.method = method, .step_limit = 2000});
  const Eigen::VectorXd none(0);
  integrator.reset(Eigen::VectorXd::Ones(1));
  CHECK(integrator.advance(none, 2) != OdeStatus::ok);
  integrator.reset(Eigen::VectorXd::Ones(1));
  CHECK(integrator.advance(none, 0.5) == OdeStatus::ok);
  CHECK(std::abs(integrator.state()(0) - 2) < 1e-6);  // 1 / (1 - t)

  OdeIntegrator hurried(std::make_shared<Explosion>(), {.method = method, .step_limit = 3});
  hurried.reset(Eigen::VectorXd::Ones(1));
  CHECK(hurried.advance(none, 0.5) == OdeStatus::step_limit);
}

TEST_CASE("integrators in different threads are independent", "[ode]") {
  const OdeMethod method = GENERATE(OdeMethod::runge_kutta, OdeMethod::bdf);
  const std::vector<double> expected_a = recorded(1.0, method);
  const std::vector<double> expected_b = recorded(-3.0, method);
  for (int repetition = 0; repetition < 5; ++repetition) {
    std::vector<double> a;
    std::vector<double> b;
    std::thread first([&] { a = recorded(1.0, method); });
    std::thread second([&] { b = recorded(-3.0, method); });
    first.join();
    second.join();
    CHECK(a == expected_a);  // bit for bit
    CHECK(b == expected_b);
  }
}

TEST_CASE("an ODE plant starts from a steady state and stays there", "[ode]") {
  OdePlant plant(std::make_shared<Oscillator>(), 2.5);
  CHECK(plant.sample_time() == 2.5);
  plant.reset(input(3));
  CHECK(plant.output()(0) == 3);
  for (int k = 0; k < 10; ++k)
    REQUIRE(plant.advance(input(3)) == PlantStatus::ok);
  CHECK(std::abs(plant.output()(0) - 3) < 1e-9);
}

TEST_CASE("what cannot be integrated is refused with its name", "[ode]") {
  using Catch::Contains;
  const auto system = std::make_shared<Oscillator>();
  CHECK_THROWS_WITH(OdeIntegrator(nullptr, {}), Contains("system"));
  CHECK_THROWS_WITH(OdeIntegrator(system, {.relative_tolerance = 1e-16}), Contains("relative_tolerance"));
  CHECK_THROWS_WITH(OdeIntegrator(system, {.absolute_tolerance = 0}), Contains("absolute_tolerance"));
  CHECK_THROWS_WITH(OdeIntegrator(system, {.step_limit = 0}), Contains("step_limit"));
  CHECK_THROWS_WITH(OdePlant(system, 0), Contains("sample time"));
  OdeIntegrator integrator(system, {});
  CHECK_THROWS_WITH(integrator.reset(Eigen::Vector3d::Zero()), Contains("3 numbers"));
  CHECK_THROWS_WITH(integrator.reset(Eigen::Vector2d(NAN, 0)), Contains("not finite"));
  CHECK_THROWS_WITH(integrator.advance(Eigen::Vector2d::Zero(), 1), Contains("plant inputs"));
  CHECK_THROWS_WITH(integrator.advance(input(INFINITY), 1), Contains("not finite"));
  CHECK_THROWS_WITH(integrator.advance(input(0), 0), Contains("duration"));
  OdePlant plant(system, 1);
  CHECK_THROWS_WITH(plant.reset(Eigen::Vector2d::Zero()), Contains("number of plant inputs"));
}

}  // namespace mpm
