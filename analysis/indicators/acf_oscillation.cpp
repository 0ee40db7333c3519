#include "analysis/indicators/acf_oscillation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// A point of the autocorrelation function.
struct Turn {
  Eigen::Index lag = 0;
  double value = 0.0;
};

constexpr Eigen::Index kLongestHalfPeriod = 2;  // in multiples of the shortest

/// The first three turning points after lag 0, where the function starts from its maximum 1.
struct Turns {
  Turn minimum, maximum, second_minimum;

  bool regular() const {
    const auto [shortest, longest] =
        std::minmax({minimum.lag, maximum.lag - minimum.lag, second_minimum.lag - maximum.lag});
    return longest <= kLongestHalfPeriod * shortest;
  }
};

/// Returns the next turning point after `from`: the lowest point (for sign = 1; the highest for -1) from
/// which the function then goes back by more than `ripple`. None if the function ends before that.
std::optional<Turn> next_turn(const Eigen::VectorXd& r, Turn from, double sign, double ripple) {
  Turn turn = from;
  for (Eigen::Index lag = from.lag + 1; lag < r.size(); ++lag) {
    const double step = sign * (r[lag] - turn.value);
    if (step < 0.0) {
      turn = {lag, r[lag]};
    } else if (step > ripple) {
      return turn;
    }
  }
  return std::nullopt;
}

std::optional<Turns> first_turns(const Autocorrelation& acf) {
  const auto minimum = next_turn(acf.values, {0, 1.0}, 1.0, acf.white_band);
  if (!minimum) {
    return std::nullopt;
  }
  const auto maximum = next_turn(acf.values, *minimum, -1.0, acf.white_band);
  if (!maximum) {
    return std::nullopt;
  }
  const auto second_minimum = next_turn(acf.values, *maximum, 1.0, acf.white_band);
  if (!second_minimum) {
    return std::nullopt;
  }
  return Turns{*minimum, *maximum, *second_minimum};
}

/// Returns the value at `lag` of the line through two points.
double line_at(Turn from, Turn to, Eigen::Index lag) {
  const double share = static_cast<double>(lag - from.lag) / static_cast<double>(to.lag - from.lag);
  return from.value + share * (to.value - from.value);
}

}  // namespace

AcfOscillation acf_oscillation(const Autocorrelation& acf, double threshold) {
  if (!(threshold > 0.0 && threshold < 1.0)) {
    throw InputError("threshold of the decay ratio", fmt::format("{}", threshold), "above 0 and below 1");
  }
  AcfOscillation result;
  if (acf.values.size() == 0 || std::isnan(acf.values[0])) {
    return result;
  }
  result.verdict = Oscillation::absent;
  const auto turns = first_turns(acf);
  if (!turns) {
    return result;
  }
  const double a = turns->maximum.value - line_at(turns->minimum, turns->second_minimum, turns->maximum.lag);
  const double b = line_at({0, 1.0}, turns->maximum, turns->minimum.lag) - turns->minimum.value;
  result.decay_ratio = a / b;
  result.period = static_cast<double>(turns->second_minimum.lag - turns->minimum.lag);
  if (result.decay_ratio >= threshold && turns->regular() && a > acf.bartlett_band[turns->maximum.lag]) {
    result.verdict = Oscillation::present;
  }
  return result;
}

}  // namespace mpm
