#include <cmath>
#include <cstdint>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/indicators/acf_comparison.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/row_checks.hpp"
#include "tests/analysis/signals.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using mpm::AcfComparison;
using mpm::AcfComparisonOptions;
using mpm::Autocorrelation;
using mpm::compare_autocorrelations;
using mpm::decay_lag;
using mpm::ErrorOrigin;
using mpm::LoopSpeed;
using mpm::Oscillation;
using mpm::testing::settled_autoregression;
using mpm::testing::settled_second_order;
using mpm::testing::white_noise;

namespace {

Autocorrelation acf_of(const VectorXd& values) {
  Autocorrelation acf;
  acf.values = values;
  acf.bartlett_band = VectorXd::Zero(values.size());  // nothing is chance
  return acf;
}

/// Share of `records` pairs for which the speed is said to differ.
template <class MakePair>
double share_of_differences(int records, MakePair make_pair) {
  int differences = 0;
  for (int record = 0; record < records; ++record) {
    const auto [y, y0] = make_pair(static_cast<std::uint64_t>(2 * record));
    const LoopSpeed speed = compare_autocorrelations(y, y0, y0).speed;
    differences += speed == LoopSpeed::slower || speed == LoopSpeed::faster ? 1 : 0;
  }
  return static_cast<double>(differences) / records;
}

}  // namespace

TEST_CASE("decay lag by hand") {
  CHECK(decay_lag(acf_of((VectorXd(3) << 1.0, 0.5, 0.3).finished()), 0.4) == Approx(1.5).epsilon(1e-15));
  // The last excursion counts, of either sign.
  CHECK(decay_lag(acf_of((VectorXd(4) << 1.0, 0.3, -0.5, 0.1).finished()), 0.4) ==
        Approx(2.25).epsilon(1e-15));
  CHECK(std::isinf(decay_lag(acf_of((VectorXd(2) << 1.0, 0.9).finished()), 0.4)));
  CHECK(std::isnan(decay_lag(mpm::autocorrelation(VectorXd::Constant(20, 1.0), 5), 0.4)));
}

TEST_CASE("a rise over the level after the decay counts where it leaves the band") {
  Autocorrelation acf = acf_of((VectorXd(8) << 1.0, 0.3, 0.5, 0.6, 0.1, -0.5, 0.1, 0.0).finished());
  CHECK(decay_lag(acf, 0.4) == Approx(5.25).epsilon(1e-15));
  acf.bartlett_band.setConstant(0.55);  // the run of 0.5 and 0.6 leaves it, that of -0.5 does not
  CHECK(decay_lag(acf, 0.4) == Approx(3.4).epsilon(1e-15));
  CHECK(decay_lag(acf, 0.4, 1.2) == Approx(6.0 / 7.0).epsilon(1e-15));
  acf.values[7] = 0.6;  // up to the last lag
  CHECK(std::isinf(decay_lag(acf, 0.4)));
  CHECK(decay_lag(acf, 0.4, 1.2) == Approx(6.0 / 7.0).epsilon(1e-15));
  acf.values.setConstant(0.5);  // it never was below the level: no rise
  CHECK(std::isinf(decay_lag(acf, 0.4, 100.0)));
  CHECK(mpm::simultaneous_band_factor(0.95, 1) == Approx(1.0).epsilon(1e-15));
  CHECK(mpm::simultaneous_band_factor(0.95, 50) == Approx(3.2905 / 1.95996).epsilon(1e-4));  // z(0.9995)
}

TEST_CASE("the decay lag of a first-order function at 1/e is its time constant") {
  for (const double a : {0.7, 0.9, 0.97}) {
    VectorXd values(200);
    for (Index lag = 0; lag < values.size(); ++lag) {
      values[lag] = std::pow(a, static_cast<double>(lag));
    }
    // The chord of an exponential over one lag lies above it by at most 1/8 of (ln a)^2, on a slope of -ln a.
    CHECK(decay_lag(acf_of(values), std::exp(-1.0)) == Approx(-1.0 / std::log(a)).margin(-std::log(a) / 4.0));
  }
}

TEST_CASE("a loop slower or faster than designed") {
  // The same noise through a = 0.9 (time constant 9.5 samples), 0.97 (33) and 0.7 (2.8).
  const VectorXd y0 = settled_autoregression(1000, 0.9, 1);
  const VectorXd slow = settled_autoregression(1000, 0.97, 1);
  const VectorXd fast = settled_autoregression(1000, 0.7, 1);
  const auto slower = compare_autocorrelations(slow, y0, y0);
  CHECK(slower.speed == LoopSpeed::slower);
  CHECK(slower.decay_lag_ratio > 1.5);
  CHECK(compare_autocorrelations(fast, y0, y0).speed == LoopSpeed::faster);
  CHECK(compare_autocorrelations(y0, slow, y0).speed == LoopSpeed::faster);
  CHECK(compare_autocorrelations(y0, slow, y0).decay_lag_ratio ==
        Approx(1.0 / slower.decay_lag_ratio).epsilon(1e-14));
  CHECK(compare_autocorrelations(y0, slow, y0).decay_margin == Approx(slower.decay_margin).epsilon(1e-12));
  const auto same = compare_autocorrelations(y0, y0, y0);
  CHECK(same.speed == LoopSpeed::alike);
  CHECK(same.decay_lag_ratio == 1.0);
  CHECK(same.decay_margin == Approx(1.25).epsilon(1e-6));
  CHECK(same.origin == ErrorOrigin::none);
}

TEST_CASE("signals without a decay lag") {
  const VectorXd y0 = settled_autoregression(400, 0.8, 2);
  const VectorXd ramp = VectorXd::LinSpaced(400, 0.0, 1.0);
  const VectorXd still = VectorXd::Constant(400, 0.3);
  AcfComparisonOptions few_lags;
  few_lags.max_lag = 60;
  const auto lost = compare_autocorrelations(ramp, y0, y0, std::nullopt, few_lags);
  CHECK(std::isinf(lost.decay_lag_ratio));
  CHECK(lost.speed == LoopSpeed::slower);
  CHECK(compare_autocorrelations(y0, ramp, y0, std::nullopt, few_lags).speed == LoopSpeed::faster);
  CHECK(compare_autocorrelations(ramp, ramp, y0, std::nullopt, few_lags).speed == LoopSpeed::undetermined);
  const auto nothing = compare_autocorrelations(still, y0, y0);
  CHECK(nothing.speed == LoopSpeed::undetermined);
  CHECK(nothing.y.oscillation.verdict == Oscillation::undetermined);
  CHECK(nothing.origin == ErrorOrigin::none);
}

TEST_CASE("records of one process are seldom said to differ in speed, whatever they have in common") {
  // Measured with 300 pairs: at most 5 % for records of 20 time constants or more. Were every rise over the
  // level to count, it would be 10 to 15 % for 20, and 6 to 8 % for 45.
  for (const Index samples : {100, 200, 400})  // 22, 45 and 89 time constants
    for (const double coherence : {0.0, 0.9, 0.99}) {
      const double share = share_of_differences(100, [=](std::uint64_t record) {
        const VectorXd y0 = settled_autoregression(samples, 0.8, record);
        const VectorXd other = settled_autoregression(samples, 0.8, record + 1);
        return std::pair<VectorXd, VectorXd>(coherence * y0 + std::sqrt(1.0 - coherence * coherence) * other,
                                             y0);
      });
      INFO(samples << " samples, coherence " << coherence << ": " << share);
      CHECK(share <= 0.09);  // 2 binomial deviations above 5 %
    }
  // Twice the time constant, under the same noise, is found nearly always: 76 % of 400 samples, 99 % of 1000.
  CHECK(share_of_differences(50, [](std::uint64_t record) {
          return std::pair<VectorXd, VectorXd>(settled_autoregression(1000, 0.95, record),
                                               settled_autoregression(1000, 0.9, record));
        }) >= 0.92);
}

TEST_CASE("where the error comes from: figure A2.1 and the logic of step 2") {
  const VectorXd y0 = settled_autoregression(1000, 0.8, 3);
  const VectorXd y = settled_second_order(1000, 0.85, 25.0, 4);
  const auto own = compare_autocorrelations(y, y0, y0);
  CHECK(own.oscillates_by_error());
  CHECK_FALSE(own.calmed_by_error());
  CHECK(own.y.oscillation.period == Approx(25.0).margin(2.0));
  CHECK(own.origin == ErrorOrigin::own);
  CHECK(own.own_share == 1.0);
  CHECK(own.y0_diag_from_y0 == 0.0);
  CHECK(own.y_from_y0 == own.y_from_y0_diag);
  const auto others = compare_autocorrelations(y, y0, y);
  CHECK(others.origin == ErrorOrigin::others);
  CHECK(others.own_share == 0.0);
  // Of the sum of two independent signals of equal power the function is about the mean of theirs.
  const auto both = compare_autocorrelations(y, y0, y / y.norm() + y0 / y0.norm());
  CHECK(both.own_share == Approx(0.5).margin(1.0 / 6.0));
  CHECK(both.origin == ErrorOrigin::both);
  const auto calmed = compare_autocorrelations(y0, y, y);
  CHECK(calmed.calmed_by_error());
  CHECK_FALSE(calmed.oscillates_by_error());
  CHECK(calmed.origin == ErrorOrigin::own);
}

TEST_CASE("the distance of two functions is their root mean square difference") {
  const VectorXd y = settled_autoregression(200, 0.9, 5);
  const VectorXd y0 = settled_autoregression(200, 0.5, 6);
  const auto found = compare_autocorrelations(y, y0, y0);
  const VectorXd a = mpm::autocorrelation(y, 50).values;
  const VectorXd b = mpm::autocorrelation(y0, 50).values;
  double sum = 0.0;
  for (Index lag = 1; lag <= 50; ++lag) {
    sum += (a[lag] - b[lag]) * (a[lag] - b[lag]);
  }
  CHECK(found.y_from_y0 == Approx(std::sqrt(sum / 50.0)).epsilon(1e-13));
}

TEST_CASE("with a setpoint the functions are those of the control errors") {
  const VectorXd error = settled_autoregression(400, 0.8, 7);
  const VectorXd error0 = settled_autoregression(400, 0.9, 7);
  const VectorXd y_set = 5.0 * white_noise(400, 8);
  const auto plain = compare_autocorrelations(error, error0, error0, VectorXd::Zero(400));
  const auto found = compare_autocorrelations(error + y_set, error0 + y_set, error0 + y_set, y_set);
  for (const auto& row : mpm::acf_rows()) {
    INFO(row.text.name);
    const double expected = numbers_of(row, plain).front();
    CHECK((std::isnan(expected) ? std::isnan(numbers_of(row, found).front())
                                : numbers_of(row, found).front() == Approx(expected).epsilon(1e-9)));
  }
  // About a setpoint that it never reaches, a signal does not decay, and no band holds; about its mean it
  // does.
  const VectorXd offset = error.array() + 20.0;
  const auto never = compare_autocorrelations(offset, error0, error0, VectorXd::Zero(400));
  CHECK(std::isinf(never.y.decay_lag));
  CHECK(never.speed == LoopSpeed::undetermined);
  CHECK(compare_autocorrelations(offset, error0, error0).decay_lag_ratio ==
        Approx(compare_autocorrelations(error, error0, error0).decay_lag_ratio).epsilon(1e-9));
}

TEST_CASE("every number of a comparison has one row") {
  const auto rows = mpm::acf_rows();
  mpm::testing::check_rows(rows, 3 * 4 + 7 + 2);
  AcfComparison marked;
  marked.y0_diag.oscillation.period = 12.0;
  marked.speed = LoopSpeed::faster;
  for (const auto& row : rows) {
    if (row.text.name == "period_y0_diag") {
      CHECK(numbers_of(row, marked).front() == 12.0);
    }
    if (row.text.name == "loop_speed") {
      CHECK(numbers_of(row, marked).front() == 3.0);
    }
  }
  CHECK(mpm::to_string(LoopSpeed::slower) == "slower");
  CHECK(mpm::to_string(LoopSpeed::undetermined) == "undetermined");
  CHECK(mpm::to_string(ErrorOrigin::others) == "others");
  CHECK(mpm::to_string(ErrorOrigin::both) == "both");
}

TEST_CASE("a comparison refuses impossible input") {
  using mpm::InputError;
  const VectorXd a = white_noise(40, 9);
  CHECK_NOTHROW(compare_autocorrelations(a, a, a));
  CHECK_THROWS_AS(compare_autocorrelations(a.head(7), a.head(7), a.head(7)), InputError);
  CHECK_THROWS_AS(compare_autocorrelations(a, a.head(39), a), InputError);
  CHECK_THROWS_AS(compare_autocorrelations(a, a, a.head(39)), InputError);
  CHECK_THROWS_AS(compare_autocorrelations(a, a, a, VectorXd::Zero(39)), InputError);
  VectorXd bad = a;
  bad[2] = mpm::kNaN;
  CHECK_THROWS_AS(compare_autocorrelations(a, bad, a), InputError);
  const auto refused = [&a](auto change) {
    AcfComparisonOptions options;
    change(options);
    CHECK_THROWS_AS(compare_autocorrelations(a, a, a, std::nullopt, options), InputError);
  };
  refused([](auto& o) { o.max_lag = -1; });
  refused([](auto& o) { o.max_lag = 40; });
  refused([](auto& o) { o.decay_level = 0.0; });
  refused([](auto& o) { o.decay_level = 1.0; });
  refused([](auto& o) { o.decay_tolerance = 0.0; });
  refused([](auto& o) { o.confidence = 1.0; });
  refused([](auto& o) { o.oscillation_threshold = 1.0; });
  refused([](auto& o) { o.own_share = 0.5; });
}
