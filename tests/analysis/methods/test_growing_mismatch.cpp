#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/methods/cv_evidence.hpp"
#include "analysis/methods/growing_mismatch.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/files/study_library.hpp"
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
    Eigen::RowVectorXd e = response.at(size, u.row(wrong.channel.mv), 0.0);
    for (Eigen::Index k = 0; k < kRecordLength; ++k)
      e(k) *= std::clamp((static_cast<double>(k) - onset) / (end - onset), 0.0, 1.0);
    e += kNoiseDeviation * testing::white_noise(kRecordLength, 50 + truth).transpose();
    e.segment(250, 5).setConstant(kNaN);

    CvEvidence evidence = likelihood.of(e, u, rest, Eigen::MatrixXd(0, e.size()));
    CHECK(evidence.mpm < evidence.both);
    const double without = evidence.mpm;
    likelihood.add_growing(likelihood.healthy_series(e, u, rest, Eigen::MatrixXd(0, e.size())), u, rest, 0.5,
                           evidence);
    CHECK(evidence.mpm > evidence.both + 3.0);
    CHECK(evidence.mpm > without);
    const MismatchEvidence& named = evidence.mismatch_alone[truth];
    CHECK(named.log_evidence > evidence.mismatch_alone[1 - truth].log_evidence);
    const Interval interval = shortest_interval(named.sizes, 0.999);
    CHECK(interval.lower < size);
    CHECK(interval.upper > size);
    CHECK(interval.upper - interval.lower < 0.5);

    const std::vector<MismatchResponses> responses{response};
    const std::vector<GrowingMismatch> found = growing_mismatches(
        {kNoiseDeviation}, false, {4.0, kRecordLength - 5.0}, responses, e / kNoiseDeviation, u, rest);
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
  likelihood.add_growing(likelihood.healthy_series(e, u, rest, Eigen::MatrixXd(0, e.size())), u, rest, 0.5,
                         evidence);
  CHECK(evidence.mpm < evidence.healthy + 1.0);
}

}  // namespace mpm
