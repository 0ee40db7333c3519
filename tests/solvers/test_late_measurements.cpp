#include <algorithm>

#include <catch2/catch.hpp>

#include "solvers/late_measurements.hpp"
#include "tests/solvers/small_loop.hpp"

namespace mpm {

TEST_CASE("a model that learns late of an MD has in the end the outputs of one that knew it at once",
          "[late_measurements]") {
  const auto timing = GENERATE(AnalyserTiming{1, 4}, AnalyserTiming{3, 5}, AnalyserTiming{4, 0});
  constexpr Eigen::Index kSamples = 60, kLastMove = 40;
  LinearPlant at_once(samples::small_model(), 2.0), model = at_once;
  LateMeasurements late(model, 2, {timing});
  Eigen::MatrixXd inputs(3, kSamples);
  inputs.row(0).setLinSpaced(0.0, 9.0);
  inputs.row(1) = inputs.row(0).array().sin();
  inputs.row(2) = (3.0 * inputs.row(0).array()).cos();
  inputs.row(2).tail(kSamples - kLastMove).setConstant(0.7);
  // The MD moves when it is measured, so that nothing is lost between two measurements.
  for (Eigen::Index k = 0; k < kSamples; ++k)
    inputs(2, k) = inputs(2, k / timing.period * timing.period);
  const Eigen::VectorXd rest = Eigen::Vector3d(0.2, -0.3, 0.5);
  Eigen::MatrixXd told = as_shown({timing}, inputs.row(2), rest.tail(1));
  at_once.reset(rest);
  model.reset(rest);
  late.reset(model, rest);
  double largest = 0.0;
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    late.correct(told.col(k), model);
    const double error = (model.output() - at_once.output()).cwiseAbs().maxCoeff();
    largest = std::max(largest, error);
    if (k >= kLastMove + timing.period + timing.delay)
      CHECK(error < 1e-12);
    at_once.advance(inputs.col(k));
    const Eigen::Vector3d known(inputs(0, k), inputs(1, k), told(0, k));
    model.advance(known);
    late.advance(known);
  }
  CHECK((largest > 0.01) == (timing.delay > 0));
}

}  // namespace mpm
