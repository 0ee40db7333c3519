#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/methods/ours/input_disturbance.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/linear_plant.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kRecord = 300;
constexpr double kDeviation = 0.05;

std::vector<ModelErrors> exact_models(const Study& study, const BaseNoise& noise) {
  std::vector<ModelErrors> models;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    models.emplace_back(study, cv, noise);
  return models;
}

/// Of each CV in standard deviations of its noise: noise, the response of all to a disturbance on an MV, and
/// one direction of the model.
std::vector<Eigen::MatrixXd> disturbed(const Study& study, Eigen::Index mv, double size) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(study.plant.G.cols(), kRecord);
  x.row(mv) = size * testing::autoregression(kRecord, 0.95, 31).transpose();
  const Eigen::MatrixXd response = simulate(study.plant.G, study.controller.sample_time, x);
  std::vector<Eigen::MatrixXd> series;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    series.emplace_back(2, kRecord);
    series.back().row(0) = response.row(cv) / kDeviation +
                           testing::white_noise(kRecord, 40 + static_cast<std::uint64_t>(cv)).transpose();
    series.back().row(1).setConstant(0.5);
  }
  return series;
}

}  // namespace

TEST_CASE("a disturbance on an MV: its MV is named, with the innovations that it has") {
  const Study study = find_study("setpoint-methods");
  const std::vector<ModelErrors> models = exact_models(study, {kDeviation});
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
    const std::vector<Eigen::MatrixXd> series = disturbed(study, mv, 0.05);
    const std::vector<InputEvidence> found =
        InputLikelihood(models, series, study.controller.sample_time, 4.0).of_mvs(study.mv_count());
    const InputEvidence& truth = found[static_cast<std::size_t>(mv)];
    for (Eigen::Index other = 0; other < study.mv_count(); ++other)
      if (other != mv)
        CHECK(truth.log_evidence > found[static_cast<std::size_t>(other)].log_evidence + 10.0);
    // Where channels lag behind a fast disturbance it is known within a factor of about 1.5.
    CHECK(truth.b == Approx(0.05).epsilon(0.5));
  }
}

TEST_CASE("a disturbance on an MV: without one its evidence is that of nothing less the width of its prior") {
  const Study study = find_study("setpoint-methods");
  const std::vector<ModelErrors> models = exact_models(study, {kDeviation});
  const std::vector<Eigen::MatrixXd> series = disturbed(study, 0, 0.0);
  double healthy = 0.0;
  for (const Eigen::MatrixXd& of_cv : series) {
    const WhitenedProducts sums = marginalised(whitened_products(base_models({}, false).models, of_cv), 1, 1);
    healthy += ScaleLikelihood{4.0, kRecord}(sums.log_determinant(0), sums.of(0, 0)(0));
  }
  for (const InputEvidence& found :
       InputLikelihood(models, series, study.controller.sample_time, 4.0).of_mvs(study.mv_count())) {
    CHECK(found.log_evidence < healthy + 1.0);
    CHECK(found.log_evidence > healthy - 10.0);
  }
}

TEST_CASE("a disturbance on an MV: a CV that it does not move adds what it has without one") {
  Study study = find_study("setpoint-methods");
  study.plant.G(2, 0) = TransferFunction::zero();
  const double Ts = study.controller.sample_time, freedom = 4.0;
  std::vector<ModelErrors> models = exact_models(study, {kDeviation});
  std::vector<Eigen::MatrixXd> series = disturbed(study, 0, 0.05);
  const InputEvidence all = InputLikelihood(models, series, Ts, freedom).of_mvs(1).front();
  const WhitenedProducts sums =
      marginalised(whitened_products(base_models({}, false).models, series[2]), 1, 1);
  models.pop_back();
  series.pop_back();
  const InputEvidence moved = InputLikelihood(models, series, Ts, freedom).of_mvs(1).front();
  const double alone = ScaleLikelihood{freedom, kRecord}(sums.log_determinant(0), sums.of(0, 0)(0));
  CHECK(all.log_evidence == Approx(moved.log_evidence + alone).epsilon(1e-9));
  CHECK(all.b == Approx(moved.b).epsilon(1e-9));
}

TEST_CASE("a disturbance on an MV: -infinity where it moves nothing") {
  Study study = find_study("setpoint-methods");
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    study.plant.G(cv, 1) = TransferFunction::zero();
  const std::vector<ModelErrors> models = exact_models(study, {kDeviation});
  const std::vector<Eigen::MatrixXd> series = disturbed(study, 0, 0.05);
  const std::vector<InputEvidence> found =
      InputLikelihood(models, series, study.controller.sample_time, kInfinity).of_mvs(study.mv_count());
  CHECK(found[1].log_evidence == -kInfinity);
  CHECK(found[0].log_evidence > found[2].log_evidence);
}

}  // namespace mpm
