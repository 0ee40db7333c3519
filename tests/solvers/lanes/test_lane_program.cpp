#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "scenarios/random/random_stream.hpp"
#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/lanes/lane_kernels.hpp"
#include "solvers/lanes/lane_program.hpp"
#include "solvers/lanes/lane_vector.hpp"
#include "solvers/lanes/row_band.hpp"
#include "solvers/qp.hpp"

namespace mpm {
namespace {

// Sums of some hundred products of numbers of the size of 1.
constexpr double kOuterRounding = 1e-12;

/// Rows as those of a controller: `groups` of `length` rows, each with `width` of `n` columns, the first rows
/// with fewer of them.
RowMajorMatrix sparse_rows(Eigen::Index groups, Eigen::Index length, Eigen::Index width, Eigen::Index n) {
  RandomStream random(1, 0, StreamId::mismatch);
  RowMajorMatrix rows = RowMajorMatrix::Zero(groups * length, n);
  for (Eigen::Index g = 0; g < groups; ++g)
    for (Eigen::Index c = 0; c < width; ++c) {
      const Eigen::Index column = (7 * g + 3 * c) % n;  // n is not divisible by 3: all of them differ
      for (Eigen::Index i = g * length + c / 4; i < (g + 1) * length; ++i)
        rows(i, column) = random.uniform(-1.0, 1.0);
    }
  return rows;
}

Eigen::VectorXd random_vector(Eigen::Index size, StreamId stream) {
  RandomStream random(2, 0, stream);
  Eigen::VectorXd result(size);
  for (double& value : result)
    value = random.uniform(-1.0, 1.0);
  return result;
}

}  // namespace

TEST_CASE("rows with zero columns are kept as bands, others whole", "[lanes]") {
  const std::vector<RowBand> bands = row_bands(sparse_rows(5, 70, 12, 50));
  REQUIRE(bands.size() == 5);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    CHECK(bands[b].first == static_cast<Eigen::Index>(70 * b));
    CHECK(bands[b].count == 70);
    CHECK(bands[b].width() == 12);
  }
  CHECK(row_bands(sparse_rows(5, 70, 40, 50)).size() == 1);
  CHECK(row_bands(RowMajorMatrix::Zero(20, 600)).size() == 1);
  CHECK(row_bands(RowMajorMatrix::Ones(20, 600)).front().width() == 600);
  CHECK(row_bands(RowMajorMatrix(0, 4)).empty());
}

TEST_CASE("products with bands of rows are those with all columns, to the bit", "[lanes]") {
  // 1 row, less than a block, blocks and a part, more than are multiplied at once.
  const Eigen::Index length = GENERATE(1, 5, 20, 70, 140);
  const Eigen::Index n = 50;
  const RowMajorMatrix rows = sparse_rows(6, length, 12, n);
  const Eigen::Index m = rows.rows();
  const LaneProgram program(Eigen::MatrixXd::Identity(n, n), rows);
  REQUIRE(row_bands(rows).size() > 1);
  LaneMatrix dense(n, m);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      dense(j, i) = rows(i, j);
  const LaneVector x(random_vector(n, StreamId::excitation));
  const LaneVector factor(random_vector(m, StreamId::tuning));
  const std::vector<double> weight(factor.data(), factor.data() + m);
  std::vector<int> list;  // of the second band nothing
  for (int i = 0; i < static_cast<int>(m); ++i)
    if ((i < length || i >= 2 * length) && i % 5 != 3)
      list.push_back(i);
  const LaneKernels& kernels = lane_kernels();

  LaneVector product(m);
  program.multiply_rows(x.data(), product);
  for (Eigen::Index i = 0; i < m; ++i) {
    double sum = 0.0;  // in the order of the columns, as the kernels do
    for (Eigen::Index j = 0; j < n; ++j)
      sum += rows(i, j) * x(j);
    CHECK(product(i) == sum);
  }

  LaneVector sum = x;
  LaneVector dense_sum = x;
  program.add_rows(list, factor.data(), sum);
  kernels.add_rows(dense.data(), dense.stride(), list.data(), static_cast<long>(list.size()), factor.data(),
                   dense_sum.data());
  CHECK(sum.vector() == dense_sum.vector());
  CHECK((sum.vector() - x.vector()).norm() > 0.1);

  LaneMatrix matrix(n, padded(n));
  LaneMatrix dense_matrix(n, padded(n));
  for (Eigen::Index j = 0; j < padded(n); ++j)
    matrix(j, j) = dense_matrix(j, j) = 3.0;
  LaneVector scratch(program.outer_scratch());
  LaneVector dense_scratch(LaneKernels::kOuterRows * dense.stride());
  program.add_outer(list, weight, scratch, matrix);
  kernels.add_outer(dense.data(), dense.stride(), list.data(), static_cast<long>(list.size()), weight.data(),
                    dense_scratch.data(), dense_matrix.data(), dense_matrix.stride());
  Eigen::MatrixXd expected = 3.0 * Eigen::MatrixXd::Identity(n, n);
  for (std::size_t k = 0; k < list.size(); ++k)
    expected += weight[k] * rows.row(list[k]).transpose() * rows.row(list[k]);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      CHECK(matrix(i, j) == dense_matrix(i, j));
      CHECK(std::abs(matrix(i, j) - expected(i, j)) <= kOuterRounding);
    }
}

}  // namespace mpm
