#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/least_effect.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {

TEST_CASE("the least effect is where the share that is found reaches the power", "[least_effect]") {
  std::vector<EffectTrial> trials;
  for (int i = 1; i <= 100; ++i)
    trials.push_back({0.01 * i, i > 30, i % 8});
  const Estimate sharp = least_effect(trials, 0.8, 0.95, 1);
  CHECK(sharp.value == Approx(0.31));
  CHECK((sharp.count == 100 && sharp.interval.lower >= 0.3 && sharp.interval.upper <= 0.35));
  for (EffectTrial& trial : trials)
    trial.found = false;
  CHECK(std::isinf(least_effect(trials, 0.8, 0.95, 1).value));
  CHECK(std::isnan(least_effect({}, 0.8, 0.95, 1).value));
}

TEST_CASE("the interval of the least effect holds it in most draws of loops", "[least_effect]") {
  // Found with the probability of the effect itself, so that 80 % are found from 0.8 on.
  RandomStream stream(11, 0, StreamId::bootstrap);
  int held = 0;
  for (int draw = 0; draw < 100; ++draw) {
    std::vector<EffectTrial> trials;
    for (int i = 0; i < 400; ++i) {
      const double effect = stream.uniform();
      trials.push_back({effect, stream.uniform() < effect, i % 40});
    }
    held += least_effect(trials, 0.8, 0.95, static_cast<std::uint64_t>(draw)).interval.contains(0.8) ? 1 : 0;
  }
  INFO(held);
  CHECK(held >= 75);  // 85 of 100 in long runs: an isotonic fit has no smooth bootstrap
}

}  // namespace mpm
