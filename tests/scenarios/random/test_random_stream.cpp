#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/scenarios/goodness_of_fit.hpp"

namespace {

using mpm::RandomStream;
using mpm::StreamId;
using Block = std::array<std::uint32_t, 4>;

constexpr int kDraws = 100000;

/// Four standard errors: a right generator with another seed would fail once in 16000 such checks. The seeds
/// are fixed, so a check that passes once passes always.
constexpr double kSigmas = 4.0;

}  // namespace

TEST_CASE("philox gives the known answers of the Random123 distribution") {
  CHECK(mpm::philox4x32_10({0, 0, 0, 0}, {0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(mpm::philox4x32_10({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(mpm::philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("a stream lays seed, stream, experiment and position into key and counter as documented") {
  RandomStream zero(0, 0, StreamId::mismatch);
  CHECK(zero.bits() == 0xe169c58d6627e8d5U);  // the first known answer, low word first
  CHECK(zero.bits() == 0x9b00dbd8bc57ac4cU);

  RandomStream stream(0x1111222233334444U, 0x5555666677778888U, StreamId::excitation);
  stream.bits();
  stream.bits();
  const Block second = mpm::philox4x32_10({1, 4, 0x77778888, 0x55556666}, {0x33334444, 0x11112222});
  CHECK(stream.bits() == ((std::uint64_t{second[1]} << 32U) | second[0]));
  CHECK(stream.position() == 3);
}

TEST_CASE("frozen values: a study drawn today is drawn alike tomorrow") {
  RandomStream uniform(2015, 7, StreamId::mismatch);
  CHECK(uniform.uniform() == 0.4372551626599509);
  CHECK(uniform.uniform() == 0.27438236906709546);
  RandomStream normal(2015, 7, StreamId::measurement_noise);
  // The tail goes through the logarithm of the C library, which may differ in the last bits elsewhere.
  CHECK(normal.normal() == Approx(-0.23806215104728567).epsilon(1e-14));
  CHECK(normal.normal() == Approx(-0.36237986538404909).epsilon(1e-14));
  RandomStream below(2015, 7, StreamId::kind);
  CHECK(below.below(1000) == 392);
  CHECK(below.below(1000) == 773);
}

TEST_CASE("streams do not depend on the order in which they are used") {
  RandomStream a(1, 2, StreamId::mismatch);
  RandomStream b(1, 2, StreamId::disturbance_signal);
  std::vector<std::uint64_t> a_first;
  std::vector<std::uint64_t> b_second;
  for (int i = 0; i < 50; ++i) {
    a_first.push_back(a.bits());
  }
  for (int i = 0; i < 50; ++i) {
    b_second.push_back(b.bits());
  }
  RandomStream a_again(1, 2, StreamId::mismatch);
  RandomStream b_again(1, 2, StreamId::disturbance_signal);
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK(b_again.bits() == b_second[i]);
    CHECK(a_again.bits() == a_first[i]);
  }
}

TEST_CASE("seed, experiment and stream each change the whole stream") {
  const RandomStream base(1, 2, StreamId::mismatch);
  const std::vector<RandomStream> others = {
      RandomStream(2, 2, StreamId::mismatch), RandomStream(1, 3, StreamId::mismatch),
      RandomStream(1, 2, StreamId::disturbance_draw), RandomStream(1 + (1ULL << 32U), 2, StreamId::mismatch),
      RandomStream(1, 2 + (1ULL << 32U), StreamId::mismatch)};
  for (RandomStream other : others) {
    RandomStream reference = base;
    double covariance = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      covariance += (reference.uniform() - 0.5) * (other.uniform() - 0.5);
    }
    // The product of two independent centred uniform variates has the standard deviation 1/12.
    CHECK(std::abs(covariance / kDraws) < kSigmas / (12.0 * std::sqrt(kDraws)));
  }
}

TEST_CASE("every draw takes one value, so that later draws do not move") {
  RandomStream reference(5, 0, StreamId::mismatch);
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 6; ++i) {
    values.push_back(reference.bits());
  }
  RandomStream stream(5, 0, StreamId::mismatch);
  stream.normal();
  CHECK(stream.bits() == values[1]);
  stream.uniform(3.0, 4.0);
  stream.below((std::uint64_t{1} << 63U) + 1);  // repeated with probability one half, see below
  CHECK(stream.bits() == values[4]);
  CHECK(stream.bits() == values[5]);
}

TEST_CASE("uniform draws: range, moments and distribution") {
  RandomStream stream(11, 0, StreamId::mismatch);
  std::vector<double> sample;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    sample.push_back(stream.uniform());
    sum += sample.back();
    squares += sample.back() * sample.back();
    REQUIRE((sample.back() >= 0.0 && sample.back() < 1.0));
  }
  CHECK(std::abs(sum / kDraws - 0.5) < kSigmas * std::sqrt(1.0 / 12.0 / kDraws));
  // var(u^2) = 1/5 - 1/9
  CHECK(std::abs(squares / kDraws - 1.0 / 3.0) < kSigmas * std::sqrt(4.0 / 45.0 / kDraws));
  CHECK(mpm::testing::kolmogorov_distance(sample, [](double x) { return x; }) <
        mpm::testing::kolmogorov_critical(sample.size()));
}

TEST_CASE("uniform draws carry 53 bits and scale to any range") {
  RandomStream a(3, 1, StreamId::audit);
  RandomStream b(3, 1, StreamId::audit);
  bool last_bit_seen = false;
  for (int i = 0; i < 200; ++i) {
    const double u = a.uniform();
    last_bit_seen = last_bit_seen || std::fmod(u * 0x1p53, 2.0) == 1.0;
    CHECK(u * 0x1p53 == std::floor(u * 0x1p53));
    CHECK(b.uniform(-2.0, 6.0) == -2.0 + 8.0 * u);
  }
  CHECK(last_bit_seen);
  CHECK(a.uniform(1.5, 1.5) == 1.5);
}

TEST_CASE("normal draws: the first four moments and the distribution") {
  RandomStream stream(12, 0, StreamId::measurement_noise);
  std::vector<double> sample;
  std::array<double, 4> moments{};
  for (int i = 0; i < kDraws; ++i) {
    const double z = stream.normal();
    sample.push_back(z);
    moments[0] += z / kDraws;
    moments[1] += z * z / kDraws;
    moments[2] += z * z * z / kDraws;
    moments[3] += z * z * z * z / kDraws;
  }
  // The variance of z^k is E z^2k - (E z^k)^2: 1, 3 - 1, 15, 105 - 9.
  const std::array<double, 4> expected = {0.0, 1.0, 0.0, 3.0};
  const std::array<double, 4> variances = {1.0, 2.0, 15.0, 96.0};
  for (std::size_t k = 0; k < 4; ++k) {
    INFO("moment " << k + 1);
    CHECK(std::abs(moments[k] - expected[k]) < kSigmas * std::sqrt(variances[k] / kDraws));
  }
  const auto phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  CHECK(mpm::testing::kolmogorov_distance(sample, phi) < mpm::testing::kolmogorov_critical(sample.size()));
}

TEST_CASE("a normal draw is the inverse of the distribution function at the uniform draw") {
  RandomStream normal(13, 0, StreamId::mismatch);
  RandomStream uniform(13, 0, StreamId::mismatch);
  for (int i = 0; i < 5000; ++i) {
    const double z = normal.normal();
    const double u = uniform.uniform();
    const double p = u < 0.5 ? u + 0x1p-54 : (1.0 - u) - 0x1p-54;  // 1 - u is exact
    // Compared in the tail that z lies in, where erfc loses nothing. A relative error of 4 units in the last
    // place of z changes the tail by z^2 times as much; |z| < 4.5 in 5000 draws.
    const double tail = 0.5 * std::erfc(std::abs(z) / std::sqrt(2.0));
    CHECK(tail == Approx(p).epsilon(1e-13));
    CHECK((z < 0.0) == (u < 0.5));
  }
}

TEST_CASE("draws below n are even: chi-square at the level 0.001") {
  // Critical values of the chi-square distribution with n - 1 degrees of freedom.
  for (const auto& [n, critical] : {std::pair{2, 10.83}, std::pair{7, 22.46}, std::pair{10, 27.88}}) {
    RandomStream stream(14, static_cast<std::uint64_t>(n), StreamId::bootstrap);
    std::vector<int> counts(static_cast<std::size_t>(n), 0);
    for (int i = 0; i < kDraws; ++i) {
      ++counts.at(stream.below(static_cast<std::uint64_t>(n)));
    }
    const double expected = static_cast<double>(kDraws) / n;
    double chi_square = 0.0;
    for (const int count : counts) {
      chi_square += (count - expected) * (count - expected) / expected;
    }
    CHECK(chi_square < critical);
  }
}

TEST_CASE("draws below n have no bias where plain multiplication has one of a third") {
  // With n = 3 * 2^62 the product alone gives every third result twice the weight of the others.
  constexpr std::uint64_t kN = 3ULL << 62U;
  RandomStream stream(15, 0, StreamId::bootstrap);
  std::array<int, 3> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const std::uint64_t value = stream.below(kN);
    REQUIRE(value < kN);
    ++counts[value % 3];
  }
  for (const int count : counts) {
    CHECK(std::abs(count - kDraws / 3.0) < kSigmas * std::sqrt(kDraws * 2.0 / 9.0));
  }
  CHECK(stream.position() == kDraws);
}

TEST_CASE("draws below 1 are 0") {
  CHECK(RandomStream(1, 1, StreamId::kind).below(1) == 0);
}

TEST_CASE("a stream refuses impossible draws") {
  RandomStream stream(1, 1, StreamId::kind);
  const double infinity = mpm::kInfinity;
  const double nan = mpm::kNaN;
  CHECK_THROWS_AS(stream.below(0), mpm::InputError);
  CHECK_THROWS_AS(stream.uniform(1.0, 0.0), mpm::InputError);
  CHECK_THROWS_AS(stream.uniform(0.0, infinity), mpm::InputError);
  CHECK_THROWS_AS(stream.uniform(nan, 1.0), mpm::InputError);
  CHECK_THROWS_AS(stream.uniform(-1e308, 1e308), mpm::InputError);
  CHECK(stream.position() == 0);
}
