#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/methods/literature/variability_comparison.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"

using mpm::compare_variability;
using mpm::VariabilityChange;
using mpm::VariabilityComparison;
using mpm::VariabilityLimits;
using mpm::VariabilityOptions;
using mpm::VariabilityStatus;

namespace {

using Cvs = std::vector<Eigen::Index>;

/// White records whose sample covariance is exactly the unit matrix.
Eigen::MatrixXd orthonormal_errors(Eigen::Index ny, Eigen::Index samples) {
  Eigen::MatrixXd errors = mpm::testing::white_noise(ny * samples, 77).reshaped(ny, samples);
  errors = (errors.colwise() - errors.rowwise().mean()).eval();
  const Eigen::MatrixXd covariance = errors * errors.transpose() / static_cast<double>(samples - 1);
  return covariance.llt().matrixL().solve(errors);
}

/// Records with exactly this sample covariance.
Eigen::MatrixXd errors_with(const Eigen::MatrixXd& covariance, Eigen::Index samples) {
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  return factor * orthonormal_errors(covariance.rows(), samples);
}

/// Correlated autoregressions with offsets.
Eigen::MatrixXd random_errors(Eigen::Index ny, Eigen::Index samples, std::uint64_t number) {
  Eigen::MatrixXd errors(ny, samples);
  for (Eigen::Index i = 0; i < ny; ++i)
    errors.row(i) = mpm::testing::settled_autoregression(samples, 0.5 + 0.05 * static_cast<double>(i),
                                                         100 * number + static_cast<std::uint64_t>(i));
  const Eigen::MatrixXd mixing = mpm::testing::white_noise(ny * ny, 5000 + number).reshaped(ny, ny);
  return (mixing * errors).array() + 3.0;
}

/// det cov(e) with sums as they are written.
double covariance_determinant(const Eigen::MatrixXd& errors) {
  const Eigen::Index ny = errors.rows();
  const auto n = static_cast<double>(errors.cols());
  Eigen::MatrixXd covariance(ny, ny);
  for (Eigen::Index i = 0; i < ny; ++i)
    for (Eigen::Index j = 0; j < ny; ++j) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < errors.cols(); ++k)
        sum += errors(i, k) * errors(j, k);
      covariance(i, j) = (sum - errors.row(i).sum() * errors.row(j).sum() / n) / (n - 1.0);
    }
  return covariance.determinant();
}

/// The CVs that are responsible for a change.
Cvs above(const Eigen::VectorXd& cosines, double beta) {
  Cvs cvs;
  for (Eigen::Index i = 0; i < cosines.size(); ++i)
    if (cosines(i) > beta)
      cvs.push_back(i);
  return cvs;
}

Eigen::VectorXd ratios(const VariabilityComparison& comparison) {
  Eigen::VectorXd mu(static_cast<Eigen::Index>(comparison.directions.size()));
  for (Eigen::Index i = 0; i < mu.size(); ++i)
    mu(i) = comparison.directions[static_cast<std::size_t>(i)].mu;
  return mu;
}

/// Of this many pairs of independent autoregressions of 400 samples, how many are called worse, and in how
/// many some CV is named; `factor` scales the variance of the first CV of the second record.
struct CalledWorse {
  int pairs = 0, loops = 0, cvs = 0;
};

CalledWorse called_worse(VariabilityLimits limits, Eigen::Index ny, double a, double factor, int pairs) {
  VariabilityOptions options;
  options.limits = limits;
  CalledWorse called{.pairs = pairs};
  for (int pair = 0; pair < pairs; ++pair) {
    Eigen::MatrixXd records[2];
    for (int i = 0; i < 2; ++i) {
      records[i].resize(ny, 400);
      for (Eigen::Index cv = 0; cv < ny; ++cv)
        records[i].row(cv) = mpm::testing::settled_autoregression(
            400, a, 2'000'000 + static_cast<std::uint64_t>(20 * pair + 10 * i + cv));
    }
    records[1].row(0) *= std::sqrt(factor);
    const VariabilityComparison found = compare_variability(records[0], records[1], options);
    called.loops += found.directions.front().change == VariabilityChange::worse ? 1 : 0;
    called.cvs += above(found.cos_worse, found.beta).empty() ? 0 : 1;
  }
  return called;
}

}  // namespace

TEST_CASE("variability: a period equal to the benchmark has I_v 1 and changes nothing") {
  const Eigen::MatrixXd errors = random_errors(4, 300, 1);
  const VariabilityComparison found = compare_variability(errors, errors);
  REQUIRE(found.status == VariabilityStatus::ok);
  CHECK(found.i_v == Approx(1.0));
  CHECK(ratios(found).isApprox(Eigen::VectorXd::Ones(4), 1e-9));
  for (const auto& direction : found.directions)
    CHECK(direction.change == VariabilityChange::none);
  CHECK(above(found.cos_worse, found.beta).empty());
  CHECK(above(found.cos_better, found.beta).empty());
}

TEST_CASE("variability: a CV scaled by a gives mu = a^2 along exactly that CV") {
  const Eigen::MatrixXd benchmark = orthonormal_errors(4, 400);
  const double a = GENERATE(3.0, 0.2);
  Eigen::MatrixXd monitored = benchmark;
  monitored.row(2) *= a;
  const VariabilityComparison found = compare_variability(benchmark, monitored);
  CHECK(found.i_v == Approx(a * a));
  const auto& direction = a > 1.0 ? found.directions.front() : found.directions.back();
  CHECK(direction.mu == Approx(a * a));
  CHECK(direction.p.isApprox(Eigen::VectorXd::Unit(4, 2), 1e-8));
  CHECK(direction.limits.contains(a * a));
  CHECK(above(found.cos_worse, found.beta) == (a > 1.0 ? Cvs{2} : Cvs{}));
  CHECK(above(found.cos_better, found.beta) == (a > 1.0 ? Cvs{} : Cvs{2}));
  CHECK((a > 1.0 ? found.cos_worse : found.cos_better).isApprox(Eigen::VectorXd::Unit(4, 2), 1e-8));
}

TEST_CASE("variability: one CV worse, another one better") {
  const Eigen::MatrixXd benchmark = orthonormal_errors(3, 400);
  const VariabilityComparison found =
      compare_variability(benchmark, Eigen::Vector3d(4.0, 1.0, 0.25).asDiagonal() * benchmark);
  CHECK(found.i_v == Approx(1.0));  // what I_v alone does not see
  CHECK(above(found.cos_worse, found.beta) == Cvs{0});
  CHECK(above(found.cos_better, found.beta) == Cvs{2});
}

TEST_CASE("variability: two correlated CVs by the roots of the characteristic polynomial") {
  Eigen::Matrix2d benchmark;
  benchmark << 2.0, 1.0, 1.0, 1.0;  // determinant 1
  Eigen::Matrix2d monitored;
  monitored << 3.0, 0.0, 0.0, 2.0;
  const VariabilityComparison found =
      compare_variability(errors_with(benchmark, 200), errors_with(monitored, 300));
  // det(monitored - mu benchmark) = (3 - 2 mu)(2 - mu) - mu^2 = mu^2 - 7 mu + 6
  CHECK(ratios(found).isApprox(Eigen::Vector2d(6.0, 1.0), 1e-8));
  CHECK(found.i_v == Approx(6.0));
  // (monitored - 6 benchmark) p = [-9 -6; -6 -4] p = 0
  CHECK(found.directions[0].p.isApprox(Eigen::Vector2d(-2.0, 3.0).normalized(), 1e-8));
}

TEST_CASE("variability: I_v is the ratio of the determinants") {
  const Eigen::MatrixXd benchmark = random_errors(5, 250, 2);
  const Eigen::MatrixXd monitored = random_errors(5, 400, 3);
  const VariabilityComparison found = compare_variability(benchmark, monitored);
  // The sums lose some digits to the offset of 3.
  CHECK(found.i_v ==
        Approx(covariance_determinant(monitored) / covariance_determinant(benchmark)).epsilon(1e-8));
  CHECK(ratios(found).prod() == Approx(found.i_v));
  // Exchanged periods have the inverse ratios.
  const VariabilityComparison exchanged = compare_variability(monitored, benchmark);
  CHECK(exchanged.i_v == Approx(1.0 / found.i_v));
  CHECK(ratios(exchanged).reverse().cwiseInverse().isApprox(ratios(found), 1e-8));
}

TEST_CASE("variability: ratios and limits are the same in other units and after any linear map") {
  const Eigen::MatrixXd benchmark = random_errors(3, 250, 4);
  const Eigen::MatrixXd monitored = random_errors(3, 250, 5);
  const VariabilityComparison found = compare_variability(benchmark, monitored);
  Eigen::MatrixXd map = mpm::testing::white_noise(9, 6).reshaped(3, 3);
  map.row(1) *= 1e6;  // bar and Pa
  const Eigen::Vector3d offset(1.0, -2.0, 5.0);
  const VariabilityComparison mapped =
      compare_variability((map * benchmark).colwise() + offset, (map * monitored).colwise() - offset);
  CHECK(mapped.i_v == Approx(found.i_v).epsilon(1e-7));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(mapped.directions[i].mu == Approx(found.directions[i].mu).epsilon(1e-7));
    CHECK(mapped.directions[i].limits.lower == Approx(found.directions[i].limits.lower).epsilon(1e-7));
    CHECK(mapped.directions[i].limits.upper == Approx(found.directions[i].limits.upper).epsilon(1e-7));
  }
}

TEST_CASE("variability: a larger disturbance of one CV has a larger mu; both records count for the limits") {
  const Eigen::MatrixXd benchmark = random_errors(3, 300, 7);
  double last = 1.0;
  for (const double size : {1.0, 2.0, 4.0}) {
    Eigen::MatrixXd monitored = benchmark;
    monitored.row(0) += size * benchmark.row(0).reverse();
    const double mu = compare_variability(benchmark, monitored).directions.front().mu;
    CHECK(mu > last);
    last = mu;
  }
  const Eigen::MatrixXd monitored = 1.2 * random_errors(3, 300, 8);
  const auto width = [](const VariabilityComparison& found) {
    const mpm::Interval& limits = found.directions.front().limits;
    return limits.upper / limits.lower;
  };
  const VariabilityComparison loose = compare_variability(benchmark, monitored);
  const VariabilityComparison tight =
      compare_variability(benchmark, monitored, {.confidence = 0.5, .largest_lag = 0});
  const VariabilityComparison few_lags =
      compare_variability(benchmark, monitored, {.confidence = 0.95, .largest_lag = 5});
  CHECK(width(tight) < width(loose));
  CHECK(width(few_lags) < width(loose));
  CHECK(tight.beta < loose.beta);
}

TEST_CASE("variability: a CV that the monitored period holds still is as much better as can be") {
  const Eigen::MatrixXd benchmark = orthonormal_errors(2, 400);
  Eigen::MatrixXd monitored = benchmark;
  monitored.row(1).setConstant(0.1);
  const VariabilityComparison found = compare_variability(benchmark, monitored);
  CHECK(found.directions.back().mu == Approx(0.0).margin(1e-12));
  CHECK(found.i_v == Approx(0.0).margin(1e-12));
  CHECK(above(found.cos_better, found.beta) == Cvs{1});
}

TEST_CASE("variability: a benchmark with linearly dependent errors is a status") {
  const Eigen::MatrixXd monitored = random_errors(3, 200, 9);
  Eigen::MatrixXd benchmark = monitored;
  SECTION("a CV that stands still") {
    benchmark.row(1).setConstant(0.3);
  }
  SECTION("a CV twice, in other units") {
    benchmark.row(1) = 1e5 * benchmark.row(0);
  }
  SECTION("a sum of the others") {
    benchmark.row(2) = benchmark.row(0) - 0.5 * benchmark.row(1);
  }
  SECTION("fewer samples than CVs") {
    benchmark = monitored.leftCols(3).eval();
  }
  const VariabilityComparison found = compare_variability(benchmark, monitored);
  CHECK(found.status == VariabilityStatus::singular_benchmark);
  CHECK(std::isnan(found.i_v));
  CHECK(found.directions.empty());
  CHECK(above(found.cos_worse, found.beta).empty());
  CHECK(to_string(found.status) == "singular benchmark");
}

TEST_CASE("variability: errors in very different units are not singular") {
  Eigen::MatrixXd benchmark = random_errors(3, 200, 10);
  benchmark.row(0) *= 1e-9;
  benchmark.row(1) *= 1e9;
  CHECK(compare_variability(benchmark, 2.0 * benchmark).i_v == Approx(64.0));
}

TEST_CASE("variability: the data choose the directions, which the limits of the largest root allow for") {
  const double allowed = 0.5 * (1.0 - VariabilityOptions{}.confidence);  // by one of the two limits
  const auto least = [](int called, const CalledWorse& of) {
    return mpm::testing::clopper_pearson_interval(called, of.pairs, 0.998).lower;
  };
  for (const Eigen::Index ny : {3, 7})
    for (const double a : {0.0, 0.8}) {
      INFO(ny << " CVs, a = " << a);
      const CalledWorse published = called_worse(VariabilityLimits::published, ny, a, 1.0, 150);
      CHECK(least(published.loops, published) > 2.0 * allowed);
      const CalledWorse repaired = called_worse(VariabilityLimits::largest_root, ny, a, 1.0, 300);
      CHECK(least(repaired.loops, repaired) <= allowed);
      CHECK(least(repaired.cvs, repaired) <= allowed);
    }
  // A variance that doubles is found nevertheless.
  for (const auto& [ny, a] : {std::pair<Eigen::Index, double>{1, 0.8}, {3, 0.5}, {7, 0.0}}) {
    const CalledWorse doubled = called_worse(VariabilityLimits::largest_root, ny, a, 2.0, 100);
    INFO(ny << " CVs, a = " << a << ": " << doubled.loops);
    CHECK(least(doubled.loops, doubled) > 0.5);
    CHECK(least(doubled.cvs, doubled) > 0.5);
  }
}

TEST_CASE("variability: limits of the largest root are the inverse ones for exchanged periods") {
  VariabilityOptions options;
  options.limits = VariabilityLimits::largest_root;
  const Eigen::MatrixXd benchmark = random_errors(3, 250, 12);
  const Eigen::MatrixXd monitored = random_errors(3, 400, 13);
  const auto there = compare_variability(benchmark, monitored, options).directions;
  const auto back = compare_variability(monitored, benchmark, options).directions;
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(there[i].limits.lower == Approx(1.0 / back[2 - i].limits.upper).epsilon(1e-6));
    CHECK(there[i].limits.upper == Approx(1.0 / back[2 - i].limits.lower).epsilon(1e-6));
  }
  // Four samples of three CVs bound nothing.
  Eigen::MatrixXd few(3, 4);
  few << 0, 1, 2, 3, 0, 1, 4, 9, 0, 1, 0, 1;
  for (const auto& direction : compare_variability(few, 100.0 * few, options).directions) {
    CHECK(direction.limits.lower == 0.0);
    CHECK(direction.limits.upper == mpm::kInfinity);
  }
}

TEST_CASE("variability refuses what cannot be meant") {
  const Eigen::MatrixXd errors = random_errors(2, 50, 11);
  CHECK_THROWS_WITH(compare_variability(errors, errors.topRows(1)), Catch::Contains("found 1"));
  CHECK_THROWS_WITH(compare_variability(errors.leftCols(1), errors), Catch::Contains("benchmark"));
  Eigen::MatrixXd bad = errors;
  bad(1, 7) = mpm::kNaN;
  CHECK_THROWS_WITH(compare_variability(errors, bad),
                    Catch::Contains("monitored period, CV 1") && Catch::Contains("sample 7"));
  CHECK_THROWS_AS(compare_variability(errors, errors, {.confidence = 1.0}), mpm::InputError);
  CHECK_THROWS_WITH(compare_variability(errors, errors, {.largest_lag = -1}), Catch::Contains("largest_lag"));
}
