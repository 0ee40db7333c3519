#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/sensitivity/second_order_fit.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace {

using namespace mpm;

/// The step response of (6.24) from its poles, the textbook's three cases.
double closed_form(double tau, double xi, double t) {
  const double r = t / tau;
  if (xi < 1.0) {
    const double w = std::sqrt(1.0 - xi * xi);
    return 1.0 - std::exp(-xi * r) * (std::cos(w * r) + xi / w * std::sin(w * r));
  }
  if (xi == 1.0)
    return 1.0 - (1.0 + r) * std::exp(-r);
  const double w = std::sqrt(xi * xi - 1.0), fast = xi + w, slow = xi - w;
  return 1.0 - (fast * std::exp(-slow * r) - slow * std::exp(-fast * r)) / (2.0 * w);
}

TEST_CASE("second-order response: the closed forms below, at and above critical damping") {
  for (const double xi : {0.2, 0.7, 1.0, 1.5, 6.0}) {
    const Eigen::RowVectorXd response = second_order_response({12.0, xi}, 4.0, 60);
    REQUIRE(response.size() == 60);
    for (Eigen::Index l = 0; l < response.size(); ++l)
      // Both are exact up to rounding; at xi = 1 the double pole costs half the digits.
      CHECK(response(l) == Approx(closed_form(12.0, xi, 4.0 * static_cast<double>(l + 1))).margin(1e-7));
  }
}

TEST_CASE("fit: time constant and damping of a second-order response come back") {
  for (const double tau : {6.0, 22.0, 50.0})
    for (const double xi : {0.3, 0.7, 1.0, 1.4, 2.5}) {
      INFO("tau " << tau << ", xi " << xi);
      const SecondOrderFit fit = fit_second_order(second_order_response({tau, xi}, 4.0, 150), 4.0);
      REQUIRE(fit.status == FitStatus::ok);
      // The residual at the minimum is zero up to rounding; the steps end at 1e-7 of a parameter at the
      // latest.
      CHECK(fit.model.time_constant == Approx(tau).epsilon(1e-6));
      CHECK(fit.model.damping == Approx(xi).epsilon(1e-6));
      CHECK(fit.rms_error < 1e-7);
    }
}

TEST_CASE("fit: no model near the minimum is nearer, and the error is that of the fit") {
  // With a dead time the second order cannot describe it.
  Eigen::RowVectorXd response = Eigen::RowVectorXd::Zero(150);
  response.tail(144) = second_order_response({40.0, 0.9}, 4.0, 144);
  const SecondOrderFit fit = fit_second_order(response, 4.0);
  REQUIRE(fit.status == FitStatus::ok);
  const auto error = [&](double tau, double xi) {
    return std::sqrt((second_order_response({tau, xi}, 4.0, 150) - response).squaredNorm() / 150.0);
  };
  const auto [tau, xi] = fit.model;
  CHECK(fit.rms_error == Approx(error(tau, xi)).epsilon(1e-9));
  for (const double up : {0.99, 1.01}) {
    CHECK(error(up * tau, xi) > fit.rms_error);
    CHECK(error(tau, up * xi) > fit.rms_error);
  }
}

TEST_CASE("fit: numbers that are not finite have no fit; bad arguments are refused") {
  Eigen::RowVectorXd response = second_order_response({40.0, 0.9}, 4.0, 50);
  response(7) = mpm::kNaN;
  const SecondOrderFit fit = fit_second_order(response, 4.0);
  CHECK(fit.status == FitStatus::failed);
  CHECK(std::isnan(fit.model.time_constant));
  CHECK_THROWS_AS(fit_second_order(response.head(2), 4.0), InputError);
  CHECK_THROWS_AS(fit_second_order(response, 0.0), InputError);
  CHECK_THROWS_AS(second_order_response({-1.0, 1.0}, 4.0, 5), InputError);
  CHECK_THROWS_AS(second_order_response({1.0, 0.0}, 4.0, 5), InputError);
}

}  // namespace
