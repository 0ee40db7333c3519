#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/methods/ours/cv_evidence.hpp"
#include "analysis/methods/ours/growing_mismatch.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/changing_plant.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kRecordLength = 400;
constexpr double kNoiseDeviation = 0.05;

/// Moves of every input, each 15 samples.
Eigen::MatrixXd stepped_inputs(Eigen::Index inputs) {
  RandomStream stream(17, 3, StreamId::excitation);
  Eigen::MatrixXd u(inputs, kRecordLength);
  for (Eigen::Index k = 0; k < kRecordLength; ++k)
    for (Eigen::Index i = 0; i < inputs; ++i)
      u(i, k) = k % 15 == 0 ? 0.5 * stream.normal() : u(i, k - 1);
  return u;
}

CvPrior prior_of_first_cv() {
  const Distribution factor = Distribution::log_uniform(0.1, 10.0);
  return {1.0,
          1.0,
          1.0,
          {{{0, 0}, MismatchParameter::gain, 0.5, factor},
           {{0, 1}, MismatchParameter::time_constant, 0.5, factor}},
          {{0.9, 0.5, 0.02, Distribution::log_uniform(0.1, 100.0)},
           {0.98, 0.5, 0.01, Distribution::log_uniform(0.1, 100.0)}}};
}

/// e of the first CV of a plant that changes.
Eigen::RowVectorXd error_of_growing(const Study& study, const Mismatch& mismatch, const Eigen::MatrixXd& u,
                                    double onset, double end) {
  Eigen::VectorXd share(u.cols());
  for (Eigen::Index k = 0; k < share.size(); ++k)
    share(k) = std::clamp((static_cast<double>(k) - onset) / (end - onset), 0.0, 1.0);
  const double Ts = study.controller.sample_time;
  ChangingPlant plant(study.plant.G, with_mismatches(study.plant.G, {mismatch}), Ts, share);
  Eigen::RowVectorXd e = -simulate(study.plant.G, Ts, u).row(0);
  for (Eigen::Index k = 0; k < e.size(); ++k) {
    e(k) += plant.output()(0);
    plant.advance(u.col(k));
  }
  return e;
}

}  // namespace

TEST_CASE("a mismatch that grows: parameter, size and time are found, and it is likelier than both faults") {
  const Study study = find_study("setpoint-methods");
  const CvPrior prior = prior_of_first_cv();
  const Eigen::MatrixXd u = stepped_inputs(study.plant.G.cols());
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.rows());
  const double Ts = study.controller.sample_time;
  const CvLikelihood likelihood(ModelErrors(study, 0, {kNoiseDeviation}), Ts, prior, 4.0, false);
  for (std::size_t truth = 0; truth < prior.mismatches.size(); ++truth) {
    const SizePrior& wrong = prior.mismatches[truth];
    const MismatchResponses response(study.plant.G(0, wrong.channel.mv), Ts, wrong);
    const double size = 1.6, onset = 120.0, end = 200.0;
    Eigen::RowVectorXd e =
        error_of_growing(study, {0, wrong.channel.mv, wrong.parameter, size}, u, onset, end);
    e += kNoiseDeviation * testing::white_noise(kRecordLength, 50 + truth).transpose();
    e.segment(250, 5).setConstant(kNaN);

    CvEvidence evidence = likelihood.of(e, u, rest, Eigen::MatrixXd(0, e.size()));
    CHECK(evidence.mpm < evidence.both);
    const double without = evidence.mpm;
    const Eigen::MatrixXd untold(0, e.size());
    likelihood.add_growing(likelihood.healthy_series(e, u, rest, untold), u, rest, untold, 0.5, evidence);
    CHECK(evidence.mpm > evidence.both + 3.0);
    CHECK(evidence.mpm > without);
    const MismatchEvidence& named = evidence.mismatch_alone[truth];
    CHECK(named.log_evidence > evidence.mismatch_alone[1 - truth].log_evidence);
    const Interval interval = shortest_interval(named.sizes, 0.999);
    CHECK(interval.lower < size);
    CHECK(interval.upper > size);
    CHECK(interval.upper - interval.lower < 0.5);

    const std::vector<MismatchResponses> responses{response};
    const auto nothing_unknown = [](std::size_t, double, const Eigen::RowVectorXd& part) {
      return Eigen::MatrixXd(0, part.size());
    };
    const std::vector<GrowingMismatch> found =
        growing_mismatches({kNoiseDeviation}, false, {4.0, kRecordLength - 5.0}, responses,
                           e / kNoiseDeviation, u, rest, nothing_unknown);
    REQUIRE(found.size() == 1);
    // A mismatch of this size shows within a few moves of the MVs.
    CHECK(found[0].onset == Approx(onset).margin(30.0));
    CHECK(found[0].end == Approx(end).margin(30.0));
  }
}

TEST_CASE("a mismatch that grows: its evidence for noise is that of nothing or less") {
  const Study study = find_study("setpoint-methods");
  const CvPrior prior = prior_of_first_cv();
  const Eigen::MatrixXd u = stepped_inputs(study.plant.G.cols());
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.rows());
  const CvLikelihood likelihood(ModelErrors(study, 0, {kNoiseDeviation}), study.controller.sample_time, prior,
                                4.0, false);
  const Eigen::RowVectorXd e = kNoiseDeviation * testing::white_noise(kRecordLength, 60).transpose();
  CvEvidence evidence = likelihood.of(e, u, rest, Eigen::MatrixXd(0, e.size()));
  const Eigen::MatrixXd untold(0, e.size());
  likelihood.add_growing(likelihood.healthy_series(e, u, rest, untold), u, rest, untold, 0.5, evidence);
  CHECK(evidence.mpm < evidence.healthy + 1.0);
}

TEST_CASE("a gain that grows is explained in full, and its size has the doubt about its channel") {
  const Study study = find_study("setpoint-methods");
  CvPrior prior = prior_of_first_cv();
  prior.mismatches.pop_back();
  const Eigen::MatrixXd u = stepped_inputs(study.plant.G.cols());
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.rows());
  const double size = 5.0, noise = 0.002;
  const Eigen::RowVectorXd white = noise * testing::white_noise(kRecordLength, 61).transpose();
  const Eigen::RowVectorXd e =
      error_of_growing(study, {0, 0, MismatchParameter::gain, size}, u, 100.0, 180.0) + white;
  const Eigen::MatrixXd untold(0, e.size());
  const auto deviation_of_size = [&](const ModelErrors& model) {
    const CvLikelihood likelihood(model, study.controller.sample_time, prior, 4.0, false);
    const Eigen::MatrixXd series = likelihood.healthy_series(e, u, rest, untold);
    CvEvidence evidence = likelihood.of(e, u, rest, untold);
    likelihood.add_growing(series, u, rest, untold, 0.5, evidence);
    const Interval sizes = shortest_interval(evidence.mismatch_alone[0].sizes, 0.95);
    CHECK(sizes.lower < size);
    CHECK(sizes.upper > size);
    return (sizes.upper - sizes.lower) / 3.92;
  };
  const double exact = deviation_of_size(ModelErrors(study, 0, {noise}));
  CHECK(exact < 0.01);
  // A benchmark without moves says nothing of errors of 5 %, which the gain makes five times as large.
  const ModelErrors unknown(study, 0, relative_errors(study, 0, 0.05, 0.0), white,
                            Eigen::MatrixXd::Zero(u.rows(), u.cols()), rest, 1e-6, BaseNoise{noise});
  CHECK(deviation_of_size(unknown) > 3.0 * exact);
}

}  // namespace mpm
