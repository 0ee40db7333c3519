#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/QR>
#include <boost/math/distributions/fisher_f.hpp>
#include <catch2/catch.hpp>

#include "analysis/identification/prewhitened_test.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kSamples = 400;

/// A signal that steps every 60 to 100 samples, as the excitation of chapter 6 does.
Eigen::RowVectorXd steps(std::uint64_t number) {
  RandomStream stream(7, number, StreamId::excitation);
  Eigen::RowVectorXd u = Eigen::RowVectorXd::Zero(kSamples);
  for (double k = stream.uniform(0, 60); k < static_cast<double>(kSamples); k += stream.uniform(60, 100))
    u.tail(kSamples - static_cast<Eigen::Index>(k)).setConstant(stream.uniform(-0.4, 0.4));
  return u;
}

Eigen::MatrixXd signals(std::uint64_t number, Eigen::Index rows) {
  Eigen::MatrixXd u(rows, kSamples);
  for (Eigen::Index row = 0; row < rows; ++row)
    u.row(row) = steps(100 * number + static_cast<std::uint64_t>(row));
  return u;
}

FTest tested(const Eigen::VectorXd& e, const Eigen::MatrixXd& u) {
  const ErrorRegressionOptions options;
  const auto found = error_regressions(e.transpose(), filtered_signals(u, options), options);
  return found[0]->test.all;
}

/// Residual sum of squares of b on the columns of A.
double residual(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return (A * A.colPivHouseholderQr().solve(b) - b).squaredNorm();
}

/// Of 1000 records without a relation those with p below 5 %.
template <class Error>
int false_alarms(Eigen::Index rows, Error error) {
  int hits = 0;
  for (std::uint64_t number = 0; number < 1000; ++number)
    hits += tested(error(number), signals(number, rows)).log_p < std::log(0.05) ? 1 : 0;
  return hits;
}

}  // namespace

TEST_CASE("prewhitened test: F and partial F by the sums of squares of plain regressions") {
  const Eigen::MatrixXd x = signals(3, 3).transpose();
  Eigen::VectorXd e = testing::settled_autoregression(kSamples, 0.8, 4) + 8.0 * x.col(1);
  e.segment(100, 5).setConstant(kNaN);
  const Autoregression whiteness = fit_autoregression(e, 2);
  std::vector<Eigen::MatrixXd> groups{x.col(0), x.rightCols(2)};
  const PrewhitenedTest found = prewhitened_test(e, groups, whiteness);

  // Sample by sample, and with a constant as a regressor.
  Eigen::MatrixXd A(kSamples - 2 - 5 - 2, 4);
  Eigen::VectorXd b(A.rows());
  Eigen::Index row = 0;
  for (Eigen::Index k = 2; k < kSamples; ++k) {
    if (k >= 100 && k < 107)
      continue;
    const auto filtered = [&](const auto& s) {
      return s(k) - whiteness.theta(1) * s(k - 1) - whiteness.theta(2) * s(k - 2);
    };
    A.row(row) << 1.0, filtered(x.col(0)), filtered(x.col(1)), filtered(x.col(2));
    b(row++) = filtered(e);
  }
  REQUIRE(row == A.rows());
  const double all = residual(A, b);
  const double freedom = static_cast<double>(A.rows()) - 3 - 3;  // of the autoregression, of the regressors
  const auto check = [&](const FTest& test, const Eigen::MatrixXd& without, double regressors) {
    const double f = (residual(without, b) - all) / regressors / (all / freedom);
    CHECK(test.f == Approx(f));
    CHECK(static_cast<double>(test.freedom) == regressors);
    CHECK(std::exp(test.log_p) ==
          Approx(boost::math::cdf(boost::math::complement(boost::math::fisher_f(regressors, freedom), f))));
  };
  check(found.all, A.leftCols(1), 3);
  check(found.groups[0], A(Eigen::all, std::vector<int>{0, 2, 3}), 1);
  check(found.groups[1], A.leftCols(2), 2);
  CHECK(found.groups[1].log_p < std::log(1e-3));

  // A copy of a group, and one that stands still, add nothing: no group has anything of its own then but the
  // one that is there once.
  groups.push_back(2.0 * x.col(0));
  groups.push_back(Eigen::MatrixXd::Constant(kSamples, 1, 5.0));
  const PrewhitenedTest doubled = prewhitened_test(e, groups, whiteness);
  CHECK(doubled.all.f == Approx(found.all.f));
  CHECK(doubled.all.freedom == 3);
  CHECK(doubled.groups[0].freedom == 0);
  CHECK(doubled.groups[0].log_p == 0.0);
  CHECK(doubled.groups[1].f == Approx(found.groups[1].f));
  CHECK(doubled.groups[2].log_p == 0.0);
  CHECK(doubled.groups[3].log_p == 0.0);
}

TEST_CASE("prewhitened test: refused input, and signals of which there is nothing to say") {
  const Eigen::MatrixXd x = signals(3, 1).transpose();
  const Eigen::VectorXd e = testing::white_noise(kSamples, 1);
  const Autoregression white = fit_autoregression(e, 0);
  CHECK_THROWS_WITH(prewhitened_test(e, {x.topRows(10)}, white), Catch::Contains("found 10; allowed: 400"));
  CHECK_THROWS_WITH(prewhitened_test(e, {x * kNaN}, white), Catch::Contains("finite"));
  CHECK_THROWS_WITH(prewhitened_test(e.head(21), {x.topRows(21)}, fit_autoregression(e.head(21), 0)),
                    Catch::Contains("found 21 without a gap; allowed: 22 or more"));
  CHECK(prewhitened_test(e, {}, white).all.log_p == 0.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(kSamples);
  CHECK(prewhitened_test(zero, {x}, fit_autoregression(zero, 0)).all.log_p == 0.0);
  // What follows exactly has a p-value that is very small, and finite.
  const double exact = prewhitened_test(x.col(0), {x}, fit_autoregression(x.col(0), 0)).all.log_p;
  CHECK((exact < -1000.0 && std::isfinite(exact)));
}

TEST_CASE("prewhitened test: false alarms of white errors are those stated, of slow ones not more") {
  const int white =
      false_alarms(3, [](std::uint64_t number) { return testing::white_noise(kSamples, number); });
  INFO("white: " << white << " of 1000");
  const Interval rate = testing::clopper_pearson_interval(white, 1000, 0.999);
  CHECK((rate.lower < 0.05 && rate.upper > 0.05));
  for (const double a : {0.8, 0.95}) {
    const int slow = false_alarms(
        3, [a](std::uint64_t number) { return testing::settled_autoregression(kSamples, a, number); });
    INFO("a = " << a << ": " << slow << " of 1000");
    CHECK(testing::clopper_pearson_interval(slow, 1000, 0.999).lower < 0.05);
  }
}

TEST_CASE("prewhitened test: errors that drive the signals by feedback are no cause of alarm") {
  int hits = 0;
  for (std::uint64_t number = 0; number < 1000; ++number) {
    const Eigen::VectorXd e = testing::settled_autoregression(kSamples, 0.9, number);
    Eigen::MatrixXd u = 5.0 * signals(number, 2);
    for (Eigen::Index k = 1; k < kSamples; ++k)  // an integrating controller, which sees e(k) before u(k)
      u.col(k).array() +=
          0.8 * (u.col(k - 1).array() - 5.0 * signals(number, 2).col(k - 1).array()) - 0.4 * e(k);
    hits += tested(e, u).log_p < std::log(0.05) ? 1 : 0;
  }
  INFO(hits << " of 1000");
  CHECK(testing::clopper_pearson_interval(hits, 1000, 0.999).lower < 0.05);
}

TEST_CASE("prewhitened test: a weak relation is found through the noise") {
  int found = 0;
  for (std::uint64_t number = 0; number < 100; ++number) {
    const Eigen::MatrixXd u = signals(number, 3);
    const Eigen::VectorXd response = filtered_signals(u.row(1), {})[0].col(0);
    const Eigen::VectorXd noise = testing::white_noise(kSamples, number);
    const double scale = 0.4 / std::sqrt((response.array() - response.mean()).square().mean());
    found += tested(noise + scale * response, u).log_p < std::log(0.05) ? 1 : 0;
  }
  CHECK(found > 90);  // 14 % of the variance
}

}  // namespace mpm
