#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "analysis/identification/shared_whitening.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/transfer_function.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kLength = 40;

/// The response of a channel to a pulse of one sample at its input, `samples` long.
Eigen::VectorXd pulse_response(const DiscreteChannel& channel, Eigen::Index samples) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(samples), x = Eigen::VectorXd::Zero(channel.A.rows());
  for (Eigen::Index k = 0; k < samples; ++k) {
    y(k) = channel.c.dot(x) + (k == channel.delay + 1 ? channel.d : 0.0);
    x = (channel.A * x).eval();
    if (k == channel.delay)
      x += channel.b_now;
    if (k == channel.delay + 1)
      x += channel.b_previous;
  }
  return y;
}

/// Covariance of the series one below the other, by their sums over what drives them.
Eigen::MatrixXd dense_covariance(const std::vector<SharedOutput>& outputs, double a, double b) {
  constexpr Eigen::Index kPast = 600;  // 0.9^600 and e^(-600 / 8) are nothing
  const auto count = static_cast<Eigen::Index>(outputs.size());
  const Eigen::Index drives = kPast + kLength;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(count * kLength, count * kLength);
  Eigen::MatrixXd of_x = Eigen::MatrixXd::Zero(count * kLength, drives);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SharedOutput& output = outputs[static_cast<std::size_t>(i)];
    // x(k+1) = a x(k) + b w(k): the pulse response of the lag, a sample late.
    const Eigen::VectorXd pulse = pulse_response(output.channel, drives);
    Eigen::VectorXd together = Eigen::VectorXd::Zero(drives);
    for (Eigen::Index k = 1; k < drives; ++k)
      for (Eigen::Index l = 0; l < k; ++l)
        together(k) += pulse(l) * b * std::pow(a, static_cast<double>(k - 1 - l));
    for (Eigen::Index k = 0; k < kLength; ++k)
      for (Eigen::Index w = 0; w < kPast + k; ++w)
        of_x(i * kLength + k, w) = together(kPast + k - w);
    for (Eigen::Index k = 0; k < kLength; ++k)
      for (Eigen::Index l = 0; l < kLength; ++l)
        C(i * kLength + k, i * kLength + l) = (k == l ? output.white * output.white : 0.0) +
                                              output.b * output.b *
                                                  std::pow(output.a, std::abs(static_cast<double>(k - l))) /
                                                  (1.0 - output.a * output.a);
  }
  return C + of_x * of_x.transpose();
}

}  // namespace

TEST_CASE(
    "whitened by a shared disturbance: the products of the dense covariance, with dead times and gaps") {
  std::vector<Eigen::MatrixXd> series;
  for (std::uint64_t i = 0; i < 3; ++i) {
    series.emplace_back(2, kLength);
    series.back().row(0) = testing::white_noise(kLength, 2 * i).transpose();
    series.back().row(1) = testing::white_noise(kLength, 2 * i + 1).transpose();
  }
  series[1].row(0).segment(10, 4).setConstant(kNaN);
  series[2](0, 25) = kNaN;
  const std::vector<SharedOutput> outputs{
      {discretise(TransferFunction::first_order(2.0, 8.0, 5.3), 1.0), 0.0, 0.0, 1.0, &series[0]},
      {discretise(TransferFunction::first_order(-1.0, 5.0, 0.0), 1.0), 0.7, 0.4, 1.0, &series[1]},
      {discretise(TransferFunction::zero(), 1.0), 0.6, 0.8, 0.0, &series[2]}};
  const double a = 0.9, b = 0.3;
  const SharedProducts sums = SharedWhitening(outputs).products(a, b, true);

  std::vector<Eigen::Index> observed;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(4, 3 * kLength);
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index k = 0; k < kLength; ++k) {
      const Eigen::MatrixXd& own = series[static_cast<std::size_t>(i)];
      rows(0, i * kLength + k) = own(0, k);
      rows(1 + i, i * kLength + k) = own(1, k);
      if (!std::isnan(own(0, k)))
        observed.push_back(i * kLength + k);
    }
  const Eigen::MatrixXd C = dense_covariance(outputs, a, b)(observed, observed);
  const Eigen::MatrixXd there = rows(Eigen::all, observed);
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  const Eigen::MatrixXd products = there * factor.solve(there.transpose());
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(4, 4);
  for (const Eigen::MatrixXd& of_series : sums.products)
    found += Eigen::MatrixXd(of_series.selfadjointView<Eigen::Lower>());
  // The filter stops renewing its gains where they change by less than 1e-9.
  CHECK((found - products).norm() < 1e-6 * products.norm());
  CHECK(sums.log_determinant.sum() ==
        Approx(2.0 * factor.matrixLLT().diagonal().array().log().sum()).epsilon(1e-7));
  const SharedProducts alone = SharedWhitening(outputs).products(a, b, false);
  CHECK(alone.products[0].rows() == 1);
  CHECK(alone.products[0](0, 0) == Approx(sums.products[0](0, 0)).epsilon(1e-12));
}

}  // namespace mpm
