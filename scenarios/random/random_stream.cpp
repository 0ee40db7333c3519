#include "scenarios/random/random_stream.hpp"

#include <cassert>
#include <cmath>
#include <limits>

#include <Random123/philox.h>
#include <boost/math/special_functions/erf.hpp>
#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

[[maybe_unused]] constexpr std::uint64_t kValuesPerStream = std::uint64_t{1} << 33;
constexpr std::uint32_t kRepetitionShift = 16;
[[maybe_unused]] constexpr std::uint32_t kRepetitions = 1U << 16;
constexpr double kTwoToMinus53 = 0x1p-53;
constexpr double kSqrt2 = 1.4142135623730951;

constexpr std::uint32_t low_half(std::uint64_t value) {
  return static_cast<std::uint32_t>(value);
}
constexpr std::uint32_t high_half(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32U);
}
constexpr std::uint64_t join(std::uint32_t low, std::uint32_t high) {
  return (std::uint64_t{high} << 32U) | low;
}

struct Product {
  std::uint64_t high;
  std::uint64_t low;
};

Product multiply(std::uint64_t a, std::uint64_t b) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return {static_cast<std::uint64_t>(product >> 64U), static_cast<std::uint64_t>(product)};
}

/// Phi^-1(p) for 0 < p <= 1/2. Plain double arithmetic: Boost would otherwise go through `long double`, which
/// is slower and gives other results on other processors.
double lower_normal_quantile(double p) {
  using namespace boost::math::policies;
  return -kSqrt2 * boost::math::erfc_inv(2.0 * p, policy<promote_double<false>>());
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32_10(const std::array<std::uint32_t, 4>& counter,
                                           const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32::ctr_type words = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type key_words = {{key[0], key[1]}};
  const auto block = r123::Philox4x32()(words, key_words);
  return {block[0], block[1], block[2], block[3]};
}

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t experiment, StreamId stream)
    : key_{low_half(seed), high_half(seed)},
      stream_(static_cast<std::uint32_t>(stream)),
      experiment_{low_half(experiment), high_half(experiment)} {
  assert(stream_ < (1U << kRepetitionShift));
}

std::uint64_t RandomStream::value_at(std::uint64_t position, std::uint32_t repetition) {
  assert(position < kValuesPerStream && repetition < kRepetitions);
  const bool second = position % 2 == 1;
  const auto make_block = [&] {
    return philox4x32_10(
        {low_half(position / 2), stream_ | (repetition << kRepetitionShift), experiment_[0], experiment_[1]},
        key_);
  };
  if (repetition > 0) {
    const auto block = make_block();
    return second ? join(block[2], block[3]) : join(block[0], block[1]);
  }
  if (!second) {
    block_ = make_block();
    return join(block_[0], block_[1]);
  }
  return join(block_[2], block_[3]);  // positions are drawn in order, so the block is at hand
}

std::uint64_t RandomStream::bits() {
  return value_at(position_++, 0);
}

double RandomStream::uniform() {
  return static_cast<double>(bits() >> 11U) * kTwoToMinus53;
}

double RandomStream::uniform(double low, double high) {
  if (!(low <= high) || !std::isfinite(high - low)) {
    throw InputError("range of a uniform draw", fmt::format("[{}, {})", low, high),
                     "low <= high, both finite, with a finite difference");
  }
  return low + (high - low) * uniform();
}

std::uint64_t RandomStream::below(std::uint64_t n) {
  if (n == 0) {
    throw InputError("number of cases of a draw", "0", "1 or more");
  }
  const std::uint64_t position = position_;
  Product product = multiply(bits(), n);
  // In general n does not divide 2^64: the lowest (2^64 mod n) values of the lower half are surplus.
  const std::uint64_t surplus = (std::numeric_limits<std::uint64_t>::max() - n + 1) % n;
  for (std::uint32_t repetition = 1; product.low < surplus; ++repetition) {
    product = multiply(value_at(position, repetition), n);
  }
  return product.high;
}

double RandomStream::normal() {
  constexpr std::uint64_t kHalf = std::uint64_t{1} << 52U;
  const std::uint64_t k = bits() >> 11U;
  // The midpoint is never 0 or 1. The upper half uses the mirror image of k, which is exact; 1 - p is not.
  const bool upper = k >= kHalf;
  const std::uint64_t mirrored = upper ? 2 * kHalf - 1 - k : k;
  const double quantile = lower_normal_quantile((static_cast<double>(mirrored) + 0.5) * kTwoToMinus53);
  return upper ? -quantile : quantile;
}

}  // namespace mpm
