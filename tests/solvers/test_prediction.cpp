#include <algorithm>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "plants/models/catalogue.hpp"
#include "solvers/prediction.hpp"
#include "tests/plants/plant_samples.hpp"

// Prediction matrices against a simulation of the plant with the planned moves.

namespace mpm {
namespace {

// Sums of some hundred products of order ten, with roundings of 1e-15 each.
constexpr double kPredictionRounding = 1e-11;

/// A plant somewhere on its way: 40 samples of a rough input.
LinearPlant plant_in_motion(const TransferMatrix& model, double sample_time) {
  LinearPlant plant(model, sample_time);
  const Eigen::MatrixXd inputs = samples::rough_input(model.cols(), 40);
  for (Eigen::Index k = 0; k < inputs.cols(); ++k)
    plant.advance(inputs.col(k));
  return plant;
}

Eigen::MatrixXd free_of(const LinearPlant& plant, const Eigen::VectorXd& held, Eigen::Index horizon) {
  LinearPlant scratch = plant;
  Eigen::MatrixXd response(plant.output_count(), horizon);
  free_response(plant, held, scratch, response);
  return response;
}

/// y(k+1 ... k+Hp) with the MVs at held + v(i), v(i) = column i of `plan`, the last one held, and the MDs
/// held.
Eigen::MatrixXd simulated(LinearPlant plant, const Eigen::VectorXd& held, const Eigen::MatrixXd& plan,
                          Eigen::Index horizon) {
  Eigen::MatrixXd response(plant.output_count(), horizon);
  for (Eigen::Index l = 0; l < horizon; ++l) {
    Eigen::VectorXd input = held;
    input.head(plan.rows()) += plan.col(std::min(l, plan.cols() - 1));
    plant.advance(input);
    response.col(l) = plant.output();
  }
  return response;
}

void check_prediction(const TransferMatrix& model, Eigen::Index mv_count, double sample_time, int hp,
                      int hc) {
  INFO("Hp " << hp << ", Hc " << hc);
  const LinearPlant plant = plant_in_motion(model, sample_time);
  const Eigen::VectorXd held = samples::rough_input(model.cols(), 7).col(6);
  const Eigen::MatrixXd plan = samples::rough_input(mv_count, hc);

  std::vector<int> starts(static_cast<std::size_t>(hc));
  std::iota(starts.begin(), starts.end(), 0);
  const RowMajorMatrix forced = forced_response(model, mv_count, sample_time, hp, starts);
  REQUIRE(forced.rows() == model.rows() * hp);
  REQUIRE(forced.cols() == mv_count * hc);
  const Eigen::VectorXd moved = forced * plan.reshaped();  // column i * nu + j is MV j at position i
  const Eigen::MatrixXd free = free_of(plant, held, hp);
  const Eigen::MatrixXd expected = simulated(plant, held, plan, hp);
  for (Eigen::Index cv = 0; cv < model.rows(); ++cv)
    CHECK((free.row(cv).transpose() + moved.segment(cv * hp, hp) - expected.row(cv).transpose())
              .lpNorm<Eigen::Infinity>() < kPredictionRounding);
}

/// The second row by 30 coefficients each that are no transfer function's.
TransferMatrix with_coefficients(TransferMatrix model) {
  const Eigen::MatrixXd rough = samples::rough_input(model.cols(), 30);
  for (Eigen::Index input = 0; input < model.cols(); ++input)
    model(1, input) = model(1, input).with_step_coefficients(rough.row(input).transpose(), 2);
  return model;
}

}  // namespace

TEST_CASE("with coefficients the prediction is that of dynamic matrix control", "[prediction]") {
  const TransferMatrix model{{TransferFunction::first_order(1, 5).with_step_coefficients(
                                  samples::rough_input(1, 30).row(0).transpose(), 2),
                              TransferFunction::first_order(1, 5).with_step_coefficients(
                                  samples::rough_input(2, 12).row(1).transpose(), 2)}};
  const Eigen::VectorXd a = samples::rough_input(1, 30).row(0), b = samples::rough_input(2, 12).row(1);
  LinearPlant plant(model, 2);
  const Eigen::MatrixXd u = samples::rough_input(2, 70);
  const auto move = [&](Eigen::Index j, Eigen::Index k) {
    return k < 0 ? 0.0 : u(j, k) - (k > 0 ? u(j, k - 1) : 0.0);
  };
  const auto coefficient = [](const Eigen::VectorXd& all, Eigen::Index i) {
    return all(std::min(i, all.size()) - 1);
  };
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    const Eigen::MatrixXd free = free_of(plant, u.col(k), 40);  // y(k+1), ... with u(k) held
    for (Eigen::Index l = 1; l <= 40; ++l) {
      double expected = 0;
      for (Eigen::Index past = 0; past <= k; ++past)
        expected +=
            coefficient(a, k + l - past) * move(0, past) + coefficient(b, k + l - past) * move(1, past);
      REQUIRE(free(0, l - 1) == Approx(expected).margin(kPredictionRounding));
    }
    plant.advance(u.col(k));
  }
  const RowMajorMatrix dynamic_matrix = forced_response(model, 1, 2, 40, {0, 1, 2, 3});
  for (Eigen::Index l = 1; l <= 40; ++l)  // the last position is held: a step of it
    CHECK(dynamic_matrix(l - 1, 3) == (l > 3 ? coefficient(a, l - 3) : 0.0));
}

TEST_CASE("free and forced response together are the simulated one", "[prediction]") {
  const TransferMatrix p1 = benchmark_plant("shell-7x3").G;
  check_prediction(p1, 3, 4, 75, 15);
  check_prediction(p1, 3, 4, 5, 5);  // a horizon below some dead times
  const TransferMatrix mixed = samples::mixed_matrix();
  for (const int hc : {1, 2, 9, 20})
    check_prediction(mixed, 3, 2, 20, hc);
  const TransferMatrix coefficients = with_coefficients(mixed);
  for (const int hc : {1, 9, 20})
    check_prediction(coefficients, 3, 2, 60, hc);
  check_prediction(mixed, 4, 2, 1, 1);  // all inputs are MVs
}

TEST_CASE("the free response does not touch the plant", "[prediction]") {
  const LinearPlant plant = plant_in_motion(samples::mixed_matrix(), 2);
  const Eigen::VectorXd held = samples::rough_input(4, 3).col(2);
  const Eigen::MatrixXd first = free_of(plant, held, 20);
  CHECK(free_of(plant, held, 20) == first);
}

TEST_CASE("without a change of inputs the free response of a plant at rest is its steady state",
          "[prediction]") {
  const TransferMatrix model = benchmark_plant("shell-7x3").G;
  LinearPlant plant(model, 4);
  const Eigen::VectorXd held = samples::rough_input(5, 1);
  plant.reset(held);
  const Eigen::MatrixXd expected = (model.static_gain() * held).replicate(1, 30);
  CHECK((free_of(plant, held, 30) - expected).cwiseAbs().maxCoeff() < kPredictionRounding);
}

TEST_CASE("a move acts from the sample after its own and its dead time on", "[prediction]") {
  // Ts 2, dead time 4: two samples; u(k) of the plan first shows in y(k + 3).
  const TransferMatrix model{{TransferFunction::first_order(2, 10, 4)}};
  const RowMajorMatrix forced = forced_response(model, 1, 2, 6, {0, 1, 2});
  for (Eigen::Index l = 0; l < 6; ++l)
    for (Eigen::Index i = 0; i < 3; ++i)
      CHECK((forced(l, i) != 0) == (l >= i + 2));
}

}  // namespace mpm
