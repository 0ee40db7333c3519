#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <catch2/catch.hpp>

#include "analysis/indicators/distribution_indicators.hpp"
#include "analysis/indicators/scatter_ellipse.hpp"
#include "base/error.hpp"
#include "tests/analysis/row_checks.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/plants/allocation_counter.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using mpm::DistributionIndicators;
using mpm::DistributionScanner;
using mpm::PerStatistic;
using mpm::ScatterMeans;
using mpm::ScatterShape;
using mpm::WindowScan;
using mpm::testing::autoregression;
using mpm::testing::white_noise;

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

DistributionIndicators indicators(const VectorXd& y, const VectorXd& y0, const VectorXd& y0_diag,
                                  const WindowScan& windows, int window) {
  return DistributionScanner(y.size()).compute(y, y0, y0_diag, windows, window);
}

/// The same nominal output for chapters 2 and 5.
DistributionIndicators indicators(const VectorXd& y0, const VectorXd& e0, const WindowScan& windows,
                                  int window) {
  return indicators(y0 - e0, y0, y0, windows, window);
}

template <class T, class Visit>
void for_each(const PerStatistic<T>& parts, Visit visit) {
  for (const T* part : {&parts.kts, &parts.skn, &parts.dkts, &parts.dskn}) {
    visit(*part);
  }
}

// The equations as they stand, in plain loops, with none of the project's own parts.

double plain_moment(const VectorXd& x, Index first, int window, int order) {
  double mean = 0.0;
  for (Index i = first; i < first + window; ++i) {
    mean += x[i] / window;
  }
  double moment = 0.0;
  for (Index i = first; i < first + window; ++i) {
    moment += std::pow(x[i] - mean, order) / window;  // (5.14)
  }
  return moment;
}

/// Kurtosis (order 4) or skewness (order 3) of each window, or the differences of them.
VectorXd plain_statistic(const VectorXd& x, int window, int order, bool differentiated) {
  VectorXd z(x.size() - window + 1);
  for (Index k = 0; k < z.size(); ++k) {
    z[k] = plain_moment(x, k, window, order) / std::pow(plain_moment(x, k, window, 2), 0.5 * order);
  }
  if (!differentiated) {
    return z;
  }
  VectorXd d(z.size() - 1);
  for (Index k = 0; k < d.size(); ++k) {
    d[k] = z[k + 1] - z[k];
  }
  return d;
}

struct PlainScatter {
  double r, angle, ratio, slope;
};

/// Correlation; angle and ratio b/a by the closed form of a symmetric 2 x 2 matrix; slope of y on x.
PlainScatter plain_scatter(const VectorXd& x, const VectorXd& y) {
  const double n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (Index k = 0; k < x.size(); ++k) {
    mean_x += x[k] / n;
    mean_y += y[k] / n;
  }
  for (Index k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x) / n;
    xy += (x[k] - mean_x) * (y[k] - mean_y) / n;
    yy += (y[k] - mean_y) * (y[k] - mean_y) / n;
  }
  const double half_trace = 0.5 * (xx + yy);
  const double root = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
  return {xy / std::sqrt(xx * yy), 0.5 * std::atan2(2.0 * xy, xx - yy),
          std::sqrt((half_trace - root) / (half_trace + root)), xy / xx};
}

ScatterMeans plain_means(const VectorXd& y0, const VectorXd& e0, const WindowScan& scan, int order,
                         bool differentiated) {
  ScatterMeans mean{0.0, 0.0, 0.0, 0.0, 0.0, scan.count()};
  for (int window = scan.shortest; window <= scan.longest; window += scan.stride) {
    const auto s = plain_scatter(plain_statistic(y0, window, order, differentiated),
                                 plain_statistic(e0, window, order, differentiated));
    double alpha = std::abs(s.angle);
    mean.unfolded_angle += alpha * kDegrees / scan.count();
    if (alpha > std::numbers::pi / 4.0) {
      alpha = std::numbers::pi / 2.0 - alpha;
    }
    mean.co += std::abs(s.r) / scan.count();                                              // (5.15)
    mean.ce += 4.0 * alpha / std::numbers::pi * std::sqrt(1.0 - s.ratio) / scan.count();  // (5.18)
    mean.angle += alpha * kDegrees / scan.count();                                        // (5.16)
    mean.minor_to_major += s.ratio / scan.count();                                        // (5.17)
  }
  return mean;
}

/// Moments have the stated error 1e-9; an angle of a nearly round scatter enlarges it.
void check_means(const ScatterMeans& found, const ScatterMeans& expected) {
  CHECK(found.co == Approx(expected.co).epsilon(1e-7));
  CHECK(found.ce == Approx(expected.ce).epsilon(1e-6));
  CHECK(found.angle == Approx(expected.angle).epsilon(1e-6));
  CHECK(found.unfolded_angle == Approx(expected.unfolded_angle).epsilon(1e-6));
  CHECK(found.minor_to_major == Approx(expected.minor_to_major).epsilon(1e-7));
  CHECK(found.used == expected.used);
}

void check_shape(const ScatterShape& found, const VectorXd& y0, const VectorXd& e0, int window, int order,
                 bool differentiated) {
  const auto s = plain_scatter(plain_statistic(y0, window, order, differentiated),
                               plain_statistic(e0, window, order, differentiated));
  CHECK(found.inclination == Approx(std::abs(s.angle) * kDegrees).epsilon(1e-6));
  CHECK(found.major_to_minor == Approx(1.0 / s.ratio).epsilon(1e-7));
  CHECK(found.regression_angle == Approx(std::abs(std::atan(s.slope)) * kDegrees).epsilon(1e-6));
  CHECK(found.log_r_squared == Approx(std::abs(std::log(s.r * s.r))).epsilon(1e-6));
}

}  // namespace

TEST_CASE("the indicators of chapters 2 and 5 are their equations") {
  const VectorXd y0 = autoregression(200, 0.8, 1);
  const VectorXd y0_diag = y0 + 0.3 * autoregression(200, 0.6, 2);
  const VectorXd y = 0.6 * y0 + autoregression(200, 0.7, 3);
  const WindowScan scan{9, 33, 4};
  const auto found = indicators(y, y0, y0_diag, scan, 17);
  const VectorXd e0 = y0 - y;
  const VectorXd e0_diag = y0_diag - y;
  check_means(found.means.kts, plain_means(y0_diag, e0_diag, scan, 4, false));
  check_means(found.means.skn, plain_means(y0_diag, e0_diag, scan, 3, false));
  check_means(found.means.dkts, plain_means(y0_diag, e0_diag, scan, 4, true));
  check_means(found.means.dskn, plain_means(y0_diag, e0_diag, scan, 3, true));
  check_shape(found.shape.kts, y0, e0, 17, 4, false);
  check_shape(found.shape.skn, y0, e0, 17, 3, false);
  check_shape(found.shape.dkts, y0, e0, 17, 4, true);
  check_shape(found.shape.dskn, y0, e0, 17, 3, true);
}

TEST_CASE("I_MPM of the one scan is that of a scan for it alone, bit for bit") {
  const VectorXd y0 = autoregression(300, 0.9, 4);
  const VectorXd e0 = 0.4 * y0 + autoregression(300, 0.8, 5);
  const WindowScan scan{20, 60, 2};
  const auto found = indicators(y0 - e0, y0, y0, scan, 30);
  const auto alone = mpm::MpmScanner(300).scan(y0, y0 - (y0 - e0), scan);
  CHECK(found.mpm.i_mpm == alone.i_mpm);
  CHECK(found.mpm.co_kts == alone.co_kts);
  CHECK(found.means.kts.co == alone.co_kts);
  CHECK(found.means.skn.co == alone.co_skn);
  CHECK(found.means.dkts.co == alone.co_dkts);
  CHECK(found.means.dskn.co == alone.co_dskn);
  CHECK(found.mpm.scanned == scan.count());
}

TEST_CASE("an error proportional to the nominal output lies on the diagonal") {
  // Kurtosis and skewness have no scale: those of both signals are equal, or mirrored for a negative factor.
  const VectorXd y0 = autoregression(300, 0.95, 6);
  for (const double factor : {0.1, -2.5}) {
    const auto found = indicators(y0, factor * y0, {20, 40, 5}, 30);
    for_each(found.means, [](const ScatterMeans& z) {
      CHECK(z.co == Approx(1.0).epsilon(1e-8));
      CHECK(z.angle == Approx(45.0).epsilon(1e-6));
      CHECK(z.unfolded_angle == Approx(45.0).epsilon(1e-6));
      CHECK(z.minor_to_major == Approx(0.0).margin(1e-4));  // the root of an eigenvalue of relative size 1e-9
      CHECK(z.ce == Approx(1.0).epsilon(1e-4));
    });
    for_each(found.shape, [](const ScatterShape& z) {
      CHECK(z.inclination == Approx(45.0).epsilon(1e-6));
      CHECK(z.regression_angle == Approx(45.0).epsilon(1e-6));
      CHECK(z.log_r_squared == Approx(0.0).margin(1e-7));
      CHECK(z.major_to_minor > 1e4);
    });
  }
}

TEST_CASE("neither the sign of the error nor the scale of a signal matters") {
  const VectorXd y0 = autoregression(250, 0.9, 7);
  const VectorXd e0 = 0.3 * y0 + autoregression(250, 0.7, 8);
  const WindowScan scan{15, 45, 5};
  const auto base = indicators(y0, e0, scan, 20);
  const auto rows = mpm::distribution_rows();
  const auto check_equal = [&](const DistributionIndicators& other) {
    for (const auto& row : rows) {
      INFO(row.text.name);
      CHECK(numbers_of(row, other).front() ==
            Approx(numbers_of(row, base).front()).epsilon(1e-5).margin(1e-9));
    }
  };
  check_equal(indicators(y0, -e0, scan, 20));  // e0 = y - y0, as chapter 3 has it
  check_equal(indicators(y0, 7.0 * e0, scan, 20));
  check_equal(indicators(-0.2 * y0, e0, scan, 20));
}

TEST_CASE("which signal is on which axis decides the angles that are not folded, and nothing else") {
  const VectorXd y0 = autoregression(250, 0.9, 9);
  const VectorXd e0 = 0.3 * y0 + autoregression(250, 0.7, 10);
  const WindowScan one{20, 20, 1};
  const auto base = indicators(y0, e0, one, 20);
  const auto exchanged = indicators(e0, y0, one, 20);
  CHECK(exchanged.means.kts.co == Approx(base.means.kts.co).epsilon(1e-6));
  CHECK(exchanged.means.kts.ce == Approx(base.means.kts.ce).epsilon(1e-5));
  CHECK(exchanged.means.kts.angle == Approx(base.means.kts.angle).epsilon(1e-5));
  CHECK(exchanged.means.kts.minor_to_major == Approx(base.means.kts.minor_to_major).epsilon(1e-6));
  CHECK(exchanged.means.kts.unfolded_angle == Approx(90.0 - base.means.kts.unfolded_angle).epsilon(1e-5));
  CHECK(exchanged.shape.kts.inclination == Approx(90.0 - base.shape.kts.inclination).epsilon(1e-5));
  CHECK(exchanged.shape.kts.log_r_squared == Approx(base.shape.kts.log_r_squared).epsilon(1e-5));
}

TEST_CASE("a disturbance that has nothing to do with the setpoint makes an ellipse along the axis of y0") {
  // As in section 5.3.1, scenario 2 (angles of 3 to 21 degrees): the nominal output follows steps and is
  // quiet between them, so its moments have high peaks; those of a smooth disturbance stay near the normal
  // ones. With the axes exchanged, the unfolded angle would be near 90.
  DistributionIndicators sum;
  sum.means.dkts.unfolded_angle = sum.means.kts.unfolded_angle = 0.0;
  constexpr int kRecords = 5;
  for (std::uint64_t record = 0; record < kRecords; ++record) {
    mpm::RandomStream steps(9, record, mpm::StreamId::disturbance_signal);
    VectorXd y0(600);
    double setpoint = 0.0, level = 0.0;
    for (Index k = 0; k < y0.size(); ++k) {
      setpoint = k % 50 == 0 ? steps.normal() : setpoint;
      level += 0.3 * (setpoint - level);
      y0[k] = level + 0.02 * steps.normal();
    }
    const auto found = indicators(y0, 0.3 * autoregression(600, 0.9, 100 + record), {6, 22, 1}, 11);
    sum.means.kts.unfolded_angle += found.means.kts.unfolded_angle / kRecords;
    sum.means.dkts.unfolded_angle += found.means.dkts.unfolded_angle / kRecords;
  }
  CHECK(sum.means.kts.unfolded_angle < 20.0);
  CHECK(sum.means.dkts.unfolded_angle < 20.0);
}

TEST_CASE("the lines of tables 2.10 and 2.11 have the relation of their four numbers") {
  // Inclination and diameter ratio give the others. A ratio that is rounded to 0.005 moves the angle by up to
  // 0.1 degrees and the logarithm by up to 0.02; twice that.
  struct Line {
    double inclination, ratio, regression, log_r_squared;
  };
  const Line lines[] = {
      {30.90, 1.78, 20.25, 1.48}, {37.43, 2.31, 29.26, 0.79}, {40.74, 2.78, 34.39, 0.52},
      {12.59, 2.37, 10.32, 1.91}, {2.44, 1.78, 1.67, 5.91},   {53.59, 1.54, 23.89, 1.87},
      {38.42, 2.55, 31.45, 0.65}, {26.35, 1.71, 16.78, 1.78}, {6.54, 1.57, 3.87, 4.51},
      {1.55, 2.30, 1.26, 5.97},   {40.29, 2.32, 31.36, 0.77}, {90.0 - 26.12, 2.99, 51.05, 0.64},
  };
  for (const Line& line : lines) {
    const double c = std::cos(line.inclination / kDegrees);
    const double s = std::sin(line.inclination / kDegrees);
    const double large = line.ratio * line.ratio;
    mpm::CentredSums sums;
    sums.pairs = 100;
    sums.xx = large * c * c + s * s;
    sums.yy = large * s * s + c * c;
    sums.xy = (large - 1.0) * c * s;
    const ScatterShape shape = mpm::scatter_shape(sums);
    CHECK(shape.inclination == Approx(line.inclination).epsilon(1e-10));
    CHECK(shape.major_to_minor == Approx(line.ratio).epsilon(1e-10));
    CHECK(shape.regression_angle == Approx(line.regression).margin(0.2));
    CHECK(shape.log_r_squared == Approx(line.log_r_squared).margin(0.04));
  }
}

TEST_CASE("a signal that stands still has no shape, and no mean") {
  const auto found = indicators(white_noise(100, 11), VectorXd::Constant(100, 2.0), {10, 20, 1}, 15);
  const auto none = indicators(white_noise(100, 12), VectorXd::Zero(100), {10, 20, 1}, 15);
  for (const auto& result : {found, none}) {
    for (const auto& row : mpm::distribution_rows()) {
      INFO(row.text.name);
      CHECK(std::isnan(numbers_of(row, result).front()));
    }
    for_each(result.means, [](const ScatterMeans& z) { CHECK(z.used == 0); });
  }
}

TEST_CASE("every indicator has one row") {
  const auto rows = mpm::distribution_rows();
  mpm::testing::check_rows(rows, 4 * 5 + 4 * 4 + 1);
  DistributionIndicators marked;
  marked.means.dskn.ce = 0.25;
  marked.shape.kts.regression_angle = 12.5;
  for (const auto& row : rows) {
    if (row.text.name == "ce_dskn") {
      CHECK(numbers_of(row, marked).front() == 0.25);
    } else if (row.text.name == "regression_angle_kts") {
      CHECK(numbers_of(row, marked).front() == 12.5);
    } else {
      CHECK(std::isnan(numbers_of(row, marked).front()));
    }
  }
}

TEST_CASE("the rows of a result put back are that result, its ellipses and I_MPM included") {
  const VectorXd y0 = autoregression(300, 0.9, 21);
  const VectorXd y = y0 + autoregression(300, 0.5, 22);
  const auto result = DistributionScanner(300).compute(y, y0, y0 + 0.1 * y, {20, 60, 1}, 40);
  DistributionIndicators again;
  for (const auto& rows : {mpm::distribution_rows(), mpm::scatter_rows()}) {
    for (const auto& row : rows) {
      put_numbers(row, again, numbers_of(row, result).data());
    }
  }
  CHECK(again.mpm.i_mpm == result.mpm.i_mpm);
  CHECK(again.mpm.co_kts == result.mpm.co_kts);
  CHECK(again.mpm.co_skn == result.mpm.co_skn);
  CHECK(again.mpm.co_dkts == result.mpm.co_dkts);
  CHECK(again.mpm.co_dskn == result.mpm.co_dskn);
  const auto ellipse = mpm::confidence_ellipse(result.scatter_diag.dskn, 0.95);
  const auto ellipse_again = mpm::confidence_ellipse(again.scatter_diag.dskn, 0.95);
  CHECK(again.scatter_diag.dskn.pairs == result.scatter_diag.dskn.pairs);
  CHECK(ellipse_again.angle == ellipse.angle);
  CHECK(ellipse_again.centre_y == ellipse.centre_y);
  CHECK(ellipse_again.semi_major == ellipse.semi_major);
}

TEST_CASE("a distribution scanner allocates nothing, and may be used again") {
  DistributionScanner scanner(300);
  const VectorXd y0 = autoregression(300, 0.9, 13);
  const VectorXd y = autoregression(300, 0.9, 14);
  const VectorXd y0_diag = y0 + 0.1 * y;
  const auto first = scanner.compute(y, y0, y0_diag, {20, 60, 1}, 40);
  const std::size_t before = allocation_count();
  const auto second = scanner.compute(y, y0, y0_diag, {20, 60, 1}, 40);
  CHECK(allocation_count() == before);
  CHECK(second.means.dkts.ce == first.means.dkts.ce);
  CHECK(second.shape.skn.inclination == first.shape.skn.inclination);
  CHECK(second.scatter_diag.kts.xy == first.scatter_diag.kts.xy);
}

TEST_CASE("distribution indicators refuse impossible input") {
  using mpm::InputError;
  const VectorXd a = white_noise(60, 15);
  CHECK_NOTHROW(indicators(a, 2.0 * a, a, {10, 40, 1}, 40));
  CHECK_THROWS_AS(indicators(a, 2.0 * a, a, {10, 41, 1}, 40), InputError);
  CHECK_THROWS_AS(indicators(a, 2.0 * a, a, {10, 40, 1}, 41), InputError);
  CHECK_THROWS_AS(indicators(a, 2.0 * a, a, {10, 40, 1}, 2), InputError);
  CHECK_THROWS_AS(indicators(a, a.head(59), a, {10, 40, 1}, 20), InputError);
  CHECK_THROWS_AS(indicators(a, a, a.head(59), {10, 40, 1}, 20), InputError);
  CHECK_THROWS_AS(DistributionScanner(50).compute(a, a, a, {10, 20, 1}, 15), InputError);
  CHECK_THROWS_AS(DistributionScanner(22), InputError);
}
