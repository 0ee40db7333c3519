#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/methods/ours/channel_fit.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "base/error.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr double kTs = 2.0;
constexpr Eigen::Index kFitted = 300;

TransferFunction modelled_channel() {
  return TransferFunction::first_order(1.5, 40.0, 10.0);
}

/// An MV that moves at random every 10 samples.
Eigen::VectorXd moving_mv(RandomStream& stream) {
  Eigen::VectorXd u(kFitted);
  for (Eigen::Index k = 0; k < kFitted; ++k)
    u(k) = k % 10 == 0 ? 3.0 + stream.normal() : u(k - 1);
  return u;
}

Eigen::VectorXd response_of(const TransferFunction& channel, const Eigen::VectorXd& u) {
  return simulated_output(TransferMatrix{{channel}}, kTs, Eigen::VectorXd::Constant(1, 3.0), u.transpose(),
                          Eigen::MatrixXd(0, kFitted))
      .row(0);
}

/// The error of the model where the plant has another channel, and noise n(k) = colour n(k - 1) + w(k).
Eigen::VectorXd error_of(const TransferFunction& plant, const Eigen::VectorXd& u, double noise, double colour,
                         RandomStream& stream) {
  Eigen::VectorXd e = response_of(plant, u) - response_of(modelled_channel(), u);
  double n = 0.0;
  for (Eigen::Index k = 0; k < kFitted; ++k) {
    n = colour * n + noise * stream.normal();
    e(k) += n;
  }
  return e;
}

}  // namespace

TEST_CASE("channel fit: without noise it finds the channel, in each parameter alone and in all at once") {
  RandomStream stream(5, 0, StreamId::measurement_noise);
  const Eigen::VectorXd u = moving_mv(stream);
  struct Truth {
    double gain, time, shift;
  };
  for (const Truth& truth : {Truth{0.5, 1, 0}, Truth{1, 2.2, 0}, Truth{1, 1, 7.0}, Truth{1, 1, -6.0},
                             Truth{1.4, 0.6, 3.0}, Truth{-1, 1, 0}}) {
    const TransferFunction plant = modelled_channel()
                                       .with_gain_scaled(truth.gain)
                                       .with_time_scaled(truth.time)
                                       .with_dead_time_shifted(truth.shift);
    const Eigen::VectorXd e = error_of(plant, u, 1e-6, 0.0, stream);
    const ChannelFit fit = fit_channel(modelled_channel(), kTs, e, u, 3.0, 0.95);
    INFO(truth.gain << " " << truth.time << " " << truth.shift);
    CHECK(fit.gain_factor.value == Approx(truth.gain).epsilon(2e-3));
    CHECK(fit.time_factor.value == Approx(truth.time).epsilon(1e-2));
    CHECK(fit.dead_time_shift.value == Approx(truth.shift).margin(0.1));
    CHECK(fit.explained > 0.999);
    const Eigen::VectorXd left = response_of(plant, u) - response_of(fit.channel, u);
    CHECK(left.norm() < 5e-3 * response_of(plant, u).norm());
  }
}

TEST_CASE("channel fit: its intervals hold the truth as often as they say, in white and in coloured noise") {
  constexpr int kLoops = 40;
  for (const double colour : {0.0, 0.9}) {
    int gain = 0, time = 0, shift = 0;
    for (int loop = 0; loop < kLoops; ++loop) {
      RandomStream stream(6, loop, StreamId::measurement_noise);
      const Eigen::VectorXd u = moving_mv(stream);
      const TransferFunction plant = modelled_channel().with_gain_scaled(0.7).with_dead_time_shifted(4.0);
      const Eigen::VectorXd e = error_of(plant, u, 0.1, colour, stream);
      const ChannelFit fit = fit_channel(modelled_channel(), kTs, e, u, 3.0, 0.9);
      const auto holds = [](const FittedNumber& number, double truth) {
        return number.lower <= truth && truth <= number.upper ? 1 : 0;
      };
      gain += holds(fit.gain_factor, 0.7);
      time += holds(fit.time_factor, 1.0);
      shift += holds(fit.dead_time_shift, 4.0);
    }
    INFO("colour " << colour << ": " << gain << " " << time << " " << shift << " of " << kLoops);
    // P(B(40, 0.9) < 29) = 0.0004; the order of the noise is estimated, too.
    CHECK((gain >= 29 && time >= 29 && shift >= 29));
  }
}

TEST_CASE("channel fit: samples that are missing are left out") {
  RandomStream stream(7, 0, StreamId::measurement_noise);
  const Eigen::VectorXd u = moving_mv(stream);
  Eigen::VectorXd e = error_of(modelled_channel().with_gain_scaled(0.5), u, 0.01, 0.0, stream);
  for (Eigen::Index k = 20; k < kFitted; k += 17)
    e(k) = std::nan("");
  CHECK(fit_channel(modelled_channel(), kTs, e, u, 3.0, 0.95).gain_factor.value == Approx(0.5).epsilon(0.02));
}

TEST_CASE("channel fit: an MV at rest and a channel that is zero are refused") {
  const Eigen::VectorXd still = Eigen::VectorXd::Constant(kFitted, 3.0);
  const Eigen::VectorXd e = Eigen::VectorXd::LinSpaced(kFitted, 0.0, 1.0);
  CHECK_THROWS_AS(fit_channel(modelled_channel(), kTs, e, still, 3.0, 0.95), InputError);
  CHECK_THROWS_AS(fit_channel(TransferFunction::zero(), kTs, e, e, 3.0, 0.95), InputError);
}

TEST_CASE("channel fit: where one parameter is wrong the others keep to the model, however alike they act") {
  RandomStream stream(9, 0, StreamId::measurement_noise);
  Eigen::VectorXd sine(kFitted);
  for (Eigen::Index k = 0; k < kFitted; ++k)
    sine(k) = 3.0 + std::sin(0.3 * static_cast<double>(k));
  // One sine has an amplitude and a phase: gain and dead time together make any of them.
  const Eigen::VectorXd e =
      error_of(modelled_channel().with_dead_time_shifted(2.0), sine, 0.005, 0.0, stream);
  const ChannelFit fit =
      fit_channel(modelled_channel(), kTs, e, sine, 3.0, 0.95, MismatchParameter::dead_time);
  CHECK(fit.gain_factor.value == 1.0);
  CHECK(fit.gain_factor.lower == 1.0);
  CHECK(fit.time_factor.value == 1.0);
  CHECK(fit.time_factor.upper == 1.0);
  CHECK(fit.dead_time_shift.value == Approx(2.0).margin(0.3));  // some ten standard deviations
  CHECK(fit.dead_time_shift.bound == SizeBound::none);
}

TEST_CASE("channel fit: a value at the end of its search is a bound") {
  RandomStream stream(9, 1, StreamId::measurement_noise);
  const Eigen::VectorXd u = moving_mv(stream);
  const auto fitted = [&](const TransferFunction& plant) {
    return fit_channel(modelled_channel(), kTs, error_of(plant, u, 1e-3, 0.0, stream), u, 3.0, 0.95);
  };
  CHECK(fitted(modelled_channel().with_time_scaled(30.0)).time_factor.bound == SizeBound::at_least);
  CHECK(fitted(modelled_channel().with_time_scaled(2.0)).time_factor.bound == SizeBound::none);
  // No dead time can be shorter than none.
  CHECK(fitted(modelled_channel().with_dead_time_shifted(-10.0)).dead_time_shift.bound == SizeBound::none);
}

TEST_CASE("channel fit: what other channels may have wrong is in its interval") {
  constexpr int kLoops = 40;
  constexpr double kError = 0.1;
  const TransferFunction other = TransferFunction::first_order(2.0, 25.0, 4.0);
  int beside = 0, alone = 0;
  for (int loop = 0; loop < kLoops; ++loop) {
    RandomStream stream(10, loop, StreamId::measurement_noise);
    const Eigen::VectorXd u = moving_mv(stream),
                          v = u + 0.3 * moving_mv(stream);  // one controller moves both
    const Eigen::VectorXd response = response_of(other, v);
    const Eigen::VectorXd e = error_of(modelled_channel().with_gain_scaled(0.7), u, 0.02, 0.0, stream) +
                              kError * stream.normal() * response;
    const auto holds = [&](const FitSurroundings& known) {
      const FittedNumber gain =
          fit_channel(modelled_channel(), kTs, e, u, 3.0, 0.9, MismatchParameter::gain, known).gain_factor;
      return gain.lower <= 0.7 && 0.7 <= gain.upper ? 1 : 0;
    };
    beside += holds({.unknown = kError * response.transpose()});
    alone += holds({});
  }
  INFO(beside << " and " << alone << " of " << kLoops);
  CHECK(beside >= 31);  // P(B(40, 0.9) < 31) = 0.005
  CHECK(alone < 31);
}

TEST_CASE("channel fit: a channel that goes over within the record has the size that it has in the end") {
  constexpr int kLoops = 30;
  constexpr Eigen::Index kBegins = 120, kGrows = 60;
  int held = 0, throughout = 0;
  for (int loop = 0; loop < kLoops; ++loop) {
    RandomStream stream(11, loop, StreamId::measurement_noise);
    const Eigen::VectorXd u = moving_mv(stream);
    Eigen::VectorXd e = error_of(modelled_channel().with_time_scaled(2.0), u, 0.0, 0.0, stream);
    const bool begins = loop % 2 == 0;
    for (Eigen::Index k = 0; k < kFitted; ++k)
      e(k) = (begins ? std::clamp(static_cast<double>(k - kBegins) / kGrows, 0.0, 1.0) : 1.0) * e(k) +
             0.1 * stream.normal();
    const auto fitted = [&](const FitSurroundings& known) {
      return fit_channel(modelled_channel(), kTs, e, u, 3.0, 0.9, MismatchParameter::time_constant, known)
          .time_factor;
    };
    const FittedNumber anywhere =
        fitted({.onset = FitSurroundings::Onset{0, kFitted - kFitted / 5, kFitted / 3}});
    held += anywhere.lower <= 2.0 && 2.0 <= anywhere.upper ? 1 : 0;
    if (begins)
      throughout += fitted({}).upper < 2.0 ? 1 : 0;
  }
  INFO(held << " and " << throughout << " of " << kLoops);
  CHECK(held >= 22);                // P(B(30, 0.9) < 22) = 0.002
  CHECK(throughout == kLoops / 2);  // who takes it for all of the record finds less
}

}  // namespace mpm
