#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/monitored_loop.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

// Windows of 100 samples every 50, in records of 400 samples of 4 min: they end at 100, 150, ... 400.

namespace mpm {
namespace {

const Study& monitored() {
  static const Study study = [] {
    Study chapter6 = find_study("chapter6");
    chapter6.simulation.samples = 400;
    chapter6.monitoring = {100, 50};
    return chapter6;
  }();
  return study;
}

/// What is said of the seven windows: 1 flagged, 0 not, NaN no verdict.
ExperimentRecord said(ExperimentKind kind, int onset, const std::array<double, 7>& flags) {
  ExperimentRecord record = testing::made_up_record(0, ExperimentKind::mpm, 1, 0.2);
  record.draw.kind = kind;
  record.draw.onset.sample = onset;
  record.assessments = {kept(testing::form_of(monitored(), "sse"), {})};
  for (int window = 0; window < 7; ++window)
    if (const double flag = flags[static_cast<std::size_t>(window)]; !std::isnan(flag)) {
      Assessment of_window;
      of_window.flagged = flag == 1.0;
      add_window(record.assessments[0], window, of_window);
    }
  return record;
}

MonitoredLoop found(ExperimentKind kind, int onset, const std::array<double, 7>& flags) {
  const ExperimentRecord record = said(kind, onset, flags);
  return monitored_loop(monitored(), record, record.assessments[0]);
}

constexpr auto kFaulty = ExperimentKind::mpm, kHealthy = ExperimentKind::healthy;

}  // namespace

TEST_CASE("monitored loop: the delay runs from the onset to the end of the first flagged window after it") {
  REQUIRE(monitored().monitoring->count(400) == 7);
  const MonitoredLoop loop = found(kFaulty, 200, {0, 0, 0, 0, 1, 0, 1});
  CHECK(loop.delay == 100 * 4.0);    // the window that ends at sample 300
  CHECK(loop.verdicts_before == 3);  // at 100, 150 and 200
  CHECK(loop.false_alarms == 0);
  CHECK(found(kFaulty, 201, {0, 0, 0, 0, 0, 0, 0}).delay == kInfinity);
  CHECK(std::isnan(found(kFaulty, 201, {1, 0, 0, kNaN, kNaN, kNaN, kNaN}).delay));  // not asked after it
  CHECK(std::isnan(found(kHealthy, 200, {0, 0, 0, 0, 1, 0, 0}).delay));
  CHECK(found(kFaulty, 0, {1, 0, 0, 0, 0, 0, 0}).delay == 400.0);
}

TEST_CASE("monitored loop: an alarm begins where a flagged window follows one that is not flagged") {
  const MonitoredLoop healthy = found(kHealthy, 0, {1, 1, 0, 1, kNaN, 1, 0});
  CHECK(healthy.verdicts_before == 6);
  CHECK(healthy.false_alarms == 2);  // a window without a verdict ends no alarm
  const MonitoredLoop faulty = found(kFaulty, 250, {1, 0, 1, 1, 1, 1, 1});
  CHECK(faulty.verdicts_before == 4);
  CHECK(faulty.false_alarms == 2);
  CHECK(faulty.delay == 50 * 4.0);
}

TEST_CASE("monitored loops: median of the delays, and alarms over the time that was watched") {
  const std::vector<ExperimentRecord> records{
      said(kFaulty, 200, {0, 0, 0, 0, 1, 1, 1}), said(kFaulty, 200, {0, 0, 1, 1, 1, 1, 1}),
      said(kFaulty, 200, {0, 0, 0, 0, 0, 0, 0}), said(kHealthy, 0, {0, 0, 0, 1, 0, 0, 0})};
  const MethodRates rates = rate_collector(monitored(), 0).of(records);
  CHECK(rates.estimates["detection_delay"].value == 400.0);  // of 400, 200 and never
  CHECK(rates.estimates["detection_delay"].count == 3);
  CHECK(rates["monitored_impact"].hits == 2);
  CHECK(rates["monitored_impact"].total == 3);
  // 16 windows watch 50 samples of 4 min each, in which two alarms begin.
  CHECK(rates.estimates["false_alarms_a_day"].value == Approx(2.0 / (16 * 50 * 4.0 / 1440.0)));
  CHECK(rates.estimates["false_alarms_a_day"].count == 16);
}

TEST_CASE("days in a time unit, and none of one that is not known") {
  CHECK(*days_in("h") == Approx(60 * *days_in("min")));
  CHECK(*days_in("min") == Approx(60 * *days_in("s")));
  CHECK(*days_in("d") == Approx(24 * *days_in("h")));
  CHECK_FALSE(days_in("fortnight"));
}

}  // namespace mpm
