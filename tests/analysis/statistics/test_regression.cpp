#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/correlation.hpp"
#include "analysis/statistics/regression.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mpm::cluster_bootstrap;
using mpm::RandomStream;
using mpm::StreamId;
using mpm::testing::white_noise;

/// Pairs whose x and y both have a part that the whole cluster shares, about the line y = 1 + 2 x.
struct Sample {
  VectorXd x;
  VectorXd y;
  std::vector<std::int64_t> cluster;
};

Sample clustered_sample(int clusters, int size, std::uint64_t number) {
  RandomStream stream(77, number, StreamId::mismatch);
  Sample sample{VectorXd(clusters * size), VectorXd(clusters * size), {}};
  Index i = 0;
  for (int c = 0; c < clusters; ++c) {
    const double shared_x = stream.normal();
    const double shared_error = stream.normal();
    for (int k = 0; k < size; ++k, ++i) {
      sample.x[i] = shared_x + 0.3 * stream.normal();
      sample.y[i] = 1.0 + 2.0 * sample.x[i] + shared_error + 0.3 * stream.normal();
      sample.cluster.push_back(c);
    }
  }
  return sample;
}

std::vector<std::int64_t> one_cluster_a_pair(Index pairs) {
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(pairs));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// The line through pairs that are clusters of their own.
mpm::LinearFit line(const VectorXd& x, const VectorXd& y) {
  RandomStream stream(8, 0, StreamId::bootstrap);
  return cluster_bootstrap(x, y, one_cluster_a_pair(x.size()), stream, {100, 0.95}).fit;
}

/// Sxy/Sxx in one expression.
double plain_slope(const VectorXd& x, const VectorXd& y) {
  const VectorXd a = x.array() - x.mean();
  return a.dot((y.array() - y.mean()).matrix()) / a.squaredNorm();
}

}  // namespace

TEST_CASE("a line by hand") {
  const VectorXd x = (VectorXd(4) << 1.0, 2.0, 3.0, 4.0).finished();
  const VectorXd y = (VectorXd(4) << 2.0, 3.0, 5.0, 6.0).finished();
  const auto fit = line(x, y);  // Sxx = 5, Sxy = 7, Syy = 10
  CHECK(fit.slope == Approx(1.4).epsilon(1e-15));
  CHECK(fit.intercept == Approx(0.5).epsilon(1e-14));
  CHECK(fit.r_squared == Approx(0.98).epsilon(1e-15));
  CHECK(fit.pairs == 4);
  CHECK(fit.left_out == 0);
}

TEST_CASE("least squares: residuals have no mean and no correlation with x; R^2 is r^2 and 1 - SSE/SST") {
  const VectorXd x = white_noise(80, 1).array() + 4.0;
  const VectorXd y = 0.7 * x + white_noise(80, 2);
  const auto fit = line(x, y);
  const VectorXd residual = y.array() - fit.intercept - fit.slope * x.array();
  const double scale = y.norm() * x.norm();
  CHECK(std::abs(residual.sum()) < 1e-13 * scale);  // roundings of 80 terms
  CHECK(std::abs(residual.dot(x)) < 1e-13 * scale);
  const double r = mpm::pearson_correlation(x, y, 2, 0.0);
  CHECK(fit.r_squared == Approx(r * r).epsilon(1e-13));
  const double total = (y.array() - y.mean()).square().sum();
  CHECK(fit.r_squared == Approx(1.0 - residual.squaredNorm() / total).epsilon(1e-13));
}

TEST_CASE("a fit survives offsets and one wild pair") {
  const VectorXd x = white_noise(50, 3);
  const VectorXd y = 3.0 * x.array() - 1.0;
  const auto far = line(x.array() + 1e8, y.array() + 1e8);
  CHECK(far.slope == Approx(3.0).epsilon(1e-7));  // the offset leaves 8 digits of x and y
  CHECK(far.r_squared == Approx(1.0).epsilon(1e-7));
  VectorXd wild_x = x;
  VectorXd wild_y = y;
  wild_x[7] = 1e9;
  wild_y[7] = 3e9 - 1.0;
  CHECK(line(wild_x, wild_y).slope == Approx(3.0).epsilon(1e-12));
  CHECK(line(wild_x, wild_y).r_squared <= 1.0);
}

TEST_CASE("pairs that are not finite are left out and counted") {
  const VectorXd x = (VectorXd(7) << 1.0, mpm::kNaN, 2.0, 3.0, 5.0, 4.0, mpm::kInfinity).finished();
  const VectorXd y = (VectorXd(7) << 2.0, 9.0, 3.0, 5.0, -mpm::kInfinity, 6.0, 1.0).finished();
  const auto fit = line(x, y);
  CHECK(fit.slope == Approx(1.4).epsilon(1e-15));
  CHECK(fit.pairs == 4);
  CHECK(fit.left_out == 3);
}

TEST_CASE("degenerate fits") {
  const auto check_nothing = [](const mpm::LinearFit& fit) {
    CHECK(std::isnan(fit.slope));
    CHECK(std::isnan(fit.intercept));
    CHECK(std::isnan(fit.r_squared));
  };
  const VectorXd x = (VectorXd(3) << 1.0, 2.0, 3.0).finished();
  check_nothing(line(VectorXd(), VectorXd()));
  check_nothing(line(x.head(2), x.head(2)));
  check_nothing(line(VectorXd::Constant(9, 0.1), white_noise(9, 4)));
  VectorXd rounded = VectorXd::Constant(9, 0.3);
  rounded[2] = 0.1 + 0.2;
  REQUIRE(rounded[2] != 0.3);
  check_nothing(line(rounded, white_noise(9, 4)));
  CHECK(line(VectorXd::Constant(3, mpm::kNaN), x).left_out == 3);
  const auto flat = line(x, VectorXd::Constant(3, 5.0));
  CHECK(flat.slope == 0.0);
  CHECK(flat.intercept == 5.0);
  CHECK(std::isnan(flat.r_squared));
}

TEST_CASE("the bootstrap is a function of its inputs and the stream, not of the order of the clusters") {
  const Sample sample = clustered_sample(40, 7, 1);
  const auto run = [&](std::uint64_t seed, const Sample& s) {
    RandomStream stream(seed, 0, StreamId::bootstrap);
    return cluster_bootstrap(s.x, s.y, s.cluster, stream);
  };
  const auto first = run(1, sample);
  const auto second = run(1, sample);
  CHECK(first.slope.lower == second.slope.lower);
  CHECK(first.r_squared.upper == second.r_squared.upper);
  CHECK(run(2, sample).slope.lower != first.slope.lower);

  Sample backwards = sample;  // the clusters from last to first, the pairs within each as they were
  for (Index c = 0; c < 40; ++c) {
    backwards.x.segment(7 * c, 7) = sample.x.segment(7 * (39 - c), 7);
    backwards.y.segment(7 * c, 7) = sample.y.segment(7 * (39 - c), 7);
    std::fill_n(backwards.cluster.begin() + 7 * c, 7, 39 - c);
  }
  CHECK(run(1, backwards).slope.lower == first.slope.lower);
  CHECK(run(1, backwards).intercept.upper == first.intercept.upper);

  CHECK(first.fit.slope == Approx(plain_slope(sample.x, sample.y)).epsilon(1e-13));
  CHECK(first.clusters == 40);
  CHECK(first.replications_used == 2000);
  CHECK(first.slope.contains(first.fit.slope));
  CHECK(first.intercept.contains(first.fit.intercept));
  CHECK(first.r_squared.contains(first.fit.r_squared));
}

/// Slope and its standard error by the influences of the clusters, from the pairs themselves.
std::pair<double, double> slope_and_error(const VectorXd& x, const VectorXd& y, Index size) {
  const double slope = plain_slope(x, y);
  const VectorXd a = x.array() - x.mean();
  const VectorXd residual = (y.array() - y.mean()).matrix() - slope * a;
  double squares = 0.0;
  for (Index c = 0; c < x.size() / size; ++c)
    squares += std::pow(a.segment(size * c, size).dot(residual.segment(size * c, size)), 2);
  return {slope, std::sqrt(squares) / a.squaredNorm()};
}

TEST_CASE("the interval is that of studentised fits to half of the clusters, whole, drawn with replacement") {
  // An independent route: the same draws, each fitted to the pairs themselves.
  const Sample sample = clustered_sample(12, 5, 2);
  RandomStream stream(9, 0, StreamId::bootstrap);
  mpm::ClusterBootstrapOptions options;
  options.replications = 101;
  options.confidence = 0.5;  // with 101 resamples its ends are the 26th and the 76th order statistic
  const auto result = cluster_bootstrap(sample.x, sample.y, sample.cluster, stream, options);

  RandomStream again(9, 0, StreamId::bootstrap);
  const double slope = plain_slope(sample.x, sample.y);
  std::vector<double> t;
  for (int replication = 0; replication < 101; ++replication) {
    VectorXd x(30), y(30);
    for (Index c = 0; c < 6; ++c) {
      const auto drawn = static_cast<Index>(again.below(12));
      x.segment(5 * c, 5) = sample.x.segment(5 * drawn, 5);
      y.segment(5 * c, 5) = sample.y.segment(5 * drawn, 5);
    }
    const auto [of_resample, error] = slope_and_error(x, y, 5);
    t.push_back((of_resample - slope) / error);
  }
  std::sort(t.begin(), t.end());
  VectorXd without(12);  // the slope without each cluster
  for (Index c = 0; c < 12; ++c) {
    VectorXd x(55), y(55);
    x << sample.x.head(5 * c), sample.x.tail(55 - 5 * c);
    y << sample.y.head(5 * c), sample.y.tail(55 - 5 * c);
    without[c] = plain_slope(x, y);
  }
  const double error = std::sqrt((without.array() - without.mean()).square().sum() * 11.0 / 12.0);
  CHECK(result.slope.lower == Approx(slope - error * t[75]).epsilon(1e-11));
  CHECK(result.slope.upper == Approx(slope - error * t[25]).epsilon(1e-11));
}

TEST_CASE("coverage of the cluster bootstrap") {
  constexpr int kSamples = 300;
  mpm::ClusterBootstrapOptions options;
  options.replications = 400;
  int slope_covered = 0;
  int intercept_covered = 0;
  int covered_without_clusters = 0;
  for (std::uint64_t number = 0; number < kSamples; ++number) {
    const Sample sample = clustered_sample(50, 7, 1000 + number);
    RandomStream stream(5, number, StreamId::bootstrap);
    const auto result = cluster_bootstrap(sample.x, sample.y, sample.cluster, stream, options);
    slope_covered += result.slope.contains(2.0) ? 1 : 0;
    intercept_covered += result.intercept.contains(1.0) ? 1 : 0;
    const auto pairs = one_cluster_a_pair(sample.x.size());
    const auto naive = cluster_bootstrap(sample.x, sample.y, pairs, stream, options);
    covered_without_clusters += naive.slope.contains(2.0) ? 1 : 0;
  }
  // 95 % nominal; the binomial scatter of 300 trials is 1.3 %.
  INFO("slope " << slope_covered << ", intercept " << intercept_covered << ", without clusters "
                << covered_without_clusters);
  CHECK(std::abs(slope_covered / 300.0 - 0.95) < 4 * 0.013);
  CHECK(std::abs(intercept_covered / 300.0 - 0.95) < 4 * 0.013);
  // Taking the 7 pairs of a cluster as independent makes the intervals about sqrt(7) too short: coverage
  // about P(|Z| < 1.96/2.5) = 57 %.
  CHECK(covered_without_clusters / 300.0 < 0.75);
}

/// A sample in which a few clusters are hundreds of times as large as the others, as indices of variance are.
Sample wild_sample(int clusters, std::uint64_t number) {
  RandomStream stream(78, number, StreamId::mismatch);
  Sample sample{VectorXd(2 * clusters), VectorXd(2 * clusters), {}};
  for (Index i = 0; i < 2 * clusters; ++i) {
    const double size = i % 2 == 0 ? std::exp(stream.normal()) : sample.x[i - 1];
    sample.x[i] = size * std::exp(0.3 * stream.normal());
    sample.y[i] = 1.0 + 2.0 * sample.x[i] + size * stream.normal();
    sample.cluster.push_back(i / 2);
  }
  return sample;
}

TEST_CASE("coverage where a few clusters carry the line: the scatter grows with x") {
  constexpr int kSamples = 300;
  mpm::ClusterBootstrapOptions options;
  options.replications = 400;
  const Sample all = wild_sample(200000, 0);
  const double slope = plain_slope(all.x, all.y);
  const double r = mpm::pearson_correlation(all.x, all.y, 2, 0.0);
  int slope_covered = 0, r_squared_covered = 0;
  for (std::uint64_t number = 1; number <= kSamples; ++number) {
    const Sample sample = wild_sample(100, number);
    RandomStream stream(6, number, StreamId::bootstrap);
    const auto result = cluster_bootstrap(sample.x, sample.y, sample.cluster, stream, options);
    slope_covered += result.slope.contains(slope) ? 1 : 0;
    r_squared_covered += result.r_squared.contains(r * r) ? 1 : 0;
  }
  INFO("slope " << slope_covered << ", R^2 " << r_squared_covered);
  CHECK(slope_covered >= 275);
  CHECK(r_squared_covered >= 275);
}

TEST_CASE("the bootstrap interval of independent pairs has the width of the normal theory") {
  const VectorXd x = white_noise(400, 5);
  const VectorXd y = 2.0 * x + white_noise(400, 6);
  RandomStream stream(3, 0, StreamId::bootstrap);
  const auto result = cluster_bootstrap(x, y, one_cluster_a_pair(400), stream);
  const double sxx = (x.array() - x.mean()).square().sum();
  const VectorXd residual = y.array() - result.fit.intercept - result.fit.slope * x.array();
  const double theory = 2.0 * 1.96 * std::sqrt(residual.squaredNorm() / 398.0 / sxx);
  // The bootstrap does not assume equal variances; its standard error is uncertain by about
  // sqrt((kurtosis of x - 1)/(4 n)) = 5 %, and the quantiles of 2000 resamples by 3 %.
  CHECK(result.slope.upper - result.slope.lower == Approx(theory).epsilon(0.2));
}

TEST_CASE("bootstraps without enough clusters or without variation have no intervals") {
  RandomStream stream(4, 0, StreamId::bootstrap);
  const auto check_nothing = [](const mpm::LinearFitIntervals& result) {
    for (const auto& interval : {result.slope, result.intercept, result.r_squared}) {
      CHECK(std::isnan(interval.lower));
      CHECK(std::isnan(interval.upper));
    }
  };
  const VectorXd x = white_noise(10, 7);
  const VectorXd y = white_noise(10, 8);
  const std::vector<std::int64_t> single(10, 42);
  const auto one = cluster_bootstrap(x, y, single, stream);
  check_nothing(one);
  CHECK(one.clusters == 1);
  const std::vector<std::int64_t> few = {1, 1, 1, 2, 2, 2, 3, 3, 4, 4};  // says nothing of the scatter
  check_nothing(cluster_bootstrap(x, y, few, stream));
  CHECK(one.fit.slope == Approx(plain_slope(x, y)));
  CHECK(stream.position() == 0);
  const auto flat = cluster_bootstrap(x, VectorXd::Constant(10, 1.0), one_cluster_a_pair(10), stream);
  check_nothing(flat);
  CHECK(flat.replications_used == 0);
  const auto nothing =
      cluster_bootstrap(VectorXd::Constant(10, mpm::kNaN), y, one_cluster_a_pair(10), stream);
  check_nothing(nothing);
  CHECK(nothing.clusters == 0);
  CHECK(nothing.fit.left_out == 10);
}

TEST_CASE("resamples of one x only are left out where x does not vary within clusters") {
  // Six clusters, five of them with the same x: a resample of five of these, probability (5/6)^5, or of the
  // sixth alone has no line.
  VectorXd x = VectorXd::Constant(12, 1.0);
  x.tail(2).setConstant(3.0);
  const VectorXd y = x + white_noise(12, 10);
  const std::vector<std::int64_t> cluster = {5, 5, -1, -1, 9, 9, 2, 2, 3, 3, 4, 4};
  RandomStream stream(6, 0, StreamId::bootstrap);
  const auto result = cluster_bootstrap(x, y, cluster, stream);
  // Binomial: 2000 * (1 - 0.4020), standard deviation 22.
  CHECK(std::abs(result.replications_used - 2000.0 * (1.0 - 0.4020)) < 4.0 * 21.9);
  CHECK(std::isnan(result.slope.lower));  // one cluster alone makes the line: nothing tells how it scatters
}

TEST_CASE("a line through all pairs has intervals without length, whatever the rounding") {
  const VectorXd x = 3.0 + white_noise(30, 11).array();
  for (const double slope : {1.0, -0.3, 1e-3}) {
    const VectorXd y = 0.7 + slope * x.array();
    RandomStream stream(7, 0, StreamId::bootstrap);
    const auto result = cluster_bootstrap(x, y, one_cluster_a_pair(30), stream);
    CHECK(result.fit.r_squared == 1.0);
    CHECK(result.slope.lower == result.fit.slope);
    CHECK(result.slope.upper == result.fit.slope);
    CHECK(result.intercept.lower == Approx(0.7).epsilon(1e-10));
    CHECK(result.r_squared.lower == 1.0);
  }
}

TEST_CASE("a resample on its line within rounding does not decide the interval") {
  // Seven clusters of a pair: of 2000 resamples of five some have two of them only, and always a line.
  const VectorXd x = white_noise(7, 12), y = x + 0.5 * white_noise(7, 13);
  const auto intervals = [&](double factor) {
    RandomStream stream(7, 0, StreamId::bootstrap);
    return cluster_bootstrap(factor * x, factor * y, one_cluster_a_pair(7), stream);
  };
  const auto result = intervals(1.0), rounded_otherwise = intervals(1.0 / 3.0);
  CHECK(result.replications_used < 2000);
  CHECK(rounded_otherwise.replications_used == result.replications_used);
  CHECK(rounded_otherwise.slope.lower == Approx(result.slope.lower).epsilon(1e-9));
  CHECK(rounded_otherwise.slope.upper == Approx(result.slope.upper).epsilon(1e-9));
  CHECK(rounded_otherwise.r_squared.lower == Approx(result.r_squared.lower).epsilon(1e-9));
}

TEST_CASE("regression refuses impossible input") {
  using mpm::InputError;
  RandomStream stream(1, 0, StreamId::bootstrap);
  const VectorXd x = white_noise(10, 9);
  const auto pairs = one_cluster_a_pair(10);
  CHECK_THROWS_AS(cluster_bootstrap(x, x.head(9), pairs, stream), InputError);
  CHECK_THROWS_AS(cluster_bootstrap(x, x, one_cluster_a_pair(9), stream), InputError);
  CHECK_THROWS_AS(cluster_bootstrap(x, x, pairs, stream, {99, 0.95}), InputError);
  CHECK_THROWS_AS(cluster_bootstrap(x, x, pairs, stream, {2000, 1.0}), InputError);
  CHECK_THROWS_AS(cluster_bootstrap(x, x, pairs, stream, {2000, mpm::kNaN}), InputError);
}
