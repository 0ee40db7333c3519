#include <cmath>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "analysis/identification/arx.hpp"
#include "analysis/identification/least_squares.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::Identification;
using mpm::IdentificationStatus;
using mpm::identify_arx;
using mpm::PolynomialModel;
using mpm::testing::arx_order;
using mpm::testing::noisy_output;
using mpm::testing::parameter_distance;
using mpm::testing::random_steps;
using mpm::testing::white_noise;

TEST_CASE("least squares: the residual is orthogonal to the regressors, and the inverse is one") {
  Eigen::MatrixXd A(80, 3);
  for (Eigen::Index j = 0; j < 3; ++j)
    A.col(j) = std::pow(1e4, static_cast<double>(j)) * white_noise(80, 10 + static_cast<std::uint64_t>(j));
  const Eigen::VectorXd b = white_noise(80, 14);
  const mpm::LeastSquares fit = mpm::least_squares(A, b, 1e-10);
  REQUIRE(fit.rank == 3);
  const Eigen::VectorXd scale = A.colwise().norm().transpose();
  // Columns of unit norm: eps times the condition of nearly orthogonal columns, with room.
  CHECK((scale.cwiseInverse().asDiagonal() * A.transpose() * (A * fit.x - b)).norm() < 1e-13);
  const Eigen::MatrixXd unit =
      scale.cwiseInverse().asDiagonal() * A.transpose() * A * fit.inverse * scale.asDiagonal();
  CHECK((unit - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(fit.residual_sum == Approx((A * fit.x - b).squaredNorm()));
}

TEST_CASE("least squares: QR keeps the digits that normal equations lose") {
  // Two columns that differ by 1e-7: the condition of A'A is 1e14.
  Eigen::MatrixXd A(100, 2);
  A.col(0) = white_noise(100, 15);
  A.col(1) = A.col(0) + 1e-7 * white_noise(100, 16);
  const Eigen::Vector2d x(1.0, -2.0);
  const Eigen::VectorXd b = A * x;
  const Eigen::Vector2d normal = (A.transpose() * A).ldlt().solve(A.transpose() * b);
  CHECK((mpm::least_squares(A, b, 1e-12).x - x).norm() < 1e-7);  // eps times condition 2e7, with room
  CHECK((normal - x).norm() > 1e-5);
}

TEST_CASE("least squares: of dependent columns the answer of least norm, without an inverse") {
  Eigen::MatrixXd A(50, 2);
  A.col(0) = white_noise(50, 17);
  A.col(1) = A.col(0);
  const mpm::LeastSquares fit = mpm::least_squares(A, 2.0 * A.col(0), 1e-10);
  CHECK(fit.rank == 1);
  CHECK((fit.x - Eigen::Vector2d::Ones()).norm() < 1e-12);
  CHECK(fit.inverse.size() == 0);
  CHECK_THROWS_WITH(mpm::least_squares(A.topRows(1), A.col(0).head(1), 1e-10),
                    Catch::Contains("1 for 2 parameters"));
}

TEST_CASE("ARX: data without noise give the coefficients back, whatever was before the record") {
  const PolynomialModel truth = mpm::testing::arx_sample();
  const Eigen::MatrixXd u = random_steps(1, 300, 20);
  // The later part of a record starts in some state that the estimate must not care about.
  const Eigen::VectorXd y = simulate(truth, u).tail(200);
  const Identification fit = identify_arx(y, u.rightCols(200), truth.order());
  CHECK(fit.status == IdentificationStatus::ok);
  CHECK(fit.first_sample == 2);
  CHECK(fit.samples == 198);
  CHECK(parameter_distance(fit.model, truth) < 1e-11);  // eps times a condition of some hundreds
  CHECK(fit.loss < 1e-24);
}

TEST_CASE("ARX: the residuals are orthogonal to the regressors") {
  const PolynomialModel truth = mpm::testing::arx_sample();
  const Eigen::MatrixXd u = random_steps(1, 500, 21);
  const Eigen::VectorXd y = noisy_output(truth, u, 22);
  const Identification fit = identify_arx(y, u, arx_order(1, 3, 4));
  const Eigen::MatrixXd Phi = mpm::arx_regressors(arx_order(1, 3, 4), y, u, fit.first_sample);
  const Eigen::VectorXd e = prediction_errors(fit.model, y, u).tail(fit.samples);
  CHECK((Phi.transpose() * e).norm() < 1e-12 * Phi.norm() * e.norm());
  CHECK(fit.loss == Approx(e.squaredNorm() / static_cast<double>(fit.samples)));
  CHECK(fit.model.noise_variance == Approx(e.squaredNorm() / static_cast<double>(fit.samples - 7)));
}

TEST_CASE("ARX: a high-order model of many inputs has the step response of the loop it describes") {
  // 1/F of an output-error system as a long ARX model: A = F1 F2 and B_j = B_j F_i, and so on.
  const PolynomialModel truth = mpm::testing::output_error_sample();
  const Eigen::MatrixXd u = mpm::testing::white_inputs(2, 3000, 23);
  const Eigen::VectorXd y = noisy_output(truth, u, 24);
  const Identification fit = identify_arx(y, u, arx_order(2, 30, 30));
  REQUIRE(fit.status == IdentificationStatus::ok);
  CHECK(fit.covariance.rows() == 90);
  const Eigen::MatrixXd error = step_response(fit.model, 30) - step_response(truth, 30);
  // A step response adds up to 30 coefficients of standard error 0.5/sqrt(3000) = 0.009 each: 0.05; 5 of
  // them.
  CHECK(error.cwiseAbs().maxCoeff() < 0.25);
  CHECK(fit.model.noise_variance == Approx(0.25).epsilon(0.15));  // 5 standard errors sqrt(2/3000)
}

TEST_CASE("ARX: data that do not determine the coefficients are a status") {
  const PolynomialModel truth = mpm::testing::arx_sample();
  const Eigen::MatrixXd u = random_steps(1, 200, 25);
  const Eigen::VectorXd y = noisy_output(truth, u, 26);
  SECTION("collinear inputs") {
    Eigen::MatrixXd both(2, 200);
    both << u, -3.0 * u;
    const Identification fit = identify_arx(y, both, arx_order(2, 2, 2));
    CHECK(fit.status == IdentificationStatus::rank_deficient);
    CHECK(fit.covariance.size() == 0);
    CHECK(fit.model.parameters().allFinite());
  }
  SECTION("a constant input") {
    CHECK(identify_arx(y, Eigen::MatrixXd::Constant(1, 200, 2.0), arx_order(1, 2, 2)).status ==
          IdentificationStatus::rank_deficient);
  }
  SECTION("an input that is 0") {
    CHECK(identify_arx(y, Eigen::MatrixXd::Zero(1, 200), arx_order(1, 2, 1)).status ==
          IdentificationStatus::rank_deficient);
  }
  SECTION("orders that are too high for data without noise") {
    CHECK(identify_arx(simulate(truth, u), u, arx_order(1, 4, 4)).status ==
          IdentificationStatus::rank_deficient);
  }
}

TEST_CASE("ARX: what cannot be meant is refused") {
  const Eigen::MatrixXd u = random_steps(1, 10, 27);
  const Eigen::VectorXd y = white_noise(10, 28);
  CHECK_THROWS_WITH(identify_arx(y, u, arx_order(1, 4, 4)), Catch::Contains("found 10 samples; allowed: 13"));
  CHECK_THROWS_WITH(identify_arx(y, u, arx_order(2, 1, 1)), Catch::Contains("inputs of a model order"));
  CHECK_THROWS_WITH(identify_arx(y, u, arx_order(1, -1, 1)), Catch::Contains("order of A: found -1"));
  CHECK_THROWS_WITH(identify_arx(y, u, mpm::output_error_order(1, 1, 1)), Catch::Contains("nf 1"));
  CHECK_THROWS_WITH(identify_arx(y.head(9), u, arx_order(1, 1, 1)), Catch::Contains("9 and 10"));
  CHECK_THROWS_WITH(identify_arx(y, u, arx_order(1, 3, 1), {2, 1e-10}), Catch::Contains("3 or later"));
  Eigen::VectorXd broken = y;
  broken(4) = std::nan("");
  CHECK_THROWS_WITH(identify_arx(broken, u, arx_order(1, 1, 1)), Catch::Contains("at sample 4"));
}
