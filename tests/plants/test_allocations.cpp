#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"
#include "tests/plants/allocation_counter.hpp"
#include "tests/plants/plant_samples.hpp"

namespace mpm {
namespace {

/// Allocations of what a controller does each step: copy the plant over another one and run it ahead.
std::size_t allocations_of_prediction(const TransferMatrix& G) {
  LinearPlant plant(G, 2);
  LinearPlant prediction = plant;
  const Eigen::VectorXd input = Eigen::VectorXd::LinSpaced(G.cols(), -1, 1);
  const Eigen::MatrixXd inputs = samples::rough_input(G.cols(), 30);
  double sum = 0;

  const std::size_t before = allocation_count();
  plant.reset(input);
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    plant.advance(inputs.col(k));
    prediction = plant;
    for (int i = 0; i < 10; ++i) {
      prediction.advance(input);
      sum += prediction.output()(0);
    }
  }
  const std::size_t after = allocation_count();
  CHECK(sum != 0);
  return after - before;
}

}  // namespace

TEST_CASE("the allocation counter sees Eigen and the standard library", "[allocation]") {
  const std::size_t start = allocation_count();
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(100);
  const std::size_t after_eigen = allocation_count();
  const std::vector<double> values(100, vector.sum());
  const std::size_t after_vector = allocation_count();
  const auto object = std::make_unique<double>(values[0]);
  const auto array = std::make_unique<double[]>(values.size());
  const std::size_t after_new = allocation_count();
  CHECK(*object + array[0] == 100);
  CHECK(after_eigen > start);
  CHECK(after_vector > after_eigen);
  CHECK(after_new >= after_vector + 2);
}

TEST_CASE("assignment, reset and advance of a plant allocate nothing", "[allocation]") {
  CHECK(allocations_of_prediction(samples::mixed_matrix()) == 0);
  CHECK(allocations_of_prediction(benchmark_plant("shell-7x3").G) == 0);
  TransferMatrix coefficients = samples::mixed_matrix();
  coefficients(0, 0) = coefficients(0, 0).with_step_coefficients(samples::rough_input(1, 25).transpose(), 2);
  CHECK(allocations_of_prediction(coefficients) == 0);
}

}  // namespace mpm
