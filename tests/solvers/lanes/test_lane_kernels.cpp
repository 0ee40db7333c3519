#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/lanes/lane_kernels.hpp"
#include "solvers/lanes/lane_vector.hpp"

// Every set of kernels that this machine can run against Eigen, and against the bits of the first set. On a
// machine without the wider registers the comparison of bits has nothing to compare; the values are checked
// all the same.

namespace mpm {
namespace {

// Sums of a few hundred products of numbers of the size of 1.
constexpr double kSumRounding = 1e-12;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}
  double next() { return static_cast<double>(generator_()) / 2147483648.0 - 1.0; }
  LaneVector vector(Eigen::Index size) {
    LaneVector result(size);
    for (Eigen::Index i = 0; i < size; ++i)
      result(i) = next();
    return result;
  }
  LaneMatrix matrix(Eigen::Index rows, Eigen::Index columns) {
    LaneMatrix result(rows, columns);
    for (Eigen::Index j = 0; j < columns; ++j)
      for (Eigen::Index i = 0; i < rows; ++i)
        result(i, j) = next();
    return result;
  }
  std::vector<int> some_of(int count) {
    std::vector<int> result;
    for (int i = 0; i < count; ++i)
      if (next() > -0.3)
        result.push_back(i);
    return result;
  }

 private:
  std::mt19937 generator_;
};

Eigen::Map<const Eigen::MatrixXd> all_of(const LaneMatrix& matrix) {
  return {matrix.data(), matrix.stride(), matrix.columns()};
}

// The bits of what the kernels of each set computed, in the order of the sets.
class SameBits {
 public:
  void add(const Eigen::Ref<const Eigen::VectorXd>& values) {
    if (first_.size() == 0)
      first_ = values;
    REQUIRE(first_.size() == values.size());
    CHECK(std::memcmp(first_.data(), values.data(),
                      sizeof(double) * static_cast<std::size_t>(values.size())) == 0);
  }

 private:
  Eigen::VectorXd first_;
};

struct Sizes {
  Eigen::Index variables, rows;
};

Sizes sizes() {
  return GENERATE(Sizes{1, 1}, Sizes{3, 7}, Sizes{8, 8}, Sizes{13, 65}, Sizes{45, 525}, Sizes{70, 41});
}

}  // namespace

TEST_CASE("products with rows and columns are those of Eigen, with the same bits from all kernels",
          "[lanes]") {
  const auto [n, m] = sizes();
  Numbers numbers(1);
  const LaneMatrix rows = numbers.matrix(n, m);  // a row a column
  const LaneVector x = numbers.vector(n);
  const LaneVector factor = numbers.vector(m);
  const std::vector<int> list = numbers.some_of(static_cast<int>(m));
  LaneMatrix blocks(8 * n, padded(m) / 8);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      blocks(8 * j + i % 8, i / 8) = rows(j, i);
  std::vector<RowTap> taps;
  for (Eigen::Index j = 0; j < n; ++j)
    taps.push_back({8 * j, static_cast<int>(j), 0});
  // The same blocks as runs of one block each, and as one run whose columns lie one behind the other.
  std::vector<long> starts, row;
  for (Eigen::Index k = 0; k < blocks.columns(); ++k) {
    starts.push_back(k * blocks.stride());
    row.push_back(8 * k);
  }
  const RowWindows runs{blocks.data(), taps.data(), 0, n, 1, starts.data(), row.data(), blocks.columns()};
  LaneMatrix columns_of_rows(m, n);
  std::vector<RowTap> column_taps;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < m; ++i)
      columns_of_rows(i, j) = rows(j, i);
    column_taps.push_back({j * columns_of_rows.stride(), static_cast<int>(j), 0});
  }
  const RowWindows one_run{columns_of_rows.data(), column_taps.data(), 0,          n,
                           blocks.columns(),       starts.data(),      row.data(), 1};
  Eigen::VectorXd listed = Eigen::VectorXd::Zero(m);
  for (const int i : list)
    listed(i) = factor(i);

  SameBits products, sums, columns, dots;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    LaneVector product(m);
    kernels->multiply(runs, x.data(), product.data());
    CHECK((product.vector() - all_of(rows).topRows(n).transpose() * x.vector()).norm() <= kSumRounding);
    products.add(product.vector());

    LaneVector same_product(m);
    kernels->multiply(one_run, x.data(), same_product.data());
    CHECK(same_product.vector() == product.vector());

    // Of x every second number, last first.
    LaneVector twice(2 * n);
    std::vector<int> places;
    for (Eigen::Index j = 0; j < n; ++j) {
      places.push_back(static_cast<int>(2 * (n - 1 - j)));
      twice(places.back()) = x(j);
    }
    kernels->multiply_some(blocks.data(), places.data(), n, padded(m) / 8, twice.data(), same_product.data());
    CHECK(same_product.vector() == product.vector());

    LaneVector sum = x;
    kernels->add_rows(rows.data(), rows.stride(), list.data(), static_cast<long>(list.size()), factor.data(),
                      sum.data());
    CHECK((sum.vector() - x.vector() - all_of(rows).topRows(n) * listed).norm() <= kSumRounding);
    sums.add(sum.vector());

    LaneVector column_sum = x;
    kernels->add_product(rows.data(), rows.stride(), m, factor.data(), column_sum.data());
    CHECK((column_sum.vector() - x.vector() - all_of(rows).topRows(n) * factor.vector()).norm() <=
          kSumRounding);
    columns.add(column_sum.vector());

    const double dot = kernels->dot(product.data(), factor.data(), padded(m));
    CHECK(std::abs(dot - product.vector().dot(factor.vector())) <= kSumRounding);
    dots.add(Eigen::VectorXd::Constant(1, dot));
  }
}

// B/(1 + a_1 q^-1 + ...) of signals with one in each row, from rest, sample by sample.
Eigen::MatrixXd filtered_rows(const Eigen::MatrixXd& B, const Eigen::MatrixXd& A, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    for (Eigen::Index i = 0; i < std::min(B.cols(), k + 1); ++i)
      y.col(k).array() += B.col(i).array() * x.col(k - i).array();
    for (Eigen::Index i = 1; i < std::min(A.cols(), k + 1); ++i)
      y.col(k).array() -= A.col(i).array() * y.col(k - i).array();
  }
  return y;
}

TEST_CASE("filters side by side are those of their definitions, with the same bits", "[lanes]") {
  const Eigen::Index size = GENERATE(1, 61);
  const Eigen::Index order = GENERATE(0, 1, 3, 7, 8, 11);  // in registers, and too many for them
  constexpr Eigen::Index kNumerators = 3, kBefore = kNumerators - 1;
  Numbers numbers(5);
  const LaneMatrix numerators = numbers.matrix(8, kNumerators), denominators = numbers.matrix(8, order + 1);
  LaneMatrix x(8, kBefore + size);  // a sample a column, zeros before the first
  for (Eigen::Index k = kBefore; k < x.columns(); ++k)
    for (Eigen::Index lane = 0; lane < 8; ++lane)
      x(lane, k) = numbers.next();
  const Eigen::MatrixXd expected =
      filtered_rows(all_of(numerators), all_of(denominators), all_of(x).rightCols(size));

  const Eigen::Index memory = std::max<Eigen::Index>(1, order);
  SameBits filtered;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name, order);
    LaneMatrix y(8, memory + size);
    kernels->filter_eight(numerators.data(), kNumerators, denominators.data(), order, x.column(kBefore), size,
                          y.column(memory));
    // Filters with random denominators grow.
    CHECK((all_of(y).rightCols(size) - expected).norm() <= kSumRounding * expected.norm());
    CHECK(all_of(y).leftCols(memory).isZero(0.0));
    filtered.add(all_of(y).reshaped());
  }
}

TEST_CASE("two filters one behind the other are those that one kernel after another gives", "[lanes]") {
  const Eigen::Index size = 61;
  const Eigen::Index order = GENERATE(range(1, static_cast<int>(LaneKernels::kPathOrder) + 1));
  Numbers numbers(6);
  const LaneMatrix first = numbers.matrix(8, order + 1), numerators = numbers.matrix(8, order + 1);
  const LaneMatrix second = numbers.matrix(8, order + 1), x = numbers.matrix(8, size);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(8, 1);
  const Eigen::MatrixXd once = filtered_rows(one, all_of(first), all_of(x));
  const Eigen::MatrixXd path = filtered_rows(all_of(numerators), one, once);
  const Eigen::MatrixXd twice = filtered_rows(one, all_of(second), path);

  SameBits bits;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name, order);
    LaneMatrix between(8, size), out(8, size), halfway(8, size);
    kernels->filter_paths(first.data(), numerators.data(), second.data(), order, x.data(), size,
                          between.data(), out.data());
    CHECK((all_of(between) - path).norm() <= kSumRounding * path.norm());
    CHECK((all_of(out) - twice).norm() <= kSumRounding * twice.norm());
    bits.add(all_of(out).reshaped());
    kernels->filter_paths(first.data(), numerators.data(), nullptr, order, x.data(), size, between.data(),
                          halfway.data());
    CHECK((all_of(between) - path).norm() <= kSumRounding * path.norm());
    CHECK((all_of(halfway) - once).norm() <= kSumRounding * once.norm());
  }
}

TEST_CASE("products with signals before are sums over the samples, with the same bits", "[lanes]") {
  const Eigen::Index size = GENERATE(1, 128, 300);  // of one part of the record, and of several
  const Eigen::Index lags = GENERATE(1, 5, 8, 26);
  const Eigen::Index signals = GENERATE(1, 3, 6, 8);
  Numbers numbers(7);
  const LaneMatrix a = numbers.matrix(8, size), b = numbers.matrix(8, lags + size);
  const auto before = [&](Eigen::Index lag) { return all_of(b).middleCols(lags - lag, size); };
  SameBits all_bits, own_bits;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name, size, lags, signals);
    LaneMatrix sums(8, signals * lags), own(8, lags), shifted(8, lags);
    kernels->lag_products(a.data(), b.column(lags), size, signals, lags, sums.data());
    kernels->lane_products(a.data(), b.column(lags), size, lags, own.data());
    kernels->lane_products(a.data(), b.column(lags) - 4, size, lags, shifted.data());
    double largest = 0.0;
    for (Eigen::Index l = 0; l < lags; ++l) {
      const Eigen::MatrixXd all_pairs = all_of(a) * before(l).transpose();
      for (Eigen::Index s = 0; s < signals; ++s)
        largest =
            std::max(largest, (all_of(sums).col(s * lags + l) - all_pairs.col(s)).cwiseAbs().maxCoeff());
      largest = std::max(largest, (all_of(own).col(l) - all_pairs.diagonal()).cwiseAbs().maxCoeff());
      for (Eigen::Index lane = 4; lane < 8; ++lane)
        largest = std::max(largest, std::abs(shifted(lane, l) - all_pairs(lane, lane - 4)));
      for (Eigen::Index lane = 0; lane < 4; ++lane)
        largest = std::max(largest,
                           std::abs(shifted(lane, l) - all_of(a).row(lane).dot(before(l + 1).row(lane + 4))));
    }
    CHECK(largest <= kSumRounding);
    all_bits.add(all_of(sums).reshaped());
    own_bits.add(all_of(own).reshaped());
  }
}

TEST_CASE("a convolution is the sum over its past, with the same bits", "[lanes]") {
  const Eigen::Index size = GENERATE(8, 40, 104);
  const Eigen::Index nh = GENERATE(1, 7, 33, 200);  // shorter and longer than the signal
  constexpr Eigen::Index kBefore = LaneKernels::kConvolutionBefore;
  Numbers numbers(9);
  const Eigen::VectorXd h = numbers.vector(nh).vector();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(kBefore + size);
  x.tail(size) = numbers.vector(size).vector();
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(size);
  for (Eigen::Index k = 0; k < size; ++k)
    for (Eigen::Index l = 0; l < std::min(nh, k + 1); ++l)
      expected(k) += h(l) * x(kBefore + k - l);
  SameBits bits;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name, size, nh);
    LaneVector y(size);
    kernels->convolve(h.data(), nh, x.data() + kBefore, size, y.data());
    CHECK((y.vector() - expected).norm() <= kSumRounding * expected.norm());
    bits.add(y.vector());
  }
}

TEST_CASE("outer products, factor and solution are those of Eigen, with the same bits from all kernels",
          "[lanes]") {
  const auto [n, m] = sizes();
  Numbers numbers(2);
  const LaneMatrix rows = numbers.matrix(n, m);
  const std::vector<int> list = numbers.some_of(static_cast<int>(m));
  const LaneVector weight = numbers.vector(m);
  const LaneVector right = numbers.vector(n);
  const Eigen::Index stride = padded(n);

  SameBits matrices, solutions;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    LaneMatrix matrix(n, stride);
    for (Eigen::Index j = 0; j < stride; ++j)
      matrix(j, j) = j < n ? 1e3 : 1.0;
    Eigen::MatrixXd expected = 1e3 * Eigen::MatrixXd::Identity(n, n);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const auto row = all_of(rows).col(list[k]).head(n);
      expected += weight(static_cast<Eigen::Index>(k)) * row * row.transpose();
    }
    LaneVector scratch(LaneKernels::kOuterRows * stride);
    kernels->add_outer(rows.data(), rows.stride(), list.data(), static_cast<long>(list.size()), weight.data(),
                       scratch.data(), matrix.data(), stride);
    const Eigen::MatrixXd lower = all_of(matrix).topLeftCorner(n, n).triangularView<Eigen::Lower>();
    CHECK((lower - Eigen::MatrixXd(expected.triangularView<Eigen::Lower>())).norm() <=
          kSumRounding * expected.norm());
    matrices.add(lower.reshaped());

    LaneMatrix factor(n, stride);
    LaneVector inverse(LaneKernels::kInverse * stride);
    LaneVector x = right;
    REQUIRE(kernels->factor(matrix.data(), stride, stride, 1e-15, factor.data(), inverse.data()));
    kernels->solve_lower(factor.data(), stride, stride, inverse.data(), x.data());
    CHECK((x.vector() - expected.llt().matrixL().solve(right.vector())).norm() <= kSumRounding);
    kernels->solve_upper(factor.data(), stride, stride, inverse.data(), x.data());
    CHECK((x.vector() - expected.llt().solve(right.vector())).norm() <= kSumRounding);
    solutions.add(x.vector());

    LaneVector reciprocal(n);
    std::fill(reciprocal.data(), reciprocal.data() + stride, 1.0);
    reciprocal.vector() = expected.llt().matrixL().toDenseMatrix().diagonal().cwiseInverse();
    LaneVector again(inverse.size());
    kernels->invert(factor.data(), stride, stride, reciprocal.data(), again.data());
    CHECK((again.vector() - inverse.vector()).norm() <= kSumRounding);
  }
}

TEST_CASE("limits in order and finite numbers are found by every kernel", "[lanes]") {
  const Eigen::Index m = sizes().rows;
  Numbers numbers(4);
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    Eigen::VectorXd lower = Eigen::VectorXd::Constant(m, -kInfinity);
    Eigen::VectorXd upper = Eigen::VectorXd::Constant(m, kInfinity);
    const auto ordered = [&] { return kernels->ordered(lower.data(), upper.data(), m); };
    CHECK(ordered());
    const Eigen::Index last = m - 1;
    lower(last) = upper(last) = 1.5;
    CHECK(ordered());
    for (const auto& [low, high] : {std::pair{1.0, 0.5}, std::pair{kNaN, 1.0}, std::pair{1.0, kNaN},
                                    std::pair{kInfinity, kInfinity}, std::pair{-kInfinity, -kInfinity}}) {
      lower(last) = low;
      upper(last) = high;
      CHECK_FALSE(ordered());
    }
    Eigen::VectorXd x = numbers.vector(m).vector();
    CHECK(kernels->finite(x.data(), m));
    for (const double value : {kNaN, kInfinity, -kInfinity}) {
      x(last) = value;
      CHECK_FALSE(kernels->finite(x.data(), m));
    }
  }
}

TEST_CASE("slacks and places of numbers are the same from all kernels", "[lanes]") {
  const Eigen::Index m = sizes().rows;
  Numbers numbers(4);
  const LaneVector slack = numbers.vector(m);
  const LaneVector quadratic = numbers.vector(m);
  const LaneVector linear = numbers.vector(m);
  const LaneVector pull = numbers.vector(m);
  const SlackArrays slacks{m, slack.data(), quadratic.data(), linear.data(), pull.data()};
  double below = 0.0;
  double residual = 0.0;
  Eigen::VectorXd some = slack.vector();
  std::vector<int> kept;
  for (Eigen::Index i = 0; i < m; ++i) {
    const double multiplier = linear(i) + 2.0 * quadratic(i) * slack(i) - std::abs(pull(i));
    below = std::max(below, -slack(i));
    residual = std::max({residual, -multiplier, std::abs(multiplier * slack(i))});
    if (i % 3 == 1)
      some(i) = i % 2 == 0 ? 0.0 : -0.0;
    else
      kept.push_back(static_cast<int>(i));
  }
  SameBits costs;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    const Eigen::ArrayXd s = slack.vector().array();
    const double cost = kernels->slack_cost(slacks);
    CHECK(std::abs(cost - (s * (quadratic.vector().array() * s + linear.vector().array())).sum()) <=
          kSumRounding);
    costs.add(Eigen::VectorXd::Constant(1, cost));
    CHECK(kernels->slack_residual(slacks) == residual);
    CHECK(kernels->below_zero(slack.data(), m) == below);
    std::vector<int> places(static_cast<std::size_t>(m));
    places.resize(static_cast<std::size_t>(kernels->non_zero(some.data(), m, places.data())));
    CHECK(places == kept);
  }
}

TEST_CASE("springs and residuals are the same from all kernels", "[lanes]") {
  const Eigen::Index m = sizes().rows;
  Numbers numbers(3);
  const LaneVector stiffness = [&] {
    LaneVector result = numbers.vector(m);
    result.vector() = result.vector().cwiseAbs();
    return result;
  }();
  const LaneVector start = numbers.vector(m);
  const LaneVector step = numbers.vector(m);
  const LaneVector slack = stiffness;
  LaneVector lower(m), upper(m);
  lower.vector().setConstant(-0.3);
  upper.vector().setConstant(0.4);
  lower(0) = -kInfinity;

  SameBits within, stretched_again, pulled_again;
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    LaneVector value = start;
    LaneVector force(m);
    std::vector<unsigned char> stretched(static_cast<std::size_t>(padded(m) / 8));
    const SpringArrays springs{padded(m) / 8, stiffness.data(), lower.data(), upper.data(),
                               step.data(),   value.data(),     force.data(), stretched.data()};
    const auto advance = [&](double t) { value.vector() += t * step.vector(); };
    kernels->pull(springs);
    double curvature = 0.0;
    std::vector<int> expected_changes;
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto pulled = [&](double v) {
        return stiffness(i) * (v - std::min(std::max(v, lower(i)), upper(i)));
      };
      CHECK(force(i) == pulled(start(i)));
      CHECK((stretched[static_cast<std::size_t>(i / 8)] >> (i % 8) & 1) == (force(i) != 0.0));
      if (force(i) != 0.0)
        curvature += stiffness(i) * step(i) * step(i);
      const double moved = pulled(start(i) + step(i));
      if ((moved > 0.0) != (force(i) > 0.0) || (moved < 0.0) != (force(i) < 0.0))
        expected_changes.push_back(static_cast<int>(i));
    }
    CHECK(std::abs(kernels->curvature(springs) - curvature) <= kSumRounding);
    std::vector<int> changes(static_cast<std::size_t>(padded(m)));
    changes.resize(static_cast<std::size_t>(kernels->find_changing(springs, changes.data())));
    CHECK(changes == expected_changes);

    advance(1.0);
    kernels->pull_within(springs);
    within.add(force.vector());
    kernels->pull_stretched(springs);
    stretched_again.add(force.vector());
    LaneVector nowhere(m);
    nowhere.vector().setConstant(kInfinity);
    SpringArrays free = springs;
    free.lower = free.upper = nowhere.data();
    kernels->pull_stretched(free);
    CHECK(force.vector().isZero(0.0));
    advance(0.25);
    kernels->pull(springs);
    pulled_again.add(force.vector());

    const LimitArrays limits{m, value.data(), lower.data(), upper.data(), force.data(), nullptr};
    LimitArrays widened = limits;
    widened.slack = slack.data();
    for (const LimitArrays& some : {limits, widened}) {
      double violation = 0.0;
      double complementarity = 0.0;
      long farthest = -1;
      for (Eigen::Index i = 0; i < m; ++i) {
        const double wider = some.slack == nullptr ? 0.0 : slack(i);
        const double excess = std::max(lower(i) - wider - value(i), value(i) - (upper(i) + wider));
        if (excess > violation) {
          violation = excess;
          farthest = i;
        }
        const double limit = force(i) > 0.0 ? upper(i) + wider : lower(i) - wider;
        complementarity = std::max(complementarity, std::abs(force(i) * (limit - value(i))));
      }
      CHECK(kernels->violation(some) == violation);
      double most = 0.0;
      CHECK(kernels->most_violated(some, &most) == farthest);
      CHECK(most == violation);
      CHECK(kernels->most_violated(some, &most) == -1);  // none is farther
      CHECK(most == violation);
      CHECK(kernels->complementarity(some) == complementarity);
      const double pushed = force(0);
      force(0) = -2.0;  // pushes at a limit that is not there
      CHECK(kernels->complementarity(some) == std::max(2.0, complementarity));
      force(0) = pushed;
    }
  }
}

TEST_CASE("a matrix that is not definite has no factor in any kernel", "[lanes]") {
  for (const LaneKernels* kernels : lane_kernel_sets()) {
    CAPTURE(kernels->name);
    LaneMatrix matrix(10, 16), factor(10, 16);
    LaneVector inverse(LaneKernels::kInverse * 16);
    for (Eigen::Index j = 0; j < 16; ++j)
      matrix(j, j) = 1.0;
    CHECK(kernels->factor(matrix.data(), 16, 16, 1e-15, factor.data(), inverse.data()));
    matrix(9, 3) = 1.0;  // rows 3 and 9 are the same
    CHECK_FALSE(kernels->factor(matrix.data(), 16, 16, 1e-15, factor.data(), inverse.data()));
    matrix(9, 3) = kNaN;
    CHECK_FALSE(kernels->factor(matrix.data(), 16, 16, 1e-15, factor.data(), inverse.data()));
  }
}

}  // namespace mpm
