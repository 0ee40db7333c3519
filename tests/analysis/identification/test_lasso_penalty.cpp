#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/identification/lasso_penalty.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

/// Groups of two autoregressions each, and one without columns at the end.
std::vector<Eigen::MatrixXd> some_groups(Eigen::Index rows) {
  std::vector<Eigen::MatrixXd> groups;
  for (std::uint64_t j = 0; j < 3; ++j) {
    Eigen::MatrixXd group(rows, 2);
    group.col(0) = testing::settled_autoregression(rows, 0.8, 500 + j);
    group.col(1) = testing::settled_autoregression(rows, 0.8, 600 + j);
    groups.push_back(group);
  }
  groups.emplace_back(rows, 0);
  return groups;
}

}  // namespace

TEST_CASE("lasso penalty: what the groups explain is predicted, and noise alone lets next to nothing in") {
  const Eigen::Index rows = 400;
  const std::vector<Eigen::MatrixXd> groups = some_groups(rows);
  const Eigen::Vector2d truth(2.0, -1.0);
  const Eigen::VectorXd noise = testing::white_noise(rows, 9);
  const Eigen::VectorXd r = groups[1] * truth + noise;
  const double lambda = cross_validated_penalty(r, groups);
  const std::vector<Eigen::VectorXd> b = penalised_coefficients(r, groups, lambda);
  REQUIRE((b.size() == 4 && b[3].size() == 0));
  CHECK(b[1].isApprox(truth, 0.1));
  CHECK((b[0].norm() < 0.1 && b[2].norm() < 0.1));
  CHECK(penalised_coefficients(r, groups, 0.0)[1].isApprox(b[1], 0.1));

  const double of_noise = cross_validated_penalty(noise, groups);
  const std::vector<Eigen::VectorXd> nothing = penalised_coefficients(noise, groups, of_noise);
  for (std::size_t j = 0; j < 3; ++j)
    CHECK((groups[j] * nothing[j]).squaredNorm() < 0.02 * noise.squaredNorm());
  CHECK(cross_validated_penalty(noise, {Eigen::MatrixXd(rows, 0)}) == 0.0);
  CHECK_THROWS_AS(cross_validated_penalty(noise, {Eigen::MatrixXd::Ones(rows - 1, 1)}), InputError);
}

TEST_CASE("lasso penalty: columns that depend on each other share their part, with the least norm") {
  const Eigen::Index rows = 200;
  Eigen::MatrixXd twice(rows, 2);
  twice.col(0) = twice.col(1) = testing::settled_autoregression(rows, 0.8, 11);
  const std::vector<Eigen::VectorXd> b = penalised_coefficients(3.0 * twice.col(0), {twice}, 0.0);
  CHECK(b[0].isApprox(Eigen::Vector2d(1.5, 1.5), 1e-9));
}

}  // namespace mpm
