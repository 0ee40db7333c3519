#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <catch2/catch.hpp>

#include "analysis/indicators/mpm_indicator.hpp"
#include "analysis/statistics/correlation.hpp"
#include "analysis/statistics/moving_moments.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/plants/allocation_counter.hpp"

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mpm::WindowScan;
using mpm::testing::autoregression;
using mpm::testing::white_noise;

/// The size of the 400-experiment study: Hp = 75, 113 window lengths.
constexpr WindowScan kStudyScan{38, 150, 1};

VectorXd differences(const VectorXd& z) {
  return z.tail(z.size() - 1) - z.head(z.size() - 1);
}

/// Pearson's correlation in one expression.
double plain_correlation(const VectorXd& x, const VectorXd& y) {
  const VectorXd a = x.array() - x.mean();
  const VectorXd b = y.array() - y.mean();
  return a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm());
}

/// (6.13) to (6.15) and (5.15) as they stand.
mpm::MpmIndicator plain_indicator(const VectorXd& y0, const VectorXd& e0, const WindowScan& scan) {
  mpm::MpmIndicator result;
  result.co_dkts = result.co_dskn = result.co_kts = result.co_skn = 0.0;
  const double n = scan.count();
  for (int window = scan.shortest; window <= scan.longest; window += scan.stride) {
    const Index positions = y0.size() - window + 1;
    VectorXd skn_y(positions), kts_y(positions), skn_e(positions), kts_e(positions);
    mpm::moving_moments(y0, window, skn_y, kts_y);
    mpm::moving_moments(e0, window, skn_e, kts_e);
    result.co_dkts += std::abs(plain_correlation(differences(kts_e), differences(kts_y))) / n;
    result.co_dskn += std::abs(plain_correlation(differences(skn_e), differences(skn_y))) / n;
    result.co_kts += std::abs(plain_correlation(kts_e, kts_y)) / n;
    result.co_skn += std::abs(plain_correlation(skn_e, skn_y)) / n;
  }
  result.i_mpm = std::max(result.co_dkts, result.co_dskn);
  return result;
}

mpm::MpmIndicator mpm_indicator(const VectorXd& y0, const VectorXd& e0, const WindowScan& windows) {
  return mpm::MpmScanner(y0.size()).scan(y0, e0, windows);
}

}  // namespace

TEST_CASE("the indicators are the means of (6.13) to (6.15) and (5.15)") {
  const VectorXd y0 = autoregression(300, 0.9, 1);
  const VectorXd e0 = 0.5 * y0 + autoregression(300, 0.8, 2);
  for (const WindowScan scan : {WindowScan{20, 40, 1}, WindowScan{20, 45, 7}, WindowScan{30, 30, 1}}) {
    const auto found = mpm_indicator(y0, e0, scan);
    const auto expected = plain_indicator(y0, e0, scan);
    // The same sums in another order: a few hundred roundings of 1e-16.
    CHECK(found.co_dkts == Approx(expected.co_dkts).epsilon(1e-12));
    CHECK(found.co_dskn == Approx(expected.co_dskn).epsilon(1e-12));
    CHECK(found.co_kts == Approx(expected.co_kts).epsilon(1e-12));
    CHECK(found.co_skn == Approx(expected.co_skn).epsilon(1e-12));
    CHECK(found.i_mpm == std::max(found.co_dkts, found.co_dskn));
    CHECK(found.scanned == scan.count());
    CHECK(found.used == scan.count());
  }
}

TEST_CASE("an error proportional to the nominal output has the indicator 1") {
  const VectorXd y0 = autoregression(400, 0.95, 3);
  for (const double factor : {0.01, 1.0, -2.5}) {
    const auto result = mpm_indicator(y0, factor * y0, kStudyScan);
    // Correlation of two series that differ by their stated error 1e-9.
    for (const double value : {result.co_dkts, result.co_dskn, result.i_mpm, result.co_kts, result.co_skn}) {
      CHECK(value == Approx(1.0).epsilon(1e-8));
      CHECK(value <= 1.0);
    }
  }
}

TEST_CASE("the indicators do not depend on offset and scale of either signal, nor on their order") {
  const VectorXd y0 = autoregression(250, 0.9, 4);
  const VectorXd e0 = autoregression(250, 0.7, 5) + 0.3 * y0;
  const WindowScan scan{15, 60, 5};
  const auto base = mpm_indicator(y0, e0, scan);
  const auto changed = mpm_indicator(4.0 * y0.array() + 7.0, -0.2 * e0.array() - 3.0, scan);
  const auto exchanged = mpm_indicator(e0, y0, scan);
  CHECK(changed.co_dkts == Approx(base.co_dkts).epsilon(1e-7));  // moments with the stated error 1e-9
  CHECK(changed.co_dskn == Approx(base.co_dskn).epsilon(1e-7));
  CHECK(exchanged.co_dkts == Approx(base.co_dkts).epsilon(1e-12));
  CHECK(exchanged.co_skn == Approx(base.co_skn).epsilon(1e-12));
}

TEST_CASE("independent white signals stay at the noise floor") {
  // |r| of n independent pairs has the mean sqrt(2/(pi n)), 0.046 for the about 305 differences of a window
  // length. The window lengths share their samples, so that one record scatters by about 0.02 about this, and
  // the mean over 30 records by 0.004; the tolerance is four times that.
  double mean_kurtosis = 0.0;
  double mean_skewness = 0.0;
  constexpr int kRecords = 30;
  for (std::uint64_t record = 0; record < kRecords; ++record) {
    const auto result =
        mpm_indicator(white_noise(400, 100 + 2 * record), white_noise(400, 101 + 2 * record), kStudyScan);
    REQUIRE((result.i_mpm >= 0.0 && result.i_mpm < 0.25));
    mean_kurtosis += result.co_dkts / kRecords;
    mean_skewness += result.co_dskn / kRecords;
  }
  INFO("co_dkts " << mean_kurtosis << ", co_dskn " << mean_skewness);
  CHECK(mean_kurtosis == Approx(0.046).margin(0.016));
  CHECK(mean_skewness == Approx(0.046).margin(0.016));
}

TEST_CASE("windows that stand still are left out") {
  // The last two fifths of both signals stand still: the answer is that of the part that moves, windows with
  // at least one moving sample included.
  const VectorXd moving_y0 = autoregression(180, 0.9, 6);
  const VectorXd moving_e0 = autoregression(180, 0.9, 7);
  const WindowScan scan{20, 30, 1};
  VectorXd y0 = VectorXd::Constant(300, moving_y0[179]);
  VectorXd e0 = VectorXd::Constant(300, moving_e0[179]);
  y0.head(180) = moving_y0;
  e0.head(180) = moving_e0;
  const auto whole = mpm_indicator(y0, e0, scan);
  CHECK(whole.used == scan.count());
  double expected = 0.0;
  for (int window = 20; window <= 30; ++window) {
    const Index samples = 180 + window - 2;  // sample 179 itself stands still with its successors
    const auto part = mpm_indicator(y0.head(samples), e0.head(samples), WindowScan{window, window, 1});
    expected += part.co_dkts / scan.count();
  }
  CHECK(whole.co_dkts == Approx(expected).epsilon(1e-12));
}

TEST_CASE("without enough variation there is no indicator") {
  const VectorXd noise = white_noise(100, 8);
  const auto still = mpm_indicator(VectorXd::Constant(100, 2.0), noise, WindowScan{10, 20, 1});
  CHECK(std::isnan(still.co_dkts));
  CHECK(std::isnan(still.co_dskn));
  CHECK(std::isnan(still.i_mpm));
  CHECK(std::isnan(still.co_kts));
  CHECK(std::isnan(still.co_skn));
  CHECK(still.used == 0);
  CHECK(still.scanned == 11);
  // A periodic signal in windows of whole periods: its moments are the same in every window, but for
  // variation far below their stated error.
  VectorXd wave = 1e-12 * white_noise(100, 13);
  for (Index k = 0; k < 100; ++k) {
    wave[k] += 0.1 * static_cast<double>((k % 10) * (k % 10));
  }
  CHECK(std::isnan(mpm_indicator(wave, noise, WindowScan{20, 20, 1}).i_mpm));
  CHECK(std::isfinite(mpm_indicator(wave, noise, WindowScan{23, 23, 1}).i_mpm));
}

TEST_CASE("a scanner allocates nothing, and may be used again") {
  mpm::MpmScanner scanner(400);
  const VectorXd y0 = autoregression(400, 0.9, 9);
  const VectorXd e0 = autoregression(400, 0.9, 10);
  const auto first = scanner.scan(y0, e0, kStudyScan);
  const std::size_t before = allocation_count();
  const auto second = scanner.scan(y0, e0, kStudyScan);
  CHECK(allocation_count() == before);
  CHECK(second.i_mpm == first.i_mpm);
  scanner.scan(e0, 2.0 * e0, kStudyScan);
  CHECK(scanner.scan(y0, e0, kStudyScan).co_kts == first.co_kts);
}

TEST_CASE("the indicator refuses impossible input") {
  using mpm::InputError;
  const VectorXd a = white_noise(60, 11);
  const VectorXd b = white_noise(60, 12);
  CHECK_NOTHROW(mpm_indicator(a, b, {10, 40, 1}));
  CHECK_THROWS_AS(mpm_indicator(a, b, {10, 41, 1}), InputError);  // 19 differences only
  CHECK_THROWS_AS(mpm_indicator(a, b, {3, 20, 1}), InputError);
  CHECK_NOTHROW(mpm_indicator(a, b, {4, 20, 1}));
  CHECK_THROWS_AS(mpm_indicator(a, b, {20, 10, 1}), InputError);
  CHECK_THROWS_AS(mpm_indicator(a, b, {10, 20, 0}), InputError);
  CHECK_THROWS_AS(mpm_indicator(a, b.head(59), {10, 20, 1}), InputError);
  CHECK_THROWS_AS(mpm::MpmScanner(23), InputError);
  CHECK_NOTHROW(mpm::MpmScanner(24));
  mpm::MpmScanner scanner(50);
  CHECK_THROWS_AS(scanner.scan(a, b, {10, 20, 1}), InputError);
  VectorXd bad = b;
  bad[3] = mpm::kNaN;
  CHECK_THROWS_AS(mpm_indicator(a, bad, {10, 20, 1}), InputError);
  CHECK_THROWS_AS(mpm_indicator(bad, a, {10, 20, 1}), InputError);
}

TEST_CASE("correlation: known values, gaps and limits") {
  using mpm::pearson_correlation;
  const VectorXd x = (VectorXd(5) << 1.0, 2.0, 3.0, 4.0, 5.0).finished();
  const VectorXd y = (VectorXd(5) << 2.0, 1.0, 4.0, 3.0, 5.0).finished();
  CHECK(pearson_correlation(x, y, 2, 0.0) == Approx(0.8).epsilon(1e-15));  // Spearman's 1 - 6*4/(5*24)
  CHECK(pearson_correlation(x, -3.0 * x, 2, 0.0) == -1.0);
  const double nan = mpm::kNaN;
  const VectorXd with_gaps = (VectorXd(7) << 2.0, nan, 1.0, 4.0, 3.0, 100.0, 5.0).finished();
  const VectorXd other = (VectorXd(7) << 1.0, 9.0, 2.0, 3.0, 4.0, nan, 5.0).finished();
  CHECK(pearson_correlation(other, with_gaps, 5, 0.0) == Approx(0.8).epsilon(1e-15));
  CHECK(std::isnan(pearson_correlation(other, with_gaps, 6, 0.0)));
  // The standard deviation of x is sqrt(2).
  CHECK(std::isfinite(pearson_correlation(x, y, 2, 1.41)));
  CHECK(std::isnan(pearson_correlation(x, y, 2, 1.42)));
  CHECK(std::isnan(pearson_correlation(x, VectorXd::Constant(5, 1.0), 2, 0.0)));
  CHECK_THROWS_AS(pearson_correlation(x, y.head(4), 2, 0.0), mpm::InputError);
  CHECK_THROWS_AS(pearson_correlation(x, y, 1, 0.0), mpm::InputError);
}
