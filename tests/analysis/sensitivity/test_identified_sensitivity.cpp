#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/sensitivity/identified_sensitivity.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::IdentificationStatus;
using mpm::IdentifiedSensitivity;
using mpm::IdentifiedSensitivityOptions;
using mpm::testing::random_steps;

namespace {

/// A loop of two integrating controllers on a coupled plant of two states, and a third CV without control:
///
///   x(k+1) = [0.7 0; 0 0.8] x(k) + [0.3 0.1; 0.05 0.2] u(k)
///   y = (x1, x2, 0.5 x1 + 0.8 x2),   u_i(k) = u_i(k-1) + K_i (r_i(k) - y_i(k) - noise_i(k))
///
/// T0 from r to y has four states, two of the plant and two of the controllers. Column k of the answer is
/// y(k).
Eigen::MatrixXd loop_outputs(const Eigen::MatrixXd& r, const Eigen::MatrixXd& noise) {
  const Eigen::Vector2d gain(0.3, 0.25);
  Eigen::Matrix2d B;
  B << 0.3, 0.1, 0.05, 0.2;
  Eigen::MatrixXd C(3, 2);
  C << 1.0, 0.0, 0.0, 1.0, 0.5, 0.8;
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  Eigen::MatrixXd y(3, r.cols());
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    y.col(k) = C * x + noise.col(k);
    u += gain.cwiseProduct(r.col(k) - y.col(k).head(2));
    x = Eigen::Vector2d(0.7, 0.8).cwiseProduct(x) + B * u;
  }
  return y;
}

/// Unit step response of the loop, column l-1 the outputs l samples after the step: T0 without any model.
Eigen::MatrixXd loop_step_response(Eigen::Index reference, Eigen::Index samples) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(2, samples + 1);
  r.row(reference).setOnes();
  return loop_outputs(r, Eigen::MatrixXd::Zero(3, samples + 1)).rightCols(samples);
}

double largest_error(const IdentifiedSensitivity& T0, Eigen::Index samples) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < 2; ++j) {
    const Eigen::MatrixXd error =
        T0.step_response[static_cast<std::size_t>(j)].topRows(3) - loop_step_response(j, samples);
    largest = std::max(largest, error.cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace

TEST_CASE("T0 of a simulation without noise is identified to rounding") {
  const Eigen::MatrixXd r = random_steps(2, 600, 60);
  Eigen::MatrixXd y(4, 600);
  y << loop_outputs(r, Eigen::MatrixXd::Zero(3, 600)), Eigen::RowVectorXd::Zero(600);
  IdentifiedSensitivityOptions options;
  options.samples = 80;
  options.orders.nb = {3, 4};
  options.orders.nf = {3, 4};
  const IdentifiedSensitivity T0 = identified_sensitivity(r, y, options);
  REQUIRE(T0.step_response.size() == 2);
  REQUIRE(T0.rows.size() == 4);
  CHECK(largest_error(T0, 80) < 1e-6);
  for (std::size_t cv = 0; cv < 3; ++cv) {
    CHECK(T0.rows[cv].identification.status == IdentificationStatus::noise_free);
    CHECK(T0.rows[cv].validation_fit > 99.9999);
  }
  // Static gain 1 on the diagonal and 0 beside it: integrating control.
  CHECK(T0.step_response[0](0, 79) == Approx(1.0).margin(1e-3));
  CHECK(T0.step_response[0](1, 79) == Approx(0.0).margin(1e-3));
  // The fourth CV does not move.
  CHECK(T0.rows[3].identification.status == IdentificationStatus::noise_free);
  CHECK(T0.step_response[1].row(3).isZero());
}

TEST_CASE("T0 of a loop with measurement noise is identified without bias by the noise that circulates") {
  const Eigen::Index N = 2000;
  const Eigen::MatrixXd r = random_steps(2, N, 61);
  const Eigen::MatrixXd noise = 0.05 * mpm::testing::white_inputs(3, N, 62);
  IdentifiedSensitivityOptions options;
  options.samples = 60;
  options.orders.nb = {2, 4};
  options.orders.nf = {2, 4};
  options.orders.nc = {2};
  options.orders.nd = {2};
  const IdentifiedSensitivity T0 = identified_sensitivity(r, loop_outputs(r, noise), options);
  // Noise of a tenth of the reference's size over 2000 samples; steps of some 12 samples are some 170 trials
  // of the response: 0.1/sqrt(170) = 0.01, of which 5.
  CHECK(largest_error(T0, 60) < 0.05);
  for (const mpm::IdentifiedRow& row : T0.rows) {
    CHECK(is_usable(row.identification.status));
    CHECK(row.validation_fit > 70.0);
  }
}

TEST_CASE("a CV without a usable model has no step response") {
  Eigen::MatrixXd r = random_steps(2, 200, 63);
  const Eigen::MatrixXd y = loop_outputs(r, Eigen::MatrixXd::Zero(3, 200));
  r.row(1).setZero();
  IdentifiedSensitivityOptions options;
  options.orders.nb = {2};
  options.orders.nf = {2};
  const IdentifiedSensitivity T0 = identified_sensitivity(r, y, options);
  CHECK(T0.rows[0].identification.status == IdentificationStatus::rank_deficient);
  CHECK(T0.step_response[0].array().isNaN().all());
  CHECK_THROWS_WITH(identified_sensitivity(r.leftCols(9), y, options), Catch::Contains("9 and 200"));
  CHECK_THROWS_WITH(identified_sensitivity(r.topRows(0), y, options), Catch::Contains("0 and 3"));
  options.samples = 0;
  CHECK_THROWS_AS(identified_sensitivity(r, y, options), mpm::InputError);
}
