#include <cstdint>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/methods/ours/coloured_noise.hpp"
#include "analysis/methods/ours/cv_errors.hpp"
#include "tests/analysis/signals.hpp"

// A CV under noise of any shape.

namespace mpm {
namespace {

Columns normal(Eigen::Index rows, Eigen::Index columns, std::uint64_t number) {
  Columns all(rows, columns);
  for (Eigen::Index column = 0; column < columns; ++column)
    all.col(column) = testing::white_noise(rows, 100 * number + static_cast<std::uint64_t>(column));
  return all;
}

/// Near a random walk.
Eigen::VectorXd slow(Eigen::Index samples, std::uint64_t number) {
  return testing::autoregression(samples, 0.97, 100 * number);
}

/// Of a loop of two CVs: one of noise that grows in the middle, and one of white noise.
CvErrors changing_errors(Eigen::Index samples, std::uint64_t number) {
  AssessedLoop loop;
  loop.y = normal(samples, 2, number).transpose();
  loop.y.row(0).tail(samples / 2) += 3.0 * slow(samples / 2, number + 1).transpose();
  loop.y_sim = Eigen::MatrixXd::Zero(2, samples);
  std::vector<Eigen::Index> all(static_cast<std::size_t>(samples));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  CvErrors errors(loop, 0, all, loop.y.row(0).transpose(), normal(samples, 2, number + 2));
  errors.find_change();
  return errors;
}

TEST_CASE("products of late signals are those of the whitened signals, in parts and in their sum",
          "[assessment]") {
  const Columns A = normal(90, 3, 1), B = normal(90, 2, 2);
  const Eigen::VectorXd a = 0.2 * normal(kErrorOrder, 1, 3);
  const auto direct = [&](Eigen::Index first, Eigen::Index count) {
    const Eigen::Index from = first - kErrorOrder;
    return Columns(whitened_by(a, A.middleRows(from, count + kErrorOrder)).transpose() *
                   whitened_by(a, B.middleRows(from, count + kErrorOrder)));
  };
  LaggedProducts products(A, B, {0, 40});
  CHECK(products.whitened_by(a).isApprox(direct(kErrorOrder, 40 - kErrorOrder), 1e-12));
  const LaggedProducts later(A, B, {40, 50});
  CHECK(later.whitened_by(a).isApprox(direct(40, 50), 1e-12));
  products += later;
  CHECK(products.whitened_by(a).isApprox(direct(kErrorOrder, 90 - kErrorOrder), 1e-12));
}

TEST_CASE("the sample from which on the noise of a CV is another one is found", "[assessment]") {
  CHECK(changing_errors(480, 20).change() == 240);
}

TEST_CASE("a signal that has nothing to do with the errors of a CV explains no more than chance",
          "[assessment]") {
  for (std::uint64_t number = 100; number < 108; ++number) {
    const CvErrors errors = changing_errors(480, number);
    const double gain = errors.with(slow(480, number + 50)) - errors.none();
    CHECK(gain > -0.1);  // one more signal never explains less
    CHECK(gain < 6.0);
  }
}

}  // namespace
}  // namespace mpm
