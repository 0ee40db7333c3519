#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "analysis/identification/kalman_whitening.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

/// The covariance of x + n over N samples, as the definitions say.
Eigen::MatrixXd covariance(double a, double b, double phi, bool rest, Eigen::Index N) {
  Eigen::MatrixXd C(N, N);
  for (Eigen::Index i = 0; i < N; ++i)
    for (Eigen::Index j = 0; j < N; ++j) {
      const auto before = static_cast<double>(std::min(i, j));
      const auto lag = static_cast<double>(std::abs(i - j));
      const double stationary = b * b / (1.0 - a * a);
      const double variance = rest ? stationary * (1.0 - std::pow(a, 2.0 * before)) : stationary;
      C(i, j) = std::pow(a, lag) * variance + (lag == 0.0 ? 1.0 : std::pow(phi, lag));
    }
  return C;
}

std::vector<Eigen::Index> observed_samples(const Eigen::MatrixXd& series) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index k = 0; k < series.cols(); ++k)
    if (!std::isnan(series(0, k)))
      places.push_back(k);
  return places;
}

Eigen::MatrixXd two_series(Eigen::Index N) {
  Eigen::MatrixXd series(2, N);
  series.row(0) = testing::white_noise(N, 1).transpose();
  series.row(1) = testing::autoregression(N, 0.9, 2).transpose();
  return series;
}

}  // namespace

TEST_CASE("whitened series have the determinant and the products of the dense covariance, gaps or none") {
  constexpr Eigen::Index N = 60;
  for (const double phi : {0.0, 0.6})
    for (const bool rest : {true, false})
      for (const bool gaps : {false, true}) {
        if (gaps && phi != 0.0)
          continue;  // then the filter is an approximation, see below
        INFO(phi << " " << rest << " " << gaps);
        Eigen::MatrixXd series = two_series(N);
        if (gaps)
          for (const Eigen::Index k : {0, 7, 8, 9, 30, 59})
            series(0, k) = kNaN;
        const std::vector<Eigen::Index> places = observed_samples(series);
        const NoiseModels models{Eigen::Array3d(0.95, 0.3, 0.5), Eigen::Array3d(0.7, 4.0, 0.0), phi, rest};
        const WhitenedProducts sums = whitened_products(models, series);
        for (Eigen::Index i = 0; i < models.count(); ++i) {
          const Eigen::MatrixXd C = covariance(models.a(i), models.b(i), phi, rest, N)(places, places);
          const Eigen::MatrixXd S = series(Eigen::all, places);
          const Eigen::MatrixXd products = S * C.llt().solve(S.transpose());
          const double log_determinant = 2.0 * C.llt().matrixLLT().diagonal().array().log().sum();
          CHECK(sums.log_determinant(i) == Approx(log_determinant).margin(1e-9));
          CHECK(sums.of(0, 0)(i) == Approx(products(0, 0)).epsilon(1e-9));
          CHECK(sums.of(0, 1)(i) == Approx(products(0, 1)).epsilon(1e-9));
          CHECK(sums.of(1, 1)(i) == Approx(products(1, 1)).epsilon(1e-9));
        }
        double log_determinant = 0.0;
        const Eigen::MatrixXd white = whitened(models, series, log_determinant);
        CHECK(log_determinant == Approx(sums.log_determinant(0)).margin(1e-9));
        CHECK(white.row(0).dot(white.row(1)) == Approx(sums.of(0, 1)(0)).epsilon(1e-9));
      }
}

TEST_CASE("behind a gap in coloured noise the likelihood is near that of the dense covariance") {
  Eigen::MatrixXd series = two_series(60);
  series(0, 20) = series(0, 41) = kNaN;
  const std::vector<Eigen::Index> places = observed_samples(series);
  const NoiseModels models{Eigen::ArrayXd::Constant(1, 0.95), Eigen::ArrayXd::Constant(1, 0.3), 0.4, true};
  const WhitenedProducts sums = whitened_products(models, series);
  const Eigen::MatrixXd C = covariance(0.95, 0.3, 0.4, true, 60)(places, places);
  const Eigen::MatrixXd S = series(Eigen::all, places);
  // What n was before the gap is forgotten: 0.4^2 of its variance is lost, twice.
  CHECK(sums.of(0, 0)(0) == Approx((S * C.llt().solve(S.transpose()))(0, 0)).epsilon(0.02));
}

}  // namespace mpm
