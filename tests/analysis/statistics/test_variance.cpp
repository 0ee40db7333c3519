#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

using Eigen::VectorXd;
using mpm::variance;
using mpm::variance_about;
using mpm::variance_index;
using mpm::testing::white_noise;

namespace {
const VectorXd kSmall = (VectorXd(4) << 1.0, 2.0, 3.0, 6.0).finished();
}

TEST_CASE("variances by hand") {
  CHECK(variance(kSmall) == Approx(14.0 / 3.0).epsilon(1e-15));  // deviations -2 -1 0 3
  CHECK(variance_about(kSmall, 2.0) == Approx(18.0 / 4.0).epsilon(1e-15));
  const VectorXd setpoint = (VectorXd(4) << 1.0, 1.0, 3.0, 3.0).finished();
  CHECK(variance_about(kSmall, setpoint) == Approx(10.0 / 4.0).epsilon(1e-15));
}

TEST_CASE("the variance about the mean is the smallest of all centres") {
  const VectorXd signal = white_noise(50, 1).array() + 3.0;
  const double smallest = variance_about(signal, signal.mean());
  CHECK(smallest == Approx(variance(signal) * 49.0 / 50.0).epsilon(1e-14));
  // Steiner: the distance of the centre from the mean adds its square.
  CHECK(variance_about(signal, signal.mean() + 0.5) == Approx(smallest + 0.25).epsilon(1e-13));
}

TEST_CASE("variance indices") {
  const VectorXd y_ref = white_noise(100, 2);
  CHECK(variance_index(y_ref, y_ref) == 1.0);
  CHECK(variance_index(3.0 * y_ref.array() + 5.0, y_ref) == Approx(9.0).epsilon(1e-13));
  CHECK(variance_index(y_ref, 3.0 * y_ref) == Approx(1.0 / 9.0).epsilon(1e-13));
  // About a setpoint an offset counts as variance: (3.24).
  const VectorXd zero = VectorXd::Zero(100);
  const VectorXd shifted = y_ref.array() + 5.0;
  CHECK(variance_index(shifted, y_ref, zero) == Approx(shifted.squaredNorm() / y_ref.squaredNorm()));
  CHECK(variance_index(shifted, y_ref, zero) > 20.0);
}

TEST_CASE("variance indices without a denominator") {
  const VectorXd still = VectorXd::Constant(100, 0.3);
  const VectorXd noise = white_noise(100, 3);
  VectorXd rounded = still;
  rounded[10] = 0.1 + 0.2;
  REQUIRE(rounded[10] != 0.3);
  CHECK(std::isinf(variance_index(noise, still)));
  CHECK(std::isinf(variance_index(noise, rounded)));
  CHECK(std::isnan(variance_index(still, still)));
  CHECK(std::isnan(variance_index(rounded, still)));
  CHECK(variance_index(still, noise) == 0.0);
  CHECK(variance_index(still, noise, still) == 0.0);
  CHECK(std::isinf(variance_index(noise, still, still)));
  CHECK(mpm::variance_ratio(3.0, 2.0) == 1.5);
  CHECK(std::isinf(mpm::variance_ratio(3.0, 0.0)));
  CHECK(std::isnan(mpm::variance_ratio(0.0, 0.0)));
}

TEST_CASE("a long signal that stands still has no variance, although its mean is rounded") {
  for (const Eigen::Index samples : {100, 400, 5000}) {
    const VectorXd still = VectorXd::Constant(samples, 0.3);
    CHECK(variance(still) == 0.0);
    CHECK(std::isnan(variance_index(still, still)));
  }
}

TEST_CASE("variances refuse impossible input") {
  using mpm::InputError;
  const double nan = mpm::kNaN;
  const VectorXd bad = VectorXd::Constant(4, nan);
  CHECK_THROWS_AS(variance(kSmall.head(1)), InputError);
  CHECK_THROWS_AS(variance(bad), InputError);
  CHECK_THROWS_AS(variance_about(kSmall.head(0), 1.0), InputError);
  CHECK_THROWS_AS(variance_about(bad, 1.0), InputError);
  CHECK_THROWS_AS(variance_about(kSmall, nan), InputError);
  CHECK_THROWS_AS(variance_about(kSmall, kSmall.head(3)), InputError);
  CHECK_THROWS_AS(variance_about(kSmall, bad), InputError);
  CHECK_THROWS_AS(variance_index(kSmall, kSmall.head(3)), InputError);
  CHECK_THROWS_AS(variance_index(kSmall, bad), InputError);
  CHECK_THROWS_AS(variance_index(kSmall, kSmall.head(3), kSmall), InputError);
  CHECK_THROWS_AS(variance_index(kSmall, kSmall, kSmall.head(3)), InputError);
}

TEST_CASE("variance indices of a loop with setpoints and ranges") {
  // An offset of 5 counts about a setpoint (3.24), not about the mean (6.7).
  Eigen::MatrixXd y_ref(2, 100);
  y_ref.row(0) = white_noise(100, 4).transpose();
  y_ref.row(1) = white_noise(100, 5).transpose();
  const Eigen::MatrixXd y = y_ref.array() + 5.0;
  const VectorXd about_means = mpm::variance_indices(y, y_ref);
  CHECK(about_means[0] == Approx(1.0).epsilon(1e-12));
  CHECK(about_means[1] == Approx(1.0).epsilon(1e-12));
  const VectorXd setpoint = VectorXd::LinSpaced(100, -1.0, 1.0);
  const VectorXd mixed = mpm::variance_indices(y, y_ref, {setpoint, std::nullopt});
  const VectorXd error = y.row(0).transpose() - setpoint;
  const VectorXd error_ref = y_ref.row(0).transpose() - setpoint;
  CHECK(mixed[0] == Approx(error.squaredNorm() / error_ref.squaredNorm()).epsilon(1e-13));
  CHECK(mixed[1] == about_means[1]);
  CHECK_THROWS_AS(mpm::variance_indices(y, y_ref.leftCols(99)), mpm::InputError);
  CHECK_THROWS_AS(mpm::variance_indices(y, y_ref.topRows(1)), mpm::InputError);
  CHECK_THROWS_AS(mpm::variance_indices(y, y_ref, {setpoint}), mpm::InputError);
  CHECK_THROWS_AS(mpm::variance_indices(y, y_ref, {setpoint.head(99), std::nullopt}), mpm::InputError);
}
