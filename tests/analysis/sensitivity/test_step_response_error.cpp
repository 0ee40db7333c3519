#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/sensitivity/step_response_error.hpp"
#include "plants/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::Identification;
using mpm::PolynomialModel;
using mpm::testing::noisy_output;

TEST_CASE("the standard error of a sum of coefficients is that of their covariance") {
  const Eigen::MatrixXd u = mpm::testing::random_steps(1, 300, 80);
  const Eigen::VectorXd y = noisy_output(mpm::testing::arx_sample(), u, 81);
  const Identification fit = identify_arx(y, u, mpm::arx_order(1, 0, 3, 2));
  const Eigen::MatrixXd errors = step_response_errors(fit, 6);
  REQUIRE(errors.rows() == 1);
  CHECK(errors(0) == 0.0);  // before the delay
  for (Eigen::Index l = 2; l <= 6; ++l) {
    const Eigen::Index terms = std::min<Eigen::Index>(l - 1, 3);
    CHECK(errors(l - 1) == Approx(std::sqrt(fit.covariance.topLeftCorner(terms, terms).sum())));
  }
}

TEST_CASE("standard errors of step responses agree with differences in each family") {
  const PolynomialModel truth = GENERATE(mpm::testing::arx_sample(), mpm::testing::output_error_sample(),
                                         mpm::testing::box_jenkins_sample());
  const auto nu = static_cast<Eigen::Index>(truth.inputs.size());
  const Eigen::MatrixXd u = mpm::testing::random_steps(nu, 500, 82);
  const Identification fit = identify(noisy_output(truth, u, 83), u, truth.order());
  const Eigen::VectorXd theta = fit.model.parameters();
  const Eigen::Index p = theta.size();
  const Eigen::MatrixXd errors = step_response_errors(fit, 20);
  for (Eigen::Index j = 0; j < nu; ++j) {
    Eigen::MatrixXd g(20, p);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Eigen::VectorXd h = 1e-6 * Eigen::VectorXd::Unit(p, i);
      const Eigen::MatrixXd above = step_response(model_from_parameters(truth.order(), theta + h), 20);
      const Eigen::MatrixXd below = step_response(model_from_parameters(truth.order(), theta - h), 20);
      g.col(i) = (above - below).row(j).transpose() / 2e-6;
    }
    const Eigen::VectorXd variances = (g * fit.covariance * g.transpose()).diagonal();
    // Differences of 1e-6 have some 8 digits.
    CHECK((errors.row(j).transpose() - variances.cwiseSqrt()).cwiseAbs().maxCoeff() <
          1e-6 * errors.row(j).maxCoeff());
  }
}

TEST_CASE("without a covariance there are no standard errors") {
  Identification fit;
  fit.model = mpm::testing::output_error_sample();
  CHECK(mpm::step_response_errors(fit, 5).array().isNaN().all());
  CHECK_THROWS_AS(mpm::step_response_errors(fit, 0), mpm::InputError);
}
