#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/identification/least_squares.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

using testing::clopper_pearson_interval;
using testing::settled_autoregression;
using testing::white_noise;

/// An input that stays at random levels for some 30 samples each.
Eigen::VectorXd levels(Eigen::Index samples, std::uint64_t number) {
  const Eigen::VectorXd noise = white_noise(samples, number);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(samples);
  for (Eigen::Index k = 1; k < samples; ++k)
    input(k) = k % 30 == 0 ? noise(k) : input(k - 1);
  return input;
}

/// Two strictly delayed filters of the input.
Eigen::MatrixXd responses(const Eigen::VectorXd& input) {
  Eigen::MatrixXd X(input.size(), 2);
  X.col(0) = filter(Eigen::VectorXd::Constant(1, 0.1), Eigen::Vector2d(1.0, -0.9), input, 1);
  X.col(1) = filter(Eigen::VectorXd::Constant(1, 0.3), Eigen::Vector2d(1.0, -0.7), input, 3);
  return X;
}

/// The residual sum of the regression of e on a constant, its last p samples and these columns, by
/// definition.
double residual_sum(const Eigen::VectorXd& e, Eigen::Index p, const Eigen::MatrixXd& columns) {
  const Eigen::Index n = e.size() - kHighestNoiseOrder;
  Eigen::MatrixXd A(n, 1 + p + columns.cols());
  A.col(0).setOnes();
  for (Eigen::Index lag = 1; lag <= p; ++lag)
    A.col(lag) = e.segment(kHighestNoiseOrder - lag, n);
  A.rightCols(columns.cols()) = columns.bottomRows(n);
  return least_squares(A, e.tail(n)).residual_sum;
}

}  // namespace

TEST_CASE("prewhitened groups: the ratios are those of least squares with and without each group") {
  const Eigen::VectorXd e = settled_autoregression(200, 0.8, 51) + white_noise(200, 52);
  const std::vector<Eigen::MatrixXd> groups{responses(levels(200, 53)), responses(levels(200, 54))};
  const PrewhitenedGroups found = prewhitened_groups(e, groups);
  const Eigen::Index p = found.noise.order();
  CHECK(p > 0);
  Eigen::MatrixXd both(200, 4);
  for (Eigen::Index column = 0; column < 4; ++column)
    both.col(column) = filter(found.noise.D, found.noise.C, groups[column < 2 ? 0 : 1].col(column % 2));
  const double none = residual_sum(e, p, Eigen::MatrixXd(200, 0));
  const double all = residual_sum(e, p, both);
  CHECK(found.freedom == 200 - kHighestNoiseOrder - 1 - p - 4);
  CHECK(found.variance == Approx(all / static_cast<double>(found.freedom)));
  CHECK(found.joint_ratio() == Approx((none - all) / (4.0 * found.variance)));
  CHECK(found.ratio(1) == Approx((none - residual_sum(e, p, both.rightCols(2))) / (2.0 * found.variance)));
  CHECK(found.partial_ratio(1) ==
        Approx((residual_sum(e, p, both.leftCols(2)) - all) / (2.0 * found.variance)));
}

TEST_CASE("prewhitened groups: independent white and coloured errors are rejected as often as is said") {
  constexpr int kTrials = 1000;
  for (const double a : {0.0, 0.9}) {
    std::int64_t single = 0, joint = 0;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      const Eigen::VectorXd e = settled_autoregression(400, a, 910000 + trial);
      const PrewhitenedGroups found = prewhitened_groups(
          e, {responses(levels(400, 920000 + trial)), responses(levels(400, 930000 + trial))});
      single += found.ratio(0) > found.critical_ratio(0, 0.05) ? 1 : 0;
      joint += found.joint_ratio() > found.critical_ratio_of(found.rank, 0.05) ? 1 : 0;
    }
    INFO("a = " << a << ": " << single << " and " << joint << " of " << kTrials);
    CHECK(clopper_pearson_interval(single, kTrials, 0.999).contains(0.05));
    CHECK(clopper_pearson_interval(joint, kTrials, 0.999).contains(0.05));
  }
}

TEST_CASE("prewhitened groups: the coefficients of a mismatch under coloured noise are found") {
  const std::vector<Eigen::MatrixXd> groups{responses(levels(2000, 61)), responses(levels(2000, 62))};
  const Eigen::VectorXd e =
      0.01 * settled_autoregression(2000, 0.9, 63) + groups[1] * Eigen::Vector2d(0.5, -0.25);
  const PrewhitenedGroups found = refined_groups(e, groups);
  const Eigen::VectorXd b = found.coefficients();
  // Five deviations of the coefficient of least certainty, from (X'X)^-1 sigma^2.
  CHECK((b - Eigen::Vector4d(0.0, 0.0, 0.5, -0.25)).lpNorm<Eigen::Infinity>() < 0.02);
  CHECK(found.noise.D(1) == Approx(-0.9).margin(0.05));  // two deviations of 1/sqrt(2000)
  CHECK(found.ratio(1) > 100.0 * found.critical_ratio(1, 0.01));
}

TEST_CASE("prewhitened groups: an input at rest and an error of 0 explain and need nothing") {
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(100, 2);
  const PrewhitenedGroups at_rest = prewhitened_groups(white_noise(100, 71), {rest});
  CHECK(at_rest.rank == 0);
  CHECK(at_rest.ratio(0) == 0.0);
  CHECK(at_rest.critical_ratio(0, 0.05) > 1e300);
  const PrewhitenedGroups perfect =
      prewhitened_groups(Eigen::VectorXd::Zero(100), {responses(levels(100, 72))});
  CHECK(perfect.variance == 0.0);
  CHECK(perfect.ratio(0) == 0.0);
  CHECK(perfect.joint_ratio() == 0.0);
  CHECK_THROWS_AS(prewhitened_groups(Eigen::VectorXd::Zero(40), {Eigen::MatrixXd::Zero(40, 2)}), InputError);
  CHECK_THROWS_WITH(prewhitened_groups(Eigen::VectorXd::Zero(100), {Eigen::MatrixXd::Zero(99, 2)}),
                    Catch::Contains("100 finite samples"));
}

}  // namespace mpm
