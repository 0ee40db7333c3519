#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "analysis/indicators/scatter_ellipse.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using mpm::centred_sums;
using mpm::CentredSums;
using mpm::confidence_ellipse;
using mpm::principal_axes;
using mpm::testing::white_noise;

namespace {

/// Sums whose covariance has standard deviations `major` and `minor` along axes turned by `angle` degrees.
CentredSums turned(double angle, double major, double minor) {
  const double radians = angle * std::numbers::pi / 180.0;
  const double c = std::cos(radians);
  const double s = std::sin(radians);
  const double n = 101.0;
  const double large = (n - 1.0) * major * major;
  const double small = (n - 1.0) * minor * minor;
  CentredSums sums;
  sums.pairs = 101;
  sums.mean_x = 3.0;
  sums.mean_y = -2.0;
  sums.xx = large * c * c + small * s * s;
  sums.yy = large * s * s + small * c * c;
  sums.xy = (large - small) * c * s;
  return sums;
}

}  // namespace

TEST_CASE("principal axes of a covariance that was turned by a known angle") {
  for (const double angle : {-89.0, -60.0, -45.0, -1.0, 0.0, 0.5, 30.0, 45.0, 77.0, 90.0}) {
    const auto axes = principal_axes(turned(angle, 2.0, 0.5));
    CHECK(axes.angle == Approx(angle).margin(1e-12));
    CHECK(axes.major == Approx(2.0).epsilon(1e-14));
    CHECK(axes.minor == Approx(0.5).epsilon(1e-13));
  }
}

TEST_CASE("principal axes of a handful of pairs") {
  // Deviations (2, 0), (-2, 0), (0, 1), (0, -1): sums of squares 8 and 2, three degrees of freedom.
  const VectorXd x = (VectorXd(4) << 3.0, -1.0, 1.0, 1.0).finished();
  const VectorXd y = (VectorXd(4) << 5.0, 5.0, 6.0, 4.0).finished();
  const auto axes = principal_axes(centred_sums(x, y));
  CHECK(axes.angle == 0.0);
  CHECK(axes.major == Approx(std::sqrt(8.0 / 3.0)).epsilon(1e-15));
  CHECK(axes.minor == Approx(std::sqrt(2.0 / 3.0)).epsilon(1e-15));
  CHECK(principal_axes(centred_sums(y, x)).angle == 90.0);
  // A straight line has no minor axis. The root of the rounding of an eigenvalue is 1e-8.
  const auto line = principal_axes(centred_sums(x, x));
  CHECK(line.angle == Approx(45.0).epsilon(1e-14));
  CHECK(line.minor == Approx(0.0).margin(1e-7));
  CHECK(std::isnan(principal_axes(centred_sums(x.head(1), y.head(1))).angle));
  CHECK(std::isnan(principal_axes(centred_sums(x.head(0), y.head(0))).major));
}

TEST_CASE("ellipses when pairs are exchanged, mirrored and stretched") {
  const VectorXd x = white_noise(200, 1);
  const VectorXd y = 0.4 * x + white_noise(200, 2);
  const auto base = principal_axes(centred_sums(x, y));
  REQUIRE(base.angle > 0.0);
  const auto exchanged = principal_axes(centred_sums(y, x));
  CHECK(exchanged.angle == Approx(90.0 - base.angle).epsilon(1e-12));
  CHECK(mpm::folded_angle(exchanged.angle) == Approx(mpm::folded_angle(base.angle)).epsilon(1e-12));
  CHECK(exchanged.major == Approx(base.major).epsilon(1e-13));
  CHECK(principal_axes(centred_sums(x, -y)).angle == Approx(-base.angle).epsilon(1e-12));
  CHECK(principal_axes(centred_sums(-x, -y)).angle == Approx(base.angle).epsilon(1e-12));
  // Both stretched alike: nothing turns. One alone: the ellipse of the plain covariance turns.
  const auto stretched = principal_axes(centred_sums(3.0 * x, 3.0 * y));
  CHECK(stretched.angle == Approx(base.angle).epsilon(1e-12));
  CHECK(stretched.minor == Approx(3.0 * base.minor).epsilon(1e-12));
  CHECK(principal_axes(centred_sums(x, 3.0 * y)).angle > base.angle + 5.0);
}

TEST_CASE("angles are folded about 45 degrees") {
  CHECK(mpm::folded_angle(30.0) == 30.0);
  CHECK(mpm::folded_angle(-30.0) == 30.0);
  CHECK(mpm::folded_angle(45.0) == 45.0);
  CHECK(mpm::folded_angle(64.0) == 26.0);
  CHECK(mpm::folded_angle(-90.0) == 0.0);
}

TEST_CASE("the confidence ellipse has the closed form of chi-square with 2 degrees of freedom") {
  // The distribution function is 1 - exp(-x/2), its quantile -2 ln(1 - p).
  for (const double probability : {0.5, 0.95, 0.99}) {
    const auto ellipse = confidence_ellipse(turned(25.0, 2.0, 0.5), probability);
    const double factor = std::sqrt(-2.0 * std::log(1.0 - probability));
    CHECK(ellipse.centre_x == 3.0);
    CHECK(ellipse.centre_y == -2.0);
    CHECK(ellipse.angle == Approx(25.0).epsilon(1e-12));
    CHECK(ellipse.semi_major == Approx(2.0 * factor).epsilon(1e-12));
    CHECK(ellipse.semi_minor == Approx(0.5 * factor).epsilon(1e-12));
    const double radians = 25.0 * std::numbers::pi / 180.0;
    const auto along = [&](double distance) {
      return ellipse.contains(3.0 + distance * std::cos(radians), -2.0 + distance * std::sin(radians));
    };
    CHECK(along(0.999 * ellipse.semi_major));
    CHECK_FALSE(along(1.001 * ellipse.semi_major));
  }
  CHECK_THROWS_AS(confidence_ellipse(turned(25.0, 2.0, 0.5), 0.0), mpm::InputError);
  CHECK_THROWS_AS(confidence_ellipse(turned(25.0, 2.0, 0.5), 1.0), mpm::InputError);
}

TEST_CASE("the confidence ellipse holds its share of normal pairs") {
  constexpr Index kPairs = 5000;
  const VectorXd x = white_noise(kPairs, 3);
  const VectorXd y = 0.7 * x.array() + 0.4 * white_noise(kPairs, 4).array() + 2.0;
  for (const double probability : {0.5, 0.95}) {
    const auto ellipse = confidence_ellipse(centred_sums(x, y), probability);
    Index inside = 0;
    for (Index i = 0; i < kPairs; ++i) {
      inside += ellipse.contains(x[i], y[i]) ? 1 : 0;
    }
    const double deviation = std::sqrt(probability * (1.0 - probability) / static_cast<double>(kPairs));
    CHECK(static_cast<double>(inside) / static_cast<double>(kPairs) ==
          Approx(probability).margin(4.0 * deviation));
  }
}
