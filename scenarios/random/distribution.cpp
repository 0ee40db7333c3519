#include "scenarios/random/distribution.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {

Distribution Distribution::constant(double value) {
  if (!std::isfinite(value)) {
    throw InputError("value of a constant", fmt::format("{}", value), "a finite number");
  }
  return {Kind::constant, value, value};
}

Distribution Distribution::uniform(double low, double high) {
  if (!(low < high) || !std::isfinite(high - low)) {
    throw InputError("ends of a uniform distribution", fmt::format("[{}, {})", low, high),
                     "low < high, both finite");
  }
  return {Kind::uniform, low, high};
}

Distribution Distribution::log_uniform(double low, double high) {
  if (!(low > 0.0) || !(low < high) || !std::isfinite(high)) {
    throw InputError("ends of a log-uniform distribution", fmt::format("[{}, {}]", low, high),
                     "0 < low < high, both finite");
  }
  return {Kind::log_uniform, low, high};
}

Distribution Distribution::normal(double mean, double standard_deviation) {
  if (!std::isfinite(mean)) {
    throw InputError("mean of a normal distribution", fmt::format("{}", mean), "a finite number");
  }
  if (!(standard_deviation > 0.0) || !std::isfinite(standard_deviation)) {
    throw InputError("standard deviation of a normal distribution", fmt::format("{}", standard_deviation),
                     "a finite number above 0");
  }
  return {Kind::normal, mean, standard_deviation};
}

double Distribution::sample(RandomStream& stream) const {
  switch (kind_) {
    case Kind::constant:
      stream.bits();
      return a_;
    case Kind::uniform:
      return stream.uniform(a_, b_);
    case Kind::log_uniform: {
      const double log_low = std::log(a_);
      // The exponential of a logarithm can miss the ends by a rounding error.
      return std::clamp(std::exp(log_low + stream.uniform() * (std::log(b_) - log_low)), a_, b_);
    }
    case Kind::normal:
      return a_ + b_ * stream.normal();
  }
  assert(false);
  return kNaN;
}

double Distribution::minimum() const {
  return kind_ == Kind::normal ? -kInfinity : a_;
}

double Distribution::maximum() const {
  return kind_ == Kind::normal ? kInfinity : b_;
}

}  // namespace mpm
