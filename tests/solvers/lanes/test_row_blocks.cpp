#include <cmath>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "solvers/lanes/lane_vector.hpp"
#include "solvers/lanes/row_blocks.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kRunCvs = 3, kRunSamples = 43, kRunMvs = 2;

// What moves do to CVs with these step responses of sample l, dead times among them.
template <typename StepResponse>
RowMajorMatrix predicted_rows(Eigen::Index moves, const StepResponse& response) {
  RowMajorMatrix rows = RowMajorMatrix::Zero(kRunCvs * kRunSamples, kRunMvs * moves);
  for (Eigen::Index cv = 0; cv < kRunCvs; ++cv)
    for (Eigen::Index j = 0; j < kRunMvs; ++j) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(kRunSamples + 1);
      for (Eigen::Index l = 2 + cv; l <= kRunSamples; ++l)
        step(l) = response(static_cast<double>(l - 1 - cv), static_cast<double>(kRunMvs * cv + j + 1));
      for (Eigen::Index l = 1; l <= kRunSamples; ++l)
        for (Eigen::Index i = 0; i < moves && i < l; ++i)
          rows(cv * kRunSamples + l - 1, i * kRunMvs + j) =
              step(l - i) - (i == moves - 1 ? 0.0 : step(l - i - 1));
    }
  return rows;
}

// Column after column, as the kernels do.
void require_exact_product(const RowMajorMatrix& rows) {
  const RowBlocks blocks(rows);
  const std::vector<int> order = blocks.column_order();
  CHECK(std::set<int>(order.begin(), order.end()).size() == static_cast<std::size_t>(rows.cols()));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows.cols(), -1.0, 0.7).array().sin();
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(rows.rows());
  for (const int j : order)
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      expected(i) += x(j) * rows(i, j);
  LaneVector product(rows.rows());
  blocks.multiply(x.data(), product);
  CHECK(product.vector() == expected);
  for (Eigen::Index i = rows.rows(); i < padded(rows.rows()); ++i)
    CHECK(product(i) == 0.0);
}

}  // namespace

TEST_CASE("rows of a prediction share their numbers, and their product is that of the whole rows to the bit",
          "[lanes]") {
  // 19 moves: of moves eight samples apart one takes the numbers of the other, but not all have such a one.
  const Eigen::Index moves = GENERATE(6, 12, 19);
  std::mt19937 generator(5);
  RowMajorMatrix rows = predicted_rows(
      moves, [&](double, double) { return static_cast<double>(generator()) / 2147483648.0 - 1.0; });
  require_exact_product(rows);
  CHECK(RowBlocks(rows).late_row_count() == 0);
  const std::size_t shared = RowBlocks(rows).number_count();
  CHECK(shared < static_cast<std::size_t>(kRunCvs * padded(kRunSamples) * rows.cols()));

  rows(36, 5) = std::nextafter(rows(36, 5), 2.0);  // its run ends before it
  CHECK(RowBlocks(rows).late_row_count() == 0);
  require_exact_product(rows);
  CHECK(RowBlocks(rows).number_count() != shared);
}

TEST_CASE("after the last move the rows of a model of low order are combinations of few", "[lanes]") {
  const Eigen::Index moves = 12;
  const RowMajorMatrix rows = predicted_rows(
      moves, [](double l, double channel) { return channel * (1.0 - std::exp(-l / (3.0 + channel))); });
  const RowBlocks blocks(rows);
  CHECK(blocks.late_row_count() == kRunCvs * 32);  // 27 of 43 rows each, behind two blocks of windows
  CHECK(3 * blocks.number_count() < static_cast<std::size_t>(rows.size()));

  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows.cols(), -1.0, 0.7).array().sin();
  LaneVector product(rows.rows());
  blocks.multiply(x.data(), product);
  CHECK((product.vector() - rows * x).norm() <= 1e-15 * rows.norm() * x.norm());
  for (Eigen::Index i = rows.rows(); i < padded(rows.rows()); ++i)
    CHECK(product(i) == 0.0);
}

TEST_CASE("rows without an order are kept as they are", "[lanes]") {
  for (const auto& [m, n] : {std::pair{1, 1}, std::pair{7, 3}, std::pair{65, 13}, std::pair{16, 12}}) {
    std::srand(7);
    const RowMajorMatrix rows = RowMajorMatrix::Random(m, n);
    require_exact_product(rows);
    CHECK(RowBlocks(rows).number_count() == static_cast<std::size_t>(padded(m) * n));
  }
  require_exact_product(RowMajorMatrix::Zero(24, 8));
  require_exact_product(RowMajorMatrix(0, 4));
}

}  // namespace mpm
