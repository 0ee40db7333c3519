#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/statistics/signal_look.hpp"
#include "scenarios/random/random_stream.hpp"

namespace {

using mpm::SignalLook;

TEST_CASE("the noise of a signal is that of its second differences, whatever moves slowly") {
  constexpr std::size_t kCount = 20000;
  mpm::RandomStream stream(1, 2, mpm::StreamId::measurement_noise);
  std::vector<double> values, held;
  for (std::size_t k = 0; k < kCount; ++k)
    values.push_back(1e-4 * static_cast<double>(k * k) / kCount + 0.3 * stream.normal());
  CHECK(SignalLook(values).noise() == Approx(0.3).epsilon(0.03));  // of 20000 values: 0.7 %
  for (std::size_t k = 0; k < kCount; ++k)
    held.push_back(values[k - k % 10]);
  CHECK(SignalLook(held).noise() == Approx(0.3).epsilon(0.1));
  CHECK(SignalLook(held).period() == std::optional<std::size_t>(10));
  CHECK(SignalLook(values).period() == std::nullopt);
  CHECK(SignalLook(held).changes == Approx(0.1).margin(1e-3));
}

TEST_CASE("a look at few values, or at none, has no noise and no period") {
  for (const std::vector<double>& values : {std::vector<double>{}, {4.0}, {4.0, 5.0}}) {
    const SignalLook look(values);
    CHECK(look.noise() == 0.0);
    CHECK(look.period() == std::nullopt);
    CHECK(std::isfinite(look.mean));
  }
}

}  // namespace
