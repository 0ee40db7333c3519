#include <cmath>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "analysis/identification/decorrelation.hpp"
#include "analysis/identification/noise_filter.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::Decorrelation;
using mpm::DecorrelationModel;
using mpm::DecorrelationOptions;
using mpm::Decorrelator;
using mpm::laguerre_responses;
using mpm::noise_filtered;
using mpm::NoiseFilter;

namespace {

DecorrelationOptions decorrelation_with(DecorrelationModel model) {
  DecorrelationOptions options;
  options.model = model;
  return options;
}

}  // namespace

TEST_CASE("Laguerre filters: orthonormal impulse responses, and delays for a pole of 0") {
  Eigen::MatrixXd impulse = Eigen::MatrixXd::Zero(1, 1001);
  impulse(0, 1) = 1.0;  // the first sample is the steady state before it
  const Eigen::MatrixXd responses = laguerre_responses(impulse, 8, 0.7).rightCols(7);
  // What is left of 0.7^1000 times a polynomial is below rounding.
  CHECK((responses.transpose() * responses).isIdentity(1e-12));

  const Eigen::MatrixXd u = mpm::testing::white_inputs(1, 40, 1);
  const Eigen::MatrixXd delays = laguerre_responses(u, 5, 0.0);
  for (Eigen::Index l = 0; l < 5; ++l)
    for (Eigen::Index k = 0; k < 40; ++k)
      CHECK(delays(k, l) == Approx(u(0, std::max<Eigen::Index>(0, k - l))).margin(1e-15));
}

TEST_CASE("decorrelation by regression: the residuals are those of the normal equations") {
  const Eigen::MatrixXd u = mpm::testing::random_steps(2, 300, 5);
  Eigen::MatrixXd x = mpm::testing::white_inputs(3, 300, 6);
  x.row(0) += 3.0 * u.row(0);
  DecorrelationOptions options = decorrelation_with(DecorrelationModel::fir);
  options.fir_length = 6;
  const Decorrelation result = Decorrelator(u, options).decorrelate(x, 1);
  CHECK(result.parameters == 12);

  Eigen::MatrixXd A(300, 13);
  A << Eigen::VectorXd::Ones(300), laguerre_responses(u, 6, options.fir_pole);
  const Eigen::MatrixXd theta = (A.transpose() * A).ldlt().solve(A.transpose() * x.transpose());
  // Normal equations square a condition number of some hundreds.
  CHECK((result.residuals - (x.transpose() - A * theta).transpose()).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((result.residuals * A).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE(
    "decorrelation by regression: inputs that are nearly dependent leave what does not hang on rounding") {
  // Slow inputs and many slow filters: singular values of all sizes.
  const Eigen::MatrixXd steps = mpm::testing::random_steps(7, 300, 5);
  const Eigen::MatrixXd slow = laguerre_responses(steps, 4, 0.9)(Eigen::all, Eigen::seq(3, 27, 4));
  const Eigen::MatrixXd u = slow.transpose();
  const Eigen::MatrixXd x = mpm::testing::white_inputs(2, 300, 6);
  const DecorrelationOptions options = decorrelation_with(DecorrelationModel::fir);
  const Eigen::MatrixXd left = Decorrelator(u, options).decorrelate(x, 1).residuals;
  REQUIRE(left.norm() > 0.1 * x.norm());
  for (const std::uint64_t seed : {8, 9, 10}) {
    const Eigen::MatrixXd noise = 1e-13 * mpm::testing::white_inputs(7, 300, seed);
    CHECK((Decorrelator(u + noise, options).decorrelate(x, 1).residuals - left).norm() < 1e-4 * left.norm());
  }
}

TEST_CASE("decorrelation: what inputs make a signal do is taken away, and the rest is left") {
  const Eigen::MatrixXd u = mpm::testing::random_steps(2, 900, 7);
  const mpm::PolynomialModel model = mpm::testing::output_error_sample();
  const Eigen::VectorXd noise = 0.1 * mpm::testing::white_noise(900, 8);
  const Eigen::VectorXd caused = simulate(model, u.colwise() - u.col(0));
  Eigen::MatrixXd x(2, 900);
  x << (caused + noise).transpose(), noise.transpose();
  for (const DecorrelationModel kind : {DecorrelationModel::output_error, DecorrelationModel::fir}) {
    DecorrelationOptions options = decorrelation_with(kind);
    options.fir_pole = 0.6;
    const Decorrelation result = Decorrelator(u, options).decorrelate(x, 1);
    CAPTURE(static_cast<int>(kind));
    CHECK(caused.squaredNorm() > 100.0 * noise.squaredNorm());
    for (Eigen::Index row = 0; row < 2; ++row) {
      // Of N = 900 degrees of freedom the models take 8 and 40, about 5 %, and the means that the
      // output-error models are about are not those of a steady state.
      const double left = (result.residuals.row(row).transpose() - noise).squaredNorm();
      CHECK(left < 0.2 * noise.squaredNorm());
    }
  }
}

TEST_CASE("decorrelation: without inputs the deviations from the means are left") {
  const Eigen::MatrixXd x = mpm::testing::white_inputs(2, 50, 9).array() + 4.0;
  for (const DecorrelationModel kind : {DecorrelationModel::output_error, DecorrelationModel::fir}) {
    const Decorrelation result =
        Decorrelator(Eigen::MatrixXd(0, 50), decorrelation_with(kind)).decorrelate(x, 1);
    CHECK(result.parameters == 0);
    CHECK((result.residuals - (x.colwise() - x.rowwise().mean())).cwiseAbs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("decorrelation refuses what cannot be meant") {
  const Eigen::MatrixXd u = mpm::testing::white_inputs(2, 41, 10);
  const Eigen::MatrixXd x = mpm::testing::white_inputs(1, 41, 11);
  DecorrelationOptions options;
  CHECK_THROWS_WITH(Decorrelator(u, options).decorrelate(x, 1),
                    Catch::Contains("found 41; allowed: more than its 41"));
  options.fir_length = 5;
  CHECK_THROWS_WITH(Decorrelator(u, options).decorrelate(x, -1), Catch::Contains("-1 samples"));
  CHECK_THROWS_WITH(Decorrelator(u, options).decorrelate(x.leftCols(40), 1), Catch::Contains("40 and 41"));
  Eigen::MatrixXd broken = x;
  broken(0, 3) = std::nan("");
  CHECK_THROWS_WITH(Decorrelator(u, options).decorrelate(broken, 1), Catch::Contains("not finite"));
  options.fir_pole = 1.0;
  CHECK_THROWS_WITH(Decorrelator(u, options).decorrelate(x, 1), Catch::Contains("below 1"));
}

TEST_CASE("noise filters: means of the last samples, an exponential step response, linearity") {
  const Eigen::MatrixXd x = mpm::testing::white_inputs(2, 60, 12);
  const Eigen::MatrixXd mean = noise_filtered(x, NoiseFilter::moving_average, 4);
  for (Eigen::Index k = 3; k < 60; ++k)
    CHECK(mean(1, k) == Approx(x.row(1).segment(k - 3, 4).mean()).margin(1e-14));

  Eigen::MatrixXd step = Eigen::MatrixXd::Ones(1, 30);
  step(0, 0) = 0.0;
  const Eigen::MatrixXd response = noise_filtered(step, NoiseFilter::first_order, 5);
  for (Eigen::Index k = 0; k < 30; ++k)
    CHECK(response(0, k) == Approx(1.0 - std::exp(-static_cast<double>(k) / 5.0)).margin(1e-14));

  for (const NoiseFilter filter : {NoiseFilter::moving_average, NoiseFilter::first_order}) {
    const Eigen::MatrixXd apart =
        2.0 * noise_filtered(x.row(0), filter, 6) - noise_filtered(x.row(1), filter, 6);
    CHECK((noise_filtered(2.0 * x.row(0) - x.row(1), filter, 6) - apart).cwiseAbs().maxCoeff() < 1e-13);
  }
  CHECK(noise_filtered(x, NoiseFilter::none, 6) == x);
  CHECK_THROWS_WITH(noise_filtered(x, NoiseFilter::none, 0), Catch::Contains("0 samples"));
}

TEST_CASE("externally driven: what setpoints do to an MV stays, what disturbances do goes") {
  const Eigen::MatrixXd r = mpm::testing::random_steps(2, 800, 13);
  Eigen::MatrixXd external(3, 800);
  external << r, Eigen::MatrixXd::Ones(1, 800);  // a signal that stands still
  const Eigen::RowVectorXd driven =
      simulate(mpm::testing::output_error_sample(), r.colwise() - r.col(0)).transpose();
  const Eigen::RowVectorXd disturbed = driven + mpm::testing::autoregression(800, 0.9, 14).transpose();
  DecorrelationOptions options = decorrelation_with(DecorrelationModel::fir);
  options.fir_pole = 0.6;
  const Eigen::MatrixXd u = externally_driven(disturbed, external, options);
  CHECK((u - driven).squaredNorm() < 0.2 * (disturbed - driven).squaredNorm());
  CHECK(mpm::moving_rows(external) == r);
  const Eigen::MatrixXd still = externally_driven(disturbed, Eigen::MatrixXd::Ones(1, 800), options);
  CHECK((still.array() - disturbed.mean()).abs().maxCoeff() < 1e-14);
}
