#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "plants/linear/linear_plant.hpp"
#include "tests/plants/plant_samples.hpp"

// Step responses and other outputs of LinearPlant against closed forms and against finer sampling.

namespace mpm {
namespace {

using samples::polynomial;

/// Compares the sampled unit step response of one channel with y(t) for t > 0 of its rational part.
void check_step(const TransferFunction& G, double Ts, const std::function<double(double)>& step,
                double tolerance) {
  const int count = 80;
  const Eigen::MatrixXd response = step_response(TransferMatrix{{G}}, Ts, count)[0];
  for (int k = 1; k <= count; ++k) {
    const double since = Ts * k - G.dead_time();
    // At the very sample at which the input arrives it has not yet acted; 1e-9 covers rounding of the dead
    // time.
    const double expected = since > 1e-9 * Ts * k ? step(since) : 0.0;
    INFO("sample " << k << ", dead time " << G.dead_time());
    CHECK(std::abs(response(0, k - 1) - expected) < tolerance);
  }
}

/// The same with dead times that are zero, whole, fractional, and whole only up to rounding.
void check_step_with_dead_times(const TransferFunction& rational, double Ts,
                                const std::function<double(double)>& step, double tolerance) {
  for (const double samples_of_dead_time : {0.0, 0.25, 0.999, 1.0, 3.0, 3.5, 12.7}) {
    check_step(rational.with_dead_time_shifted(samples_of_dead_time * Ts), Ts, step, tolerance);
  }
}

// Eighty steps of a stable recursion with roundings of 1e-16 relative to outputs of order one.
constexpr double kStable = 1e-12;

Eigen::MatrixXd repeat_columns(const Eigen::MatrixXd& inputs, Eigen::Index times) {
  Eigen::MatrixXd repeated(inputs.rows(), inputs.cols() * times);
  for (Eigen::Index k = 0; k < repeated.cols(); ++k) {
    repeated.col(k) = inputs.col(k / times);
  }
  return repeated;
}

}  // namespace

TEST_CASE("first-order steps follow the closed form at any dead time", "[linear_plant]") {
  for (double theta = 0; theta < 60; theta += 0.37) {
    check_step(
        TransferFunction::first_order(4.05, 50, theta), 4,
        [](double t) { return -4.05 * std::expm1(-t / 50); }, kStable);
  }
}

TEST_CASE("second-order steps follow partial fractions", "[linear_plant]") {
  const double T1 = 12;
  const double T2 = 3;
  check_step_with_dead_times(
      {polynomial({2}), polynomial({T1 * T2, T1 + T2, 1})}, 1.5,
      [=](double t) { return 2 - 2 * (T1 * std::exp(-t / T1) - T2 * std::exp(-t / T2)) / (T1 - T2); },
      kStable);
}

TEST_CASE("repeated poles step as their closed form", "[linear_plant]") {
  check_step_with_dead_times(
      {polynomial({1}), polynomial({25, 10, 1})}, 2,
      [](double t) { return 1 - (1 + t / 5) * std::exp(-t / 5); }, kStable);
  check_step_with_dead_times(
      {polynomial({1}), polynomial({125, 75, 15, 1})}, 2,
      [](double t) { return 1 - (1 + t / 5 + t * t / 50) * std::exp(-t / 5); }, kStable);
}

TEST_CASE("complex poles step as a damped oscillation", "[linear_plant]") {
  const double w = 0.4;   // natural frequency
  const double xi = 0.3;  // damping
  const double wd = w * std::sqrt(1 - xi * xi);
  check_step_with_dead_times(
      {polynomial({w * w}), polynomial({1, 2 * xi * w, w * w})}, 1,
      [=](double t) {
        return 1 - std::exp(-xi * w * t) * (std::cos(wd * t) + xi * w / wd * std::sin(wd * t));
      },
      kStable);
}

TEST_CASE("a right-half-plane zero gives an inverse response", "[linear_plant]") {
  // (1 - 8 s) / ((10 s + 1)(5 s + 1)): the step of the lag minus 8 times its derivative.
  const auto step = [](double t) {
    const double lag = 1 - (2 * std::exp(-t / 10) - std::exp(-t / 5));
    const double derivative = (std::exp(-t / 10) - std::exp(-t / 5)) / 5;
    return lag - 8 * derivative;
  };
  CHECK(step(2) < 0);
  check_step_with_dead_times({polynomial({-8, 1}), polynomial({50, 15, 1})}, 2, step, kStable);
}

TEST_CASE("integrators step as ramps and parabolas", "[linear_plant]") {
  // Outputs up to 1e2 and 1e4: eighty roundings of 1e-14 and 1e-12.
  check_step_with_dead_times(
      {polynomial({0.5}), polynomial({1, 0})}, 2, [](double t) { return 0.5 * t; }, 1e-11);
  check_step_with_dead_times(
      {polynomial({1}), polynomial({1, 0, 0})}, 2, [](double t) { return t * t / 2; }, 1e-8);
  check_step_with_dead_times(
      {polynomial({1}), polynomial({7, 1, 0})}, 2, [](double t) { return t + 7 * std::expm1(-t / 7); },
      1e-11);
}

TEST_CASE("biproper channels are sampled before their input jumps", "[linear_plant]") {
  check_step_with_dead_times(
      {polynomial({3, 1}), polynomial({6, 1})}, 2, [](double t) { return 1 - 0.5 * std::exp(-t / 6); },
      kStable);
  check_step_with_dead_times(
      {polynomial({4}), polynomial({1})}, 2, [](double) { return 4.0; }, kStable);

  const Eigen::RowVector3d input(1, 10, 100);
  const Eigen::MatrixXd gain = simulate(TransferMatrix{{{polynomial({4}), polynomial({1})}}}, 2, input);
  CHECK(gain == Eigen::RowVector3d(0, 4, 40));
}

TEST_CASE("an unstable pole grows as its closed form", "[linear_plant]") {
  // e^{40 / 5} is about 3e3, times eighty roundings.
  const Eigen::MatrixXd response =
      step_response(TransferMatrix{{{polynomial({1}), polynomial({5, -1}), 0.3}}}, 0.5, 80)[0];
  for (int k = 1; k <= 80; ++k) {
    CHECK(response(0, k - 1) == Approx(std::expm1((0.5 * k - 0.3) / 5)).epsilon(1e-11));
  }
}

TEST_CASE("holding the input over finer samples gives the same outputs", "[linear_plant]") {
  const TransferMatrix G = samples::mixed_matrix();
  const Eigen::MatrixXd inputs = samples::rough_input(4, 60);
  const Eigen::MatrixXd coarse = simulate(G, 2, inputs);
  for (const Eigen::Index times : {2, 5, 20}) {
    const Eigen::MatrixXd fine = simulate(G, 2.0 / static_cast<double>(times), repeat_columns(inputs, times));
    for (Eigen::Index k = 0; k < coarse.cols(); ++k) {
      // Outputs of order ten, at most 1200 stable steps.
      CHECK((fine.col(k * times) - coarse.col(k)).norm() < 1e-11);
    }
  }
}

TEST_CASE("time scaling stretches the response of the rational part", "[linear_plant]") {
  const double factor = 1.7;
  for (const TransferFunction& G : samples::every_kind()) {
    const TransferFunction rational = G.with_dead_time_shifted(-G.dead_time());
    const Eigen::MatrixXd original = step_response(TransferMatrix{{rational}}, 2, 50)[0];
    const Eigen::MatrixXd stretched =
        step_response(TransferMatrix{{rational.with_time_scaled(factor)}}, 2 * factor, 50)[0];
    CHECK((original - stretched).cwiseAbs().maxCoeff() < kStable);
  }
}

}  // namespace mpm
