#include <cmath>
#include <vector>

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "analysis/identification/autoregression.hpp"
#include "analysis/statistics/sample_spacing.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

double log_p_of_colours(const Eigen::VectorXd& one, const Eigen::VectorXd& other, Eigen::Index order) {
  return log_p_same_autoregression(fit_autoregression(one, order), fit_autoregression(other, order));
}

/// Of 1000 pairs of signals those that are found different at 5 %.
template <class Other>
int found_different(double a, Other other) {
  int hits = 0;
  for (std::uint64_t number = 0; number < 1000; ++number) {
    const Eigen::VectorXd one = testing::settled_autoregression(400, a, 2 * number);
    hits += log_p_of_colours(one, other(2 * number + 1), 2) < std::log(0.05) ? 1 : 0;
  }
  return hits;
}

}  // namespace

TEST_CASE("autoregression: a recursion without noise is found, with gaps in the record and without") {
  Eigen::VectorXd e(60);
  e.head(2) << 1.0, -0.4;
  for (Eigen::Index k = 2; k < e.size(); ++k)
    e(k) = 0.3 + 0.9 * e(k - 1) - 0.5 * e(k - 2) + (k % 7 == 0 ? 1.0 : 0.0);
  // Innovations every 7 samples only: with those samples missing nothing is left of them.
  for (Eigen::Index k = 7; k < e.size(); k += 7)
    e(k) = kNaN;
  const Autoregression model = fit_autoregression(e, 2);
  CHECK(model.rows == known_rows(e, 2));
  CHECK(model.rows.front() == 2);
  for (const Eigen::Index k : model.rows)
    CHECK((k % 7 == 2 || k % 7 > 2));
  CHECK(model.theta.isApprox(Eigen::Vector3d(0.3, 0.9, -0.5), 1e-9));
  const Eigen::MatrixXd white = model.whitened(e);
  CHECK((white.array() - 0.3).abs().maxCoeff() < 1e-9);
  CHECK_THROWS_WITH(fit_autoregression(e.head(5), 3), Catch::Contains("samples of an autoregression"));
}

TEST_CASE("autoregression: of a signal that an analyser measures, the lags are those of its analyses") {
  constexpr Eigen::Index kPeriod = 4;
  const Eigen::VectorXd all = testing::settled_autoregression(4000, 0.9, 3);
  Eigen::VectorXd seen = Eigen::VectorXd::Constant(all.size(), kNaN);
  for (Eigen::Index k = 1; k < all.size(); k += kPeriod)
    seen(k) = all(k);
  CHECK(sample_spacing(all) == 1);
  CHECK(sample_spacing(seen) == kPeriod);
  CHECK(sample_spacing(Eigen::VectorXd::Constant(7, kNaN)) == 7);
  CHECK(autoregression_order(seen, 12) == 1);
  const Autoregression model = fit_autoregression(seen, 1);
  CHECK(model.spacing == kPeriod);
  CHECK(model.rows.front() == 1 + kPeriod);
  CHECK(model.theta(1) == Approx(std::pow(0.9, kPeriod)).margin(3.0 * std::sqrt(model.covariance(1, 1))));
  // The filter makes it white: what is left is as large as the innovations of four samples.
  const Eigen::VectorXd white = model.whitened(seen).array() - model.theta(0);
  const double share = 1.0 - std::pow(0.9, 2.0 * kPeriod);
  const double variance = Eigen::VectorXd(seen(known_rows(seen, 0))).squaredNorm() /
                          static_cast<double>(known_rows(seen, 0).size());
  CHECK(white.squaredNorm() / static_cast<double>(white.size()) == Approx(share * variance).epsilon(0.1));
}

TEST_CASE("autoregression: BIC takes the order of the signal, 0 for white noise and for a constant") {
  CHECK(autoregression_order(Eigen::VectorXd::Constant(400, 2.0), 12) == 0);
  int white = 0, second = 0;
  for (std::uint64_t number = 0; number < 100; ++number) {
    white += autoregression_order(testing::white_noise(400, number), 12) == 0 ? 1 : 0;
    second += autoregression_order(testing::settled_second_order(400, 0.6, 12, number), 12) == 2 ? 1 : 0;
  }
  // BIC errs where one of twelve lags exceeds ln 400 by chance: in a few of a hundred.
  CHECK(white >= 90);
  CHECK(second >= 90);
}

TEST_CASE("autoregression: two signals of one colour have the stated p-values, those of two are told apart") {
  for (const double a : {0.0, 0.5, 0.9}) {
    const int hits = found_different(a, [a](std::uint64_t number) {
      return Eigen::VectorXd(3.0 * testing::settled_autoregression(400, a, number));
    });
    const Interval rate = testing::clopper_pearson_interval(hits, 1000, 0.999);
    INFO("a = " << a << ", " << hits << " of 1000");
    CHECK((rate.lower < 0.05 && rate.upper > 0.05));
  }
  CHECK(found_different(0.9, [](std::uint64_t number) {
          return testing::settled_autoregression(400, 0.7, number);
        }) > 990);
  CHECK(found_different(0.5, [](std::uint64_t number) {
          return Eigen::VectorXd(testing::settled_autoregression(400, 0.5, number).array() + 1.0);
        }) > 990);
  const Eigen::VectorXd x = testing::white_noise(100, 1);
  CHECK_THROWS_WITH(log_p_same_autoregression(fit_autoregression(x, 1), fit_autoregression(x, 2)),
                    Catch::Contains("found 1 and 2"));
}

}  // namespace mpm
