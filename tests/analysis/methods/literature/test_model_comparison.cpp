#include <cstdint>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/methods/literature/model_comparison.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

using testing::settled_autoregression;

/// A period of 400 samples with two filters of an input of its own.
PlantAndNoise period(double a, std::uint64_t number, const Eigen::Vector2d& b = Eigen::Vector2d::Zero()) {
  const Eigen::VectorXd input = settled_autoregression(400, 0.9, 2 * number + 1);
  Eigen::MatrixXd X(400, 2);
  X.col(0) = filter(Eigen::VectorXd::Constant(1, 0.2), Eigen::Vector2d(1.0, -0.8), input, 1);
  X.col(1) = delayed(input, 2, StartState::rest);
  return {settled_autoregression(400, a, 2 * number) + X * b, X};
}

}  // namespace

TEST_CASE("model comparison: two periods of the same plant and noise differ as often as is said") {
  constexpr int kTrials = 1000;
  for (const double a : {0.0, 0.8}) {
    std::int64_t plant = 0, noise = 0, variance = 0;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      const ModelComparison of =
          compare_models(period(a, 70000 + trial), healthy_model(period(a, 80000 + trial)), 0.05);
      plant += of.plant > 1.0 ? 1 : 0;
      noise += of.noise_model > 1.0 ? 1 : 0;
      variance += of.noise_variance > 1.0 ? 1 : 0;
    }
    INFO("a = " << a << ": " << plant << ", " << noise << ", " << variance << " of " << kTrials);
    CHECK(testing::clopper_pearson_interval(plant, kTrials, 0.999).contains(0.05));
    CHECK(testing::clopper_pearson_interval(variance, kTrials, 0.999).contains(0.05));
    CHECK(testing::clopper_pearson_interval(noise, kTrials, 0.999).contains(0.05));
  }
}

TEST_CASE("model comparison: what changes is told: the plant, the noise model or the size of the noise") {
  const HealthyModel before = healthy_model(period(0.5, 90001));
  const auto changes = [&](const PlantAndNoise& now) {
    const ModelComparison of = compare_models(now, before, 0.001);
    return std::vector<bool>{of.plant > 1.0, of.noise_model > 1.0, of.noise_variance > 1.0};
  };
  CHECK(changes(period(0.5, 90002)) == std::vector<bool>{false, false, false});
  CHECK(changes(period(0.5, 90003, {0.5, 0.3})) == std::vector<bool>{true, false, false});
  CHECK(changes(period(0.95, 90004)) == std::vector<bool>{false, true, false});
  PlantAndNoise louder = period(0.5, 90005);
  louder.e *= 2.0;
  CHECK(changes(louder) == std::vector<bool>{false, false, true});
}

TEST_CASE("model comparison: the distances are those of the sum of the covariances") {
  const PlantAndNoise now = period(0.0, 90011, {0.1, 0.0}), before = period(0.0, 90012);
  // White errors have the order 0, so that the regression is an ordinary one with a constant, and F with many
  // degrees of freedom is that of 387; both by definition.
  const ModelComparison of = compare_models(now, healthy_model(before), 0.5);
  const auto estimate = [](const PlantAndNoise& each, Eigen::MatrixXd& covariance) -> Eigen::VectorXd {
    const Eigen::MatrixXd X = each.X.bottomRows(388);
    const Eigen::MatrixXd centred = X.rowwise() - X.colwise().mean();
    const Eigen::VectorXd e = each.e.tail(388).array() - each.e.tail(388).mean();
    const Eigen::MatrixXd inverse = (centred.transpose() * centred).inverse();
    Eigen::VectorXd b = inverse * (centred.transpose() * e);
    covariance = inverse * (e - centred * b).squaredNorm() / 385.0;
    return b;
  };
  Eigen::MatrixXd C, C_before;
  const Eigen::VectorXd difference = estimate(now, C) - estimate(before, C_before);
  const double distance = difference.dot((C + C_before).inverse() * difference) / 2.0;
  // The median of F(2, 385) is ln 2 to the second order of 1/385.
  CHECK(of.plant == Approx(distance / 0.6944).epsilon(0.003));
}

TEST_CASE("model comparison: an error of 0 has no noise to compare, and other regressors are refused") {
  PlantAndNoise silent = period(0.0, 90021);
  silent.e.setZero();
  CHECK(compare_models(silent, healthy_model(period(0.0, 90022)), 0.01).noise_variance == 0.0);
  PlantAndNoise other = period(0.0, 90023);
  other.X = Eigen::MatrixXd(other.X.leftCols(1));
  CHECK_THROWS_AS(compare_models(other, healthy_model(period(0.0, 90024)), 0.01), InputError);
}

}  // namespace mpm
