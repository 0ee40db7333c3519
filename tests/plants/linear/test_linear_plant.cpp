
#include <cmath>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "tests/plants/plant_samples.hpp"

// Properties of LinearPlant as a whole: superposition, steady states, copies, refused input.

namespace mpm {
namespace {

using samples::mixed_matrix;
using samples::polynomial;
using samples::rough_input;

// Outputs of order ten after some hundred stable steps with roundings of 1e-15.
constexpr double kRounding = 1e-11;

TransferMatrix integrating_matrix() {
  TransferMatrix G(2, 3);
  G(0, 0) = TransferFunction::first_order(2, 5, 1);
  G(1, 1) = TransferFunction(polynomial({1}), polynomial({4, 1, 0}), 3);
  G(1, 2) = TransferFunction(polynomial({-1}), polynomial({3, 1}));
  return G;
}

}  // namespace

TEST_CASE("a plant has the size and sample time of its making", "[linear_plant]") {
  const LinearPlant plant(TransferMatrix(3, 2), 0.5);
  CHECK(plant.output_count() == 3);
  CHECK(plant.input_count() == 2);
  CHECK(plant.sample_time() == 0.5);
  CHECK(plant.output() == Eigen::VectorXd::Zero(3));
}

TEST_CASE("channels without effect have none", "[linear_plant]") {
  CHECK(simulate(TransferMatrix(3, 2), 1, rough_input(2, 20)) == Eigen::MatrixXd::Zero(3, 20));
  LinearPlant without_inputs(TransferMatrix(2, 0), 1);
  without_inputs.reset(Eigen::VectorXd(0));
  without_inputs.advance(Eigen::VectorXd(0));
  CHECK(without_inputs.output() == Eigen::VectorXd::Zero(2));
}

TEST_CASE("the output of a matrix is the sum of its channels", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::MatrixXd inputs = rough_input(4, 100);
  const Eigen::MatrixXd together = simulate(G, 2, inputs);
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(100);
    for (Eigen::Index j = 0; j < 4; ++j) {
      sum += simulate(TransferMatrix{{G(i, j)}}, 2, inputs.row(j)).row(0);
    }
    CHECK((together.row(i) - sum).norm() < kRounding);
  }
}

TEST_CASE("superposition holds", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::MatrixXd all = rough_input(8, 100);
  const Eigen::MatrixXd a = all.topRows(4);
  const Eigen::MatrixXd b = all.bottomRows(4);
  const Eigen::MatrixXd expected = 2 * simulate(G, 2, a) - 3 * simulate(G, 2, b);
  CHECK((simulate(G, 2, 2 * a - 3 * b) - expected).norm() < 10 * kRounding);
}

TEST_CASE("an output depends on earlier inputs only", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::MatrixXd inputs = rough_input(4, 30);
  Eigen::MatrixXd changed = inputs;
  changed.col(20).setConstant(50);
  const Eigen::MatrixXd before = simulate(G, 2, inputs);
  const Eigen::MatrixXd after = simulate(G, 2, changed);
  CHECK(before.leftCols(21) == after.leftCols(21));
  CHECK(before.col(21) != after.col(21));
}

TEST_CASE("step responses belong to the right input and sample", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const std::vector<Eigen::MatrixXd> steps = step_response(G, 2, 25);
  REQUIRE(steps.size() == 4);
  for (Eigen::Index j = 0; j < 4; ++j) {
    Eigen::MatrixXd input = Eigen::MatrixXd::Zero(4, 26);
    input.row(j).setOnes();
    CHECK(steps[static_cast<std::size_t>(j)] == simulate(G, 2, input).rightCols(25));
  }
  CHECK(step_response(G, 2, 0)[3].cols() == 0);
}

TEST_CASE("a long constant input leads to the static gain", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::Vector4d input(1, -2, 0.5, 3);
  LinearPlant plant(G, 2);
  for (int k = 0; k < 400; ++k) {
    plant.advance(input);
  }
  // 800 time units: the slowest mode, exp(-t / 25) of the complex pair, is down to 1e-14.
  CHECK((plant.output() - G.static_gain() * input).norm() < kRounding);
}

TEST_CASE("a reset plant is at steady state and stays there", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::Vector4d input(1, -2, 0.5, 3);
  LinearPlant plant(G, 2);
  for (Eigen::Index k = 0; k < 17; ++k) {  // whatever was before must not matter
    plant.advance(rough_input(4, 17).col(k));
  }
  plant.reset(input);
  const Eigen::VectorXd expected = G.static_gain() * input;
  CHECK((plant.output() - expected).norm() < kRounding);
  for (int k = 0; k < 50; ++k) {
    plant.advance(input);
    CHECK((plant.output() - expected).norm() < kRounding);
  }
}

TEST_CASE("from a steady state the plant moves by its response from rest", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  const Eigen::Vector4d steady(1, -2, 0.5, 3);
  const Eigen::MatrixXd moves = rough_input(4, 40);
  const Eigen::MatrixXd from_rest = simulate(G, 2, moves);
  LinearPlant plant(G, 2);
  plant.reset(steady);
  for (Eigen::Index k = 0; k < 40; ++k) {
    CHECK((plant.output() - G.static_gain() * steady - from_rest.col(k)).norm() < kRounding);
    plant.advance(steady + moves.col(k));
  }
}

TEST_CASE("an integrating output begins at its steady rate, and rests where the rates cancel out",
          "[linear_plant]") {
  LinearPlant plant(integrating_matrix(), 2);
  for (int k = 0; k < 10; ++k) {
    plant.advance(Eigen::Vector3d(1, 1, 1));
  }
  const Eigen::Vector3d u(3, 0.1, 5);
  plant.reset(u);
  for (int k = 0; k < 10; ++k) {  // 0.1/s: 0.1 a time unit, 0.2 a sample
    CHECK((plant.output() - Eigen::Vector2d(6, -5 + 0.2 * k)).norm() < kRounding);
    plant.advance(u);
  }
  // Through a fractional dead time, a zero and a direct effect.
  TransferMatrix G(1, 2);
  G(0, 0) = TransferFunction(polynomial({-2, 1, 0.3}), polynomial({4, 1, 0}), 3.7);
  G(0, 1) = TransferFunction(polynomial({-0.6}), polynomial({7, 8, 1, 0}), 0.4);
  LinearPlant balanced(G, 2);
  balanced.reset(Eigen::Vector2d(4, 2));  // rates 0.3 * 4 and -0.6 * 2
  for (int k = 0; k < 50; ++k) {
    CHECK(std::abs(balanced.output()(0)) < kRounding);
    balanced.advance(Eigen::Vector2d(4, 2));
  }
}

TEST_CASE("behind a washout an output is the filter of its samples, whatever its channels",
          "[linear_plant]") {
  TransferMatrix G(1, 4);
  G(0, 0) = TransferFunction(polynomial({0.5}), polynomial({1, 0}), 3.7);          // a flow, late
  G(0, 1) = TransferFunction(polynomial({-2, 1, 0.3}), polynomial({4, 1, 0}), 2);  // with a direct effect
  G(0, 2) = TransferFunction::first_order(2, 5, 1.3);                              // no integrator
  G(0, 3) = TransferFunction(polynomial({1}), polynomial({6, 5, 1, 0}));
  constexpr double kWashout = 30, kSample = 2;
  TransferMatrix washed(1, 4);
  for (Eigen::Index input = 0; input < 4; ++input) {
    washed(0, input) = G(0, input).behind_washout(kWashout);
    CHECK_FALSE(washed(0, input).is_integrating());
    CHECK(washed(0, input).without_washout() == G(0, input));
  }
  const Eigen::MatrixXd inputs = rough_input(4, 300);
  const Eigen::RowVectorXd y = simulate(G, kSample, inputs);
  const Eigen::RowVectorXd seen = simulate(washed, kSample, inputs);
  const double a = std::exp(-kSample / kWashout);
  double low_pass = 0;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    CHECK(std::abs(seen(k) - (y(k) - low_pass)) < 1e-10);
    low_pass = a * low_pass + (1 - a) * y(k);
  }
}

TEST_CASE("a copy goes on as the original would and leaves it alone", "[linear_plant]") {
  const Eigen::MatrixXd inputs = rough_input(4, 60);
  const Eigen::MatrixXd expected = simulate(mixed_matrix(), 2, inputs);
  LinearPlant plant(mixed_matrix(), 2);
  LinearPlant prediction = plant;
  for (Eigen::Index k = 0; k < 40; ++k) {
    prediction = plant;
    for (Eigen::Index i = k; i < k + 20; ++i) {
      CHECK(prediction.output() == expected.col(i));
      prediction.advance(inputs.col(i));
    }
    CHECK(plant.output() == expected.col(k));
    plant.advance(inputs.col(k));
  }
}

TEST_CASE("a plant can take the place of a different one", "[linear_plant]") {
  LinearPlant plant(TransferMatrix(1, 1), 1);
  plant = LinearPlant(mixed_matrix(), 2);
  CHECK(plant.output_count() == 4);
  CHECK(plant.input_count() == 4);
  CHECK(plant.sample_time() == 2);
  plant.reset(Eigen::Vector4d(1, 0, 0, 0));
  CHECK((plant.output() - mixed_matrix().static_gain().col(0)).norm() < kRounding);
}

TEST_CASE("bad input of a linear plant is refused", "[linear_plant]") {
  const TransferMatrix G = mixed_matrix();
  CHECK_THROWS_AS(LinearPlant(G, 0), InputError);
  CHECK_THROWS_AS(LinearPlant(TransferMatrix(1, 1), -1), InputError);

  LinearPlant plant(G, 2);
  CHECK_THROWS_AS(plant.advance(Eigen::VectorXd::Zero(3)), InputError);
  CHECK_THROWS_AS(plant.advance(Eigen::VectorXd::Zero(5)), InputError);
  CHECK_THROWS_AS(plant.reset(Eigen::VectorXd::Zero(3)), InputError);
  CHECK_THROWS_AS(plant.reset(Eigen::Vector4d(0, kNaN, 0, 0)), InputError);
  CHECK_THROWS_AS(simulate(G, 2, Eigen::MatrixXd::Zero(5, 10)), InputError);
  CHECK_THROWS_AS(step_response(G, 2, -1), InputError);
}

}  // namespace mpm
