#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/findings/gate.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"

namespace {

using namespace mpm;

Finding measured(double value, double lower, double upper, std::int64_t count = 50) {
  Finding finding;
  finding.name = "x";
  return finding.with(value, {lower, upper}, count);
}

GateResult with_confidence(double minimum, double maximum, const Finding& value) {
  return judge({"x", minimum, maximum, true}, value);
}

GateResult of_value(double minimum, double maximum, const Finding& value) {
  return judge({"x", minimum, maximum, false}, value);
}

TEST_CASE("gate on a value: it passes or fails, and says by how much") {
  const Finding value = measured(0.7, 0.1, 0.9);  // the interval does not count
  CHECK(of_value(0.6, mpm::kInfinity, value).outcome == GateOutcome::pass);
  CHECK(of_value(0.6, mpm::kInfinity, value).margin == Approx(0.1));
  CHECK(of_value(0.75, mpm::kInfinity, value).outcome == GateOutcome::fail);
  CHECK(of_value(0.75, mpm::kInfinity, value).margin == Approx(-0.05));
  CHECK(of_value(-mpm::kInfinity, 0.6, value).margin == Approx(-0.1));
  CHECK(of_value(0.2, 0.8, value).margin == Approx(0.1));
  CHECK(of_value(0.7, 0.7, value).outcome == GateOutcome::pass);  // limits belong to what is allowed
}

TEST_CASE("gate with confidence: the whole interval within, the whole out, or neither") {
  const Finding value = measured(0.7, 0.6, 0.8);
  CHECK(with_confidence(0.5, mpm::kInfinity, value).outcome == GateOutcome::pass);
  CHECK(with_confidence(0.5, mpm::kInfinity, value).margin == Approx(0.1));
  CHECK(with_confidence(0.65, mpm::kInfinity, value).outcome == GateOutcome::inconclusive);
  CHECK(with_confidence(0.65, mpm::kInfinity, value).doubt == GateDoubt::straddles);
  CHECK(with_confidence(0.65, mpm::kInfinity, value).margin == Approx(-0.05));
  CHECK(with_confidence(0.9, mpm::kInfinity, value).outcome == GateOutcome::fail);
  CHECK(with_confidence(0.9, mpm::kInfinity, value).margin == Approx(-0.1));
  CHECK(with_confidence(-mpm::kInfinity, 0.5, value).outcome == GateOutcome::fail);
  CHECK(with_confidence(0.5, 0.9, value).outcome == GateOutcome::pass);
  CHECK(with_confidence(0.65, 0.75, value).outcome == GateOutcome::inconclusive);  // wider than the limits
}

TEST_CASE("gate: what is not there, is too little or has no interval shows nothing") {
  Gate gate{"x", 0.0, 1.0};
  CHECK(judge(gate, measured(kNaN, 0.0, 1.0, 0)).doubt == GateDoubt::no_value);
  CHECK(judge(gate, measured(mpm::kInfinity, kNaN, kNaN)).doubt == GateDoubt::no_value);
  gate.minimum_count = 51;
  CHECK(judge(gate, measured(0.5, 0.4, 0.6)).doubt == GateDoubt::too_few);
  gate.minimum_count = 50;
  CHECK(judge(gate, measured(0.5, kNaN, kNaN)).outcome == GateOutcome::pass);
  gate.with_confidence = true;
  const GateResult result = judge(gate, measured(0.5, kNaN, kNaN));
  CHECK(result.outcome == GateOutcome::inconclusive);
  CHECK(result.doubt == GateDoubt::no_interval);
  CHECK(std::isnan(result.margin));
}

TEST_CASE("gate: for any limits and interval, the outcome and the sign of the margin agree") {
  RandomStream stream(1, 0, StreamId::measurement_noise);
  int outcomes[3] = {0, 0, 0};
  for (int trial = 0; trial < 3000; ++trial) {
    const double low = stream.uniform(), high = low + stream.uniform();
    const double lower = 2.0 * stream.uniform() - 0.5, upper = lower + stream.uniform();
    const GateResult result = with_confidence(low, high, measured(0.5 * (lower + upper), lower, upper));
    ++outcomes[static_cast<int>(result.outcome)];
    const bool within = low <= lower && upper <= high;
    const bool out = upper < low || high < lower;
    REQUIRE((result.outcome == GateOutcome::pass) == within);
    REQUIRE((result.outcome == GateOutcome::fail) == out);
    REQUIRE((result.margin >= 0.0) == within);
    // The margin is how far the interval must move, as a whole, for the outcome to change.
    const double move = (1.0 + 1e-9) * std::abs(result.margin);
    bool changed = false;
    for (const double shift : {move, -move}) {
      const GateResult moved =
          with_confidence(low, high, measured(0.5 * (lower + upper) + shift, lower + shift, upper + shift));
      changed = changed || moved.outcome != result.outcome;
    }
    REQUIRE((changed || upper - lower > high - low));  // too wide an interval can never pass
  }
  CHECK(*std::min_element(outcomes, outcomes + 3) > 200);
}

}  // namespace
