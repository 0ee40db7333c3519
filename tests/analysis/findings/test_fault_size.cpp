#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/fault_size.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace {

using namespace mpm;

ExperimentRecord record(std::int64_t index, MismatchParameter parameter, double value, bool flagged,
                        bool right) {
  ExperimentRecord made;
  made.draw.index = index;
  made.draw.kind = ExperimentKind::mpm;
  made.draw.mismatches = {{0, 0, parameter, value}};
  made.status = ExperimentStatus::ok;
  made.assessments = {
      testing::verdict(testing::chain_form(), flagged, 1.0, 0, right ? FaultSource::mpm : FaultSource::ud)};
  return made;
}

TEST_CASE("fault size: the deviation of a disturbance is that of the filtered white noise") {
  const Disturbance disturbance{0, 2.0, 30.0};
  constexpr double kSampleTime = 4.0, kV = 1.5;
  const double predicted = disturbance_deviation(disturbance, kV, kSampleTime);
  RandomStream stream(21, 0, StreamId::disturbance_signal);
  const double a = std::exp(-kSampleTime / disturbance.time_constant);
  double y = 0.0, squares = 0.0;
  constexpr int kSamples = 400000;
  for (int k = 0; k < kSamples; ++k) {
    y = a * y + (1.0 - a) * disturbance.gain * kV * stream.normal();  // zero-order hold of the first order
    squares += y * y;
  }
  // About 2 tau/Ts = 15 samples are one independent value of y^2: 26000 of them know the deviation to 0.5 %.
  CHECK(std::sqrt(squares / kSamples) == Approx(predicted).epsilon(0.02));
  CHECK(disturbance_deviation({0, -2.0, 30.0}, kV, kSampleTime) == predicted);
  // A slow one: sigma = gain sqrt(Ts/2 tau), where 1 - a would have lost its digits.
  CHECK(disturbance_deviation({0, 1.0, 1e17}, 1.0, 2.0) == Approx(std::sqrt(1e-17)).epsilon(1e-12));
}

TEST_CASE("fault size: only experiments with a verdict and that single fault count, smallest first") {
  Study study;
  study.controller.sample_time = 1.0;
  std::vector<ExperimentRecord> records{record(0, MismatchParameter::gain, 1.4, true, true),
                                        record(1, MismatchParameter::gain, 0.5, true, false),
                                        record(2, MismatchParameter::gain, 0.9, false, false),
                                        record(3, MismatchParameter::dead_time, -1.0, true, true),
                                        record(4, MismatchParameter::gain, 0.7, true, true),
                                        record(5, MismatchParameter::gain, 0.6, true, true)};
  records[4] = testing::without_verdict(records[4], ExperimentStatus::infeasible);
  records[5].draw.kind = ExperimentKind::mpm_ud;
  records.push_back(record(6, MismatchParameter::gain, 0.6, true, true));
  records.back().draw.mismatches.clear();  // a changed actuator, or a changed number of a nonlinear plant
  records.push_back(records.back());
  records.back().draw.kind = ExperimentKind::ud;
  CHECK(faults_by_size(study, 0, records, FaultSize::disturbance_deviation).empty());
  const auto faults = faults_by_size(study, 0, records, FaultSize::gain_factor);
  REQUIRE(faults.size() == 3);
  CHECK(faults[0].experiment == 1);
  CHECK(faults[0].flagged);
  CHECK_FALSE(faults[0].diagnosed);
  CHECK(faults[1].experiment == 2);
  CHECK_FALSE(faults[1].flagged);
  CHECK_FALSE(faults[1].diagnosed);  // what is not seen is not diagnosed, whatever the verdict
  CHECK(faults[2].diagnosed);
  CHECK(faults_by_size(study, 0, records, FaultSize::dead_time_shift).size() == 1);
  CHECK(faults_by_size(study, 0, records, FaultSize::time_constant_factor).empty());
  CHECK(faults_by_size(study, 0, records, FaultSize::disturbance_deviation).empty());
}

TEST_CASE("fault size: bins hold every fault once, in order and in nearly equal number") {
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 47; ++i)
    records.push_back(record(i, MismatchParameter::gain, 0.3 + 0.02 * i, i % 3 == 0, i % 2 == 0));
  const auto faults = faults_by_size(Study{}, 0, records, FaultSize::gain_factor);
  const auto bins = size_bins(faults, 6, 0.95);
  REQUIRE(bins.size() == 6);
  std::int64_t total = 0, flagged = 0, diagnosed = 0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    CHECK((bins[b].flagged.total == 7 || bins[b].flagged.total == 8));
    CHECK(bins[b].smallest <= bins[b].median);
    CHECK(bins[b].median <= bins[b].largest);
    if (b > 0)
      CHECK(bins[b - 1].largest < bins[b].smallest);
    total += bins[b].flagged.total;
    flagged += bins[b].flagged.hits;
    diagnosed += bins[b].diagnosed.hits;
  }
  CHECK(total == 47);
  CHECK(flagged == 16);   // 0, 3, ..., 45
  CHECK(diagnosed == 8);  // of these the even ones
  CHECK(size_bins(std::span(faults).first(2), 6, 0.95).size() == 2);
  CHECK(size_bins({}, 6, 0.95).empty());
  CHECK_THROWS_AS(size_bins(faults, 0, 0.95), InputError);
}

}  // namespace
