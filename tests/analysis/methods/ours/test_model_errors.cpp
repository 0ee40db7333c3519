#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

constexpr double kNoise = 0.02, kShare = 0.05;

/// Moves of every input, each 15 samples.
Eigen::MatrixXd input_moves(Eigen::Index inputs, Eigen::Index samples, std::uint64_t number) {
  RandomStream stream(11, number, StreamId::excitation);
  Eigen::MatrixXd u(inputs, samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    for (Eigen::Index i = 0; i < inputs; ++i)
      u(i, k) = k % 15 == 0 ? 0.3 * stream.normal() : u(i, k - 1);
  return u;
}

/// A plant of which every channel of the first CV is off by what a standard deviation of its errors is.
TransferMatrix imperfect_plant(const Study& study, std::uint64_t number) {
  RandomStream stream(12, number, StreamId::world);
  TransferMatrix plant = study.plant.G;
  for (const ChannelError& error : relative_errors(study, 0, kShare, 0.0).channels) {
    const double off = error.deviation * stream.normal();
    const bool shifts = error.parameter == MismatchParameter::dead_time;
    plant =
        with_mismatches(plant, {{0, error.input, error.parameter,
                                 shifts ? std::max(off, -plant(0, error.input).dead_time()) : 1.0 + off}});
  }
  return plant;
}

/// e of the first CV of a plant in place of the model.
Eigen::RowVectorXd error_of(const Study& study, const TransferMatrix& plant, const Eigen::MatrixXd& u) {
  const double Ts = study.controller.sample_time;
  return (simulate(plant, Ts, u) - simulate(study.plant.G, Ts, u)).row(0);
}

Eigen::RowVectorXd white(Eigen::Index samples, std::uint64_t number) {
  return kNoise * testing::white_noise(samples, number).transpose();
}

ModelErrors learnt(const Study& study, const TransferMatrix& plant, std::uint64_t number) {
  const Eigen::MatrixXd u = input_moves(study.plant.G.cols(), 400, number);
  return {study,
          0,
          relative_errors(study, 0, kShare, 0.5),
          error_of(study, plant, u) + white(400, number),
          u,
          Eigen::VectorXd::Zero(u.rows()),
          1e-6};
}

}  // namespace

TEST_CASE("marginalised products are those of the dense covariance L L' + Z' Z") {
  constexpr Eigen::Index N = 50, q = 3;
  Eigen::MatrixXd series(2 + q, N);
  for (Eigen::Index i = 0; i < series.rows(); ++i)
    series.row(i) = testing::white_noise(N, static_cast<std::uint64_t>(i)).transpose();
  const NoiseModels models{Eigen::Array2d(0.9, 0.0), Eigen::Array2d(0.5, 0.0)};
  const WhitenedProducts sums = marginalised(whitened_products(models, series), 2, q);
  CHECK(sums.products.size() == 3);
  for (Eigen::Index model = 0; model < 2; ++model) {
    Eigen::MatrixXd C = Eigen::MatrixXd::Identity(N, N);
    for (Eigen::Index i = 0; i < N; ++i)
      for (Eigen::Index j = 0; j < N; ++j)
        if (const double a = models.a(model), b = models.b(model); b > 0.0)
          C(i, j) += b * b * std::pow(a, std::abs(i - j)) *
                     (1.0 - std::pow(a, 2.0 * static_cast<double>(std::min(i, j)))) / (1.0 - a * a);
    C += series.bottomRows(q).transpose() * series.bottomRows(q);
    const Eigen::LLT<Eigen::MatrixXd> factor(C);
    const Eigen::MatrixXd products = series.topRows(2) * factor.solve(series.topRows(2).transpose());
    CHECK(sums.log_determinant(model) ==
          Approx(2.0 * factor.matrixLLT().diagonal().array().log().sum()).margin(1e-9));
    CHECK(sums.of(0, 0)(model) == Approx(products(0, 0)).epsilon(1e-9));
    CHECK(sums.of(1, 0)(model) == Approx(products(1, 0)).epsilon(1e-9));
    CHECK(sums.of(1, 1)(model) == Approx(products(1, 1)).epsilon(1e-9));
  }
}

TEST_CASE("errors of a model learnt from one record explain those of another, as far as they say") {
  const Study study = find_study("setpoint-methods");
  double squares = 0.0, without = 0.0, before = 0.0;
  constexpr int kPlants = 40;
  constexpr Eigen::Index N = 300;
  for (std::uint64_t number = 0; number < kPlants; ++number) {
    const TransferMatrix plant = imperfect_plant(study, number);
    const ModelErrors errors = learnt(study, plant, number);
    // Of 400 samples it is known within 3.5 %: four times that.
    CHECK(errors.noise().deviation == Approx(kNoise).epsilon(0.15));

    const Eigen::MatrixXd u = 4.0 * input_moves(study.plant.G.cols(), N, 1000 + number);
    const Eigen::VectorXd initial = Eigen::VectorXd::Zero(u.rows());
    const Eigen::RowVectorXd e = error_of(study, plant, u) + white(N, 2000 + number);
    const Eigen::RowVectorXd left = (e - errors.correction(u, initial)) / kNoise;
    const Eigen::MatrixXd Z = errors.directions(errors.slopes(u, initial));
    const Eigen::MatrixXd C = Z.transpose() * Z + Eigen::MatrixXd::Identity(N, N);
    squares += left * C.llt().solve(left.transpose());
    without += left.squaredNorm();
    before += (e / kNoise).squaredNorm();
  }
  CHECK(before / kPlants > 5.0 * N);
  // Chi-square variables of N degrees of freedom: four standard deviations of the mean of 40 of them. Without
  // the directions it is too large.
  const double deviation = std::sqrt(2.0 * N / kPlants);
  CHECK(squares / kPlants == Approx(N).margin(4.0 * deviation));
  CHECK(without / kPlants > N + 4.0 * deviation);
}

TEST_CASE(
    "the background of a record is learnt beside the errors of the model, and its sizes are left open") {
  const Study study = find_study("setpoint-methods");
  const TransferMatrix plant = imperfect_plant(study, 3);
  const Eigen::MatrixXd u = input_moves(study.plant.G.cols(), 800, 3);
  const Eigen::RowVectorXd e = error_of(study, plant, u) + white(800, 4) +
                               kNoise * testing::settled_autoregression(800, 0.95, 5).transpose();
  const ModelErrors errors(study, 0, relative_errors(study, 0, kShare, 0.5), e, u,
                           Eigen::VectorXd::Zero(u.rows()), 1e-6);
  const BaseNoise& noise = errors.noise();
  INFO(noise.deviation << " " << noise.a << " " << noise.b);
  CHECK(noise.a == Approx(0.95).margin(0.1));
  const double state = noise.b * noise.b / (1.0 - noise.a * noise.a);
  CHECK(std::pow(noise.deviation, 2.0) * (1.0 + state) ==
        Approx(kNoise * kNoise * (1.0 + 1.0 / (1.0 - 0.95 * 0.95))).epsilon(0.4));
  double total = 0.0;
  Eigen::Index count = 0;
  for (const PossibleNoises& each : errors.noises().possible) {
    total += each.log_weight.exp().sum();
    count += each.a.size();
  }
  CHECK(count > 3);
  CHECK(total == Approx(1.0).margin(0.2));  // without those that hardly have a share
}

TEST_CASE("a plant that answers sooner than a model without dead time is explained as well as that can") {
  constexpr double kGain = 2.0, kSamplesOfLag = 30.0, kLittleNoise = 0.005;
  constexpr Eigen::Index kSamples = 400;
  Study study = find_study("setpoint-methods");
  const double Ts = study.controller.sample_time;
  study.plant.G(0, 0) = TransferFunction::first_order(kGain, kSamplesOfLag * Ts);
  for (Eigen::Index input = 1; input < study.plant.G.cols(); ++input)
    study.plant.G(0, input) = TransferFunction::zero();
  const Eigen::MatrixXd sooner = input_moves(study.plant.G.cols(), kSamples + 1, 5);
  const Eigen::MatrixXd u = sooner.leftCols(kSamples);
  const Eigen::RowVectorXd e =
      (simulate(study.plant.G, Ts, sooner).rightCols(kSamples) - simulate(study.plant.G, Ts, u)).row(0) +
      kLittleNoise * testing::white_noise(kSamples, 5).transpose();
  const ModelErrors model(study, 0, relative_errors(study, 0, kShare, 0.0), e, u,
                          Eigen::VectorXd::Zero(u.rows()), 1e-6, BaseNoise{kLittleNoise});
  // -2 log of the probability of e and of these errors.
  const auto distance = [&](double gain, double time_constant) {
    const TransferMatrix plant = with_mismatches(
        study.plant.G,
        {{0, 0, MismatchParameter::gain, gain}, {0, 0, MismatchParameter::time_constant, time_constant}});
    return (e - error_of(study, plant, u)).squaredNorm() / (kLittleNoise * kLittleNoise) +
           (Eigen::Array2d(gain, time_constant) - 1.0).square().sum() / (kShare * kShare);
  };
  double least = kInfinity;
  for (double gain = 0.7; gain < 1.3; gain += 0.01)
    for (double time_constant = 0.7; time_constant < 1.3; time_constant += 0.01)
      least = std::min(least, distance(gain, time_constant));
  const TransferFunction& found = model.model()(0, 0);
  CHECK(found.dead_time() < 1e-6 * Ts);
  CHECK(distance(found.static_gain() / kGain, found.residence_time() / (kSamplesOfLag * Ts)) < least + 2.0);
}

TEST_CASE("gains that change along a record are learnt as errors that wander, constant ones are not") {
  const Study study = find_study("setpoint-methods");
  const TransferMatrix plant = imperfect_plant(study, 3);
  CHECK_FALSE(learnt(study, plant, 3).wanders());

  const Eigen::MatrixXd u = input_moves(study.plant.G.cols(), 400, 3);
  const Eigen::RowVectorXd y = simulate(study.plant.G, study.controller.sample_time, u).row(0);
  const Eigen::VectorXd initial = Eigen::VectorXd::Zero(u.rows());
  // 15 % more and less gain, slowly.
  Eigen::RowVectorXd e = error_of(study, plant, u) + white(400, 3);
  for (Eigen::Index k = 0; k < e.size(); ++k)
    e(k) += 0.15 * std::sin(0.03 * static_cast<double>(k)) * y(k);
  const ModelErrors errors(study, 0, relative_errors(study, 0, kShare, 0.5), e, u, initial, 1e-6);
  CHECK(errors.wanders());
  // A row of each channel and corner below those of the errors, for a record of any length.
  CHECK(errors.slopes(u, initial).rows() > errors.count());
  CHECK(errors.slopes(u.leftCols(100), initial).rows() < errors.slopes(u, initial).rows());
}

TEST_CASE("plants drawn from what a record shows of the errors lie about their mean") {
  const Study study = find_study("setpoint-methods");
  const ModelErrors errors = learnt(study, imperfect_plant(study, 3), 3);
  CHECK(errors.drawn(Eigen::VectorXd::Zero(errors.count()))(0, 0) == errors.model()(0, 0));
  const TransferMatrix drawn = errors.drawn(Eigen::VectorXd::Ones(errors.count()));
  CHECK_FALSE(drawn(0, 0) == errors.model()(0, 0));
  CHECK(drawn(0, 0).static_gain() ==
        Approx(errors.model()(0, 0).static_gain()).epsilon(0.2));  // prior of 5 %
}

TEST_CASE("a loop is corrected by what its benchmark shows, a fault is not") {
  const Study study = find_study("setpoint-methods");
  TransferMatrix plant = imperfect_plant(study, 7);
  const Eigen::VectorXd initial_u = Eigen::VectorXd::Zero(study.mv_count());
  const auto loop = [&](const TransferMatrix& truth, std::uint64_t number) {
    const Eigen::MatrixXd u = input_moves(study.plant.G.cols(), 400, number);
    const double Ts = study.controller.sample_time;
    AssessedLoop made{.y = simulate(truth, Ts, u),
                      .u = u.topRows(study.mv_count()),
                      .u_target = u.topRows(study.mv_count()),
                      .d = u.bottomRows(study.md_count()),
                      .y_sim = simulate(study.plant.G, Ts, u),
                      .y_set = {}};
    for (Eigen::Index cv = 0; cv < made.y.rows(); ++cv)
      made.y.row(cv) += white(400, 50 * number + static_cast<std::uint64_t>(cv));
    return made;
  };
  const auto deviation = [](const AssessedLoop& of) {
    return std::sqrt((of.y - of.y_sim).row(0).squaredNorm() / static_cast<double>(of.samples()));
  };
  const LearntModel model(study, initial_u, loop(plant, 1), kShare, 0.5);
  const AssessedLoop healthy = loop(plant, 2);
  CHECK(deviation(healthy) > 2.0 * kNoise);
  CHECK(deviation(*model.corrected(healthy)) == Approx(kNoise).epsilon(0.1));
  // A window of it, which refers to the corrected record.
  const std::shared_ptr<const AssessedLoop> window = model.corrected(window_of(healthy, 100, 200));
  CHECK(deviation(*window) == Approx(kNoise).epsilon(0.15));
  REQUIRE(window->whole != nullptr);
  CHECK(window->in_window(window->whole->y_sim) == window->y_sim);

  // Learnt from a period of a record, before which the inputs moved as well.
  const AssessedLoop record = loop(plant, 4);
  const LearntModel of_period(study, initial_u, window_of(record, 100, 300), kShare, 0.5);
  CHECK(deviation(*of_period.corrected(healthy)) == Approx(kNoise).epsilon(0.15));

  plant = with_mismatches(plant, {{0, 0, MismatchParameter::gain, 0.6}});
  const AssessedLoop faulty = loop(plant, 3);
  CHECK(deviation(*model.corrected(faulty)) > 0.8 * deviation(faulty));
}

TEST_CASE("the benchmark of an exact model seldom rejects it, that of an imperfect one does") {
  const Study study = find_study("wood-berry");
  constexpr int kRecords = 60;
  int exact = 0, imperfect = 0;
  for (int number = 0; number < kRecords; ++number) {
    const auto stream = static_cast<std::uint64_t>(number);
    exact += learnt(study, study.plant.G, stream).rejects_exact_model() ? 1 : 0;
    imperfect += learnt(study, imperfect_plant(study, stream), stream).rejects_exact_model() ? 1 : 0;
  }
  CHECK(exact == 0);  // one in 10,000 is expected
  CHECK(imperfect > kRecords / 2);
}

TEST_CASE("the plant has the dead times of the model before it was made late") {
  const Study study = find_study("setpoint-methods");
  const double Ts = study.controller.sample_time;
  const Eigen::MatrixXd u = input_moves(study.plant.G.cols(), 400, 8);
  for (const double late : {0.5 * Ts, Ts}) {
    INFO("late by " << late);
    const ModelErrors errors(study, 0, relative_errors(study, 0, 1e-6, 0.0), white(400, 9), u,
                             Eigen::VectorXd::Zero(u.rows()), 1e-6, {}, late);
    for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input) {
      const double dead_time = study.plant.G(0, input).dead_time();
      CHECK(errors.model()(0, input).dead_time() == Approx(dead_time + late).margin(1e-3 * Ts));
      CHECK(errors.plant()(0, input).dead_time() == Approx(dead_time).margin(1e-3 * Ts));
    }
  }
}

}  // namespace mpm
