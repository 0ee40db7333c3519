#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/badwe2009.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::assess_badwe2009;
using mpm::Badwe2009Options;
using mpm::Badwe2009Record;
using mpm::Badwe2009Result;
using mpm::Badwe2009Status;
using mpm::DecorrelationModel;
using mpm::Multiplicity;
using mpm::MvUse;
using mpm::NoiseFilter;

namespace {

/// The prediction error that a wrong gain and lag make of an input.
Eigen::RowVectorXd effect(const Eigen::RowVectorXd& u) {
  mpm::PolynomialModel model;
  model.inputs = {{Eigen::VectorXd::Constant(1, 0.2), Eigen::Vector2d(1.0, -0.8), 3}};
  return simulate(model, u).transpose();
}

/// A loop of 2 CVs and 2 MVs that move together, with a mismatch of size `mismatch` in channel y1 x u1.
Badwe2009Record two_by_two(double mismatch, std::uint64_t number, Eigen::Index samples = 600) {
  const Eigen::MatrixXd own = mpm::testing::random_steps(3, samples, number);
  Badwe2009Record record;
  record.u.resize(2, samples);
  record.u << own.row(0) + 0.5 * own.row(1), own.row(0) - 0.5 * own.row(2);
  record.y_sim = mpm::testing::random_steps(2, samples, number + 1);
  record.y = record.y_sim;
  for (Eigen::Index cv = 0; cv < 2; ++cv)
    record.y.row(cv) +=
        0.1 * mpm::testing::settled_autoregression(samples, 0.7, 10 * number + static_cast<std::uint64_t>(cv))
                  .transpose();
  record.y.row(0) -= mismatch * effect(record.u.row(0));
  record.limits = {Eigen::VectorXd::Constant(2, -mpm::kInfinity),
                   Eigen::VectorXd::Constant(2, mpm::kInfinity)};
  return record;
}

/// With a false alarm in a thousand loops, for tests of a single one.
Badwe2009Options sure() {
  Badwe2009Options options;
  options.confidence = 0.999;
  return options;
}

Badwe2009Options with_model(DecorrelationModel model) {
  Badwe2009Options options = sure();
  options.models.model = model;
  return options;
}

std::vector<bool> named(const Badwe2009Result& result) {
  std::vector<bool> channels;
  for (const mpm::ChannelAssessment& channel : result.channels)
    channels.push_back(channel.mismatch);
  return channels;
}

double strength(const Badwe2009Result& result, Eigen::Index cv, Eigen::Index mv) {
  const mpm::PartialCorrelation& correlation = result.channel(cv, mv).correlation;
  return std::abs(correlation.peak) / correlation.band;
}

}  // namespace

TEST_CASE("Badwe 2009: the channel with the mismatch is named, and only it; ordinary correlation names two") {
  const Badwe2009Record record = two_by_two(1.0, 100);
  for (const DecorrelationModel model : {DecorrelationModel::output_error, DecorrelationModel::fir}) {
    CAPTURE(static_cast<int>(model));
    const Badwe2009Result result = assess_badwe2009(record, with_model(model));
    CHECK(result.status == Badwe2009Status::ok);
    CHECK(named(result) == std::vector<bool>{true, false, false, false});
    CHECK(result.channel(0, 0).correlation.peak > 0.0);  // e = y_sim - y has the sign of G0 - G
    CHECK(result.channel(0, 0).correlation.lag >= 3);    // its dead time
  }
  const Eigen::VectorXd e = (record.y_sim - record.y).row(0).transpose();
  for (Eigen::Index mv = 0; mv < 2; ++mv) {
    // At the confidence that the method gives each of its 30 lags and 4 channels.
    const Eigen::VectorXd u = record.u.row(mv).transpose();
    CHECK(mpm::partial_correlation(u, e.array() - e.mean(), 1, 30, 1.0 - 0.001 / 120.0).is_strong());
  }
}

TEST_CASE("Badwe 2009: an MV without a part in the error has none, whatever the other one does") {
  // e1 is made by u2 alone and u2 by the same regression: nothing is left in channel y1 x u1.
  Badwe2009Record record = two_by_two(0.0, 200);
  record.y.row(0) = record.y_sim.row(0) - 3.0 * record.u.row(1);
  const Badwe2009Result result = assess_badwe2009(record);
  CHECK_FALSE(result.channel(0, 0).mismatch);
  CHECK(result.channel(0, 1).mismatch);
}

TEST_CASE("Badwe 2009: false alarms of a loop keep to the confidence that is shared out") {
  constexpr int kTrials = 300;
  std::int64_t alarms = 0;
  std::int64_t alarms_each_lag = 0;
  Badwe2009Options each_lag;
  each_lag.multiplicity = Multiplicity::none;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Badwe2009Record record = two_by_two(0.0, 5000 + 10 * trial, 400);
    const auto any = [](const std::vector<bool>& channels) {
      return std::find(channels.begin(), channels.end(), true) != channels.end();
    };
    alarms += any(named(assess_badwe2009(record))) ? 1 : 0;
    alarms_each_lag += any(named(assess_badwe2009(record, each_lag))) ? 1 : 0;
  }
  CHECK(mpm::testing::clopper_pearson_interval(alarms, kTrials, 0.999).lower < 0.05);
  CHECK(alarms_each_lag > kTrials / 2);  // 120 correlations at 5 % each
}

TEST_CASE("Badwe 2009: units, offsets and the order of the MVs change no verdict") {
  const Badwe2009Record record = two_by_two(0.3, 300);
  Badwe2009Record other = record;
  other.u.row(0) = (100.0 * record.u.row(1)).array() + 7.0;
  other.u.row(1) = -0.01 * record.u.row(0);
  other.y.row(0) *= 1000.0;
  other.y_sim.row(0) = 1000.0 * record.y_sim.row(0).array() - 20.0;
  const Badwe2009Result before = assess_badwe2009(record);
  const Badwe2009Result after = assess_badwe2009(other);
  for (Eigen::Index cv = 0; cv < 2; ++cv)
    for (Eigen::Index mv = 0; mv < 2; ++mv) {
      const mpm::PartialCorrelation& a = before.channel(cv, mv).correlation;
      const mpm::PartialCorrelation& b = after.channel(cv, 1 - mv).correlation;
      CHECK(b.peak == Approx(mv == 0 ? -a.peak : a.peak).epsilon(1e-7));
      CHECK(b.band == Approx(a.band).epsilon(1e-7));
      CHECK(b.lag == a.lag);
    }
}

TEST_CASE("Badwe 2009: a larger mismatch has a stronger correlation") {
  double before = 0.0;
  for (const double mismatch : {0.0, 0.2, 0.5, 2.0}) {
    const double now = strength(assess_badwe2009(two_by_two(mismatch, 400)), 0, 0);
    CHECK(now > before);
    before = now;
  }
}

TEST_CASE("Badwe 2009: MVs that say nothing are left out, and why") {
  Badwe2009Record record = two_by_two(1.0, 500);
  record.u.conservativeResize(3, Eigen::NoChange);
  record.limits = {Eigen::VectorXd::Constant(3, -5.0), Eigen::VectorXd::Constant(3, 5.0)};
  const Badwe2009Result two = assess_badwe2009(two_by_two(1.0, 500));

  SECTION("standing still") {
    record.u.row(2).setConstant(0.3);
    const Badwe2009Result result = assess_badwe2009(record);
    CHECK(result.mv_use == std::vector<MvUse>{MvUse::evaluated, MvUse::evaluated, MvUse::standing_still});
    CHECK(strength(result, 0, 0) == strength(two, 0, 0));  // it takes no part in the models of the others
    CHECK(result.channel(0, 2).correlation.values.size() == 0);
  }
  SECTION("at a limit for more than the share allowed") {
    record.u.row(2).setConstant(5.0);
    record.u.row(2).head(250) = record.u.row(0).head(250);
    CHECK(assess_badwe2009(record).mv_use[2] == MvUse::saturated);
    Badwe2009Options options;
    options.saturated_share = 0.6;  // 350 of 600
    CHECK(assess_badwe2009(record, options).mv_use[2] == MvUse::evaluated);
  }
  SECTION("doing as another does") {
    record.u.row(2) = 2.0 * record.u.row(1);
    const Badwe2009Result result = assess_badwe2009(record);
    CHECK(result.mv_use == std::vector<MvUse>{MvUse::evaluated, MvUse::dependent, MvUse::dependent});
    CHECK(result.channel(0, 0).mismatch);
    CHECK_FALSE(result.channel(0, 1).mismatch);
  }
  SECTION("all") {
    record.u.setZero();
    CHECK(assess_badwe2009(record).status == Badwe2009Status::no_mv);
  }
}

TEST_CASE("Badwe 2009: feedback from a disturbance is taken for a mismatch, unless only setpoints count") {
  // Two loops without mismatch: each controller answers the disturbance of its CV, and its setpoint.
  constexpr Eigen::Index kSamples = 800;
  Badwe2009Record record = two_by_two(0.0, 600, kSamples);
  record.external = mpm::testing::random_steps(2, kSamples, 601);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::RowVectorXd v =
        mpm::testing::settled_autoregression(kSamples, 0.95, 602 + static_cast<std::uint64_t>(i)).transpose();
    record.u.row(i) = effect(4.0 * record.external.row(i)) - v;
    record.y.row(i) = record.y_sim.row(i) + v;
  }
  Badwe2009Options options = sure();
  options.filter = NoiseFilter::none;
  const Badwe2009Result measured = assess_badwe2009(record, options);
  CHECK(measured.channel(0, 0).mismatch);
  CHECK(measured.channel(1, 1).mismatch);
  options.filter = NoiseFilter::automatic;
  const Badwe2009Result driven = assess_badwe2009(record, options);
  CHECK(driven.filter == NoiseFilter::external);
  CHECK(named(driven) == std::vector<bool>(4, false));
  // A mismatch is still seen.
  record.y.row(1) -= 4.0 * effect(record.u.row(0));
  CHECK(assess_badwe2009(record, options).channel(1, 0).mismatch);
  // One signal cannot tell two MVs apart.
  record.external.row(1).setZero();
  CHECK(assess_badwe2009(record, options).filter == NoiseFilter::none);
}

TEST_CASE("Badwe 2009 refuses what cannot be meant") {
  const Badwe2009Record good = two_by_two(0.0, 700);
  Badwe2009Record record = good;
  record.y_sim.conservativeResize(1, Eigen::NoChange);
  CHECK_THROWS_WITH(assess_badwe2009(record), Catch::Contains("y_sim 1 x 600"));
  record = good;
  record.y(1, 5) = std::nan("");
  CHECK_THROWS_WITH(assess_badwe2009(record), Catch::Contains("not finite"));
  record = good;
  record.limits.lower.resize(1);
  CHECK_THROWS_WITH(assess_badwe2009(record), Catch::Contains("1 lower and 2 upper"));
  record = good;
  record.limits.lower(1) = mpm::kInfinity;
  record.limits.upper(1) = 0.0;
  CHECK_THROWS_WITH(assess_badwe2009(record), Catch::Contains("limits of MV 1"));
  CHECK_THROWS_AS(assess_badwe2009({}), mpm::InputError);

  Badwe2009Options options;
  options.max_lag = 0;
  CHECK_THROWS_WITH(assess_badwe2009(good, options),
                    Catch::Contains("lags of a partial correlation: found 1 to 0"));
  options = {};
  options.models.fir_length = 0;
  CHECK_THROWS_WITH(assess_badwe2009(good, options), Catch::Contains("length of the regression"));
}
