#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "analysis/statistics/one_class_svm.hpp"
#include "base/error.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

/// n points of 3 normal coordinates each.
Eigen::MatrixXd normal_points(Eigen::Index n, std::uint64_t number) {
  return testing::white_noise(3 * n, number).reshaped(3, n);
}

}  // namespace

TEST_CASE("one-class machine: nu is the share of its points that it leaves outside") {
  const Eigen::MatrixXd points = normal_points(400, 3001);
  for (const double nu : {0.05, 0.2}) {
    const OneClassSvm machine(points, nu, 0.2);
    Eigen::Index outside = 0;
    for (Eigen::Index k = 0; k < points.cols(); ++k)
      outside += machine.outsideness(points.col(k)) > 0.0 ? 1 : 0;
    // The share is at most nu and comes near it; those on the boundary are right to the tolerance of libsvm.
    CHECK(static_cast<double>(outside) / 400.0 == Approx(nu).margin(0.015));
  }
}

TEST_CASE("one-class machine: of one point it is the distance, of two the mean of their kernels") {
  const Eigen::Vector2d one(0.5, -1.0), x(2.0, 1.0);
  // alpha = rho = nu.
  CHECK(OneClassSvm(one, 0.5, 0.3).outsideness(x) == Approx(0.3 * (x - one).squaredNorm()).epsilon(1e-12));
  // By symmetry alpha_1 = alpha_2 = nu, and both points are on the boundary, to the tolerance of libsvm.
  Eigen::MatrixXd two(2, 2);
  two << one, -one;
  const double d2 = one.squaredNorm();
  CHECK(OneClassSvm(two, 0.5, 0.3).outsideness(Eigen::Vector2d::Zero()) ==
        Approx(std::log(0.5 * (1.0 + std::exp(-0.3 * 4.0 * d2))) + 0.3 * d2).epsilon(1e-3));
}

TEST_CASE("one-class machine: it goes on growing where the kernels are no longer numbers") {
  const OneClassSvm machine(normal_points(100, 3003), 0.1, 0.5);
  const double far = machine.outsideness(Eigen::Vector3d(1e3, 0.0, 0.0));
  CHECK(machine.outsideness(Eigen::Vector3d(2e3, 0.0, 0.0)) > far);
  CHECK(far == Approx(0.5e6).epsilon(0.01));  // gamma |x|^2 but for the size of the points
}

TEST_CASE("one-class machine: what it cannot learn from is refused") {
  const Eigen::MatrixXd points = normal_points(10, 3004);
  CHECK_THROWS_WITH(OneClassSvm(Eigen::MatrixXd(3, 0), 0.1, 1.0),
                    Catch::Contains("one or more finite points"));
  CHECK_THROWS_WITH(OneClassSvm(points, 1.0, 1.0), Catch::Contains("above 0 and below 1"));
  CHECK_THROWS_WITH(OneClassSvm(points, 0.1, 0.0), Catch::Contains("gamma"));
  CHECK_THROWS_AS(OneClassSvm(points, 0.1, 1.0).outsideness(Eigen::Vector2d(0.0, 0.0)), InputError);
}

}  // namespace mpm
