#include "plants/linear/zero_order_hold.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "base/error.hpp"

namespace mpm {
namespace {

/// x' = A x + B u, y = C x + D u: the rational part of a channel.
struct Realisation {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;
  Eigen::RowVectorXd C;
  double D;
};

/// The geometric mean of the poles other than 0, as a power of two (scaling by it is exact); `a` is monic.
double typical_rate(const Eigen::VectorXd& a) {
  Eigen::Index last = a.size() - 1;
  while (a(last) == 0) {
    --last;
  }
  if (last == 0) {
    return 1;  // no such pole
  }
  return std::exp2(std::round(std::log2(std::abs(a(last))) / static_cast<double>(last)));
}

/// The controllable companion form of G(w p) with time counted in 1/w, where w is the typical rate. In s
/// itself the entries of A would range over powers of the poles, and the exponential would lose most digits
/// for several poles of 1e-4 or 1e4.
Realisation companion_form(const TransferFunction& channel) {
  const Eigen::Index n = channel.order();
  Eigen::VectorXd a = channel.denominator() / channel.denominator()(0);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 1);
  b.tail(channel.numerator().size()) = channel.numerator() / channel.denominator()(0);
  const double rate = typical_rate(a);
  for (Eigen::Index i = 1; i <= n; ++i) {
    a.tail(n + 1 - i) /= rate;
    b.tail(n + 1 - i) /= rate;
  }

  Realisation form{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::RowVectorXd::Zero(n), b(0)};
  if (n > 0) {
    form.A.row(0) = -rate * a.tail(n).transpose();
    form.A.diagonal(-1).setConstant(rate);
    form.B(0) = rate;
    form.C = (b - b(0) * a).tail(n).transpose();
  }
  return form;
}

/// e^{A t} and int_0^t e^{A s} ds B.
struct Hold {
  Eigen::MatrixXd transition;
  Eigen::VectorXd input;
};

Hold hold(const Realisation& form, double duration) {
  const Eigen::Index n = form.A.rows();
  Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(n + 1, n + 1);
  augmented.topLeftCorner(n, n) = form.A * duration;
  augmented.topRightCorner(n, 1) = form.B * duration;
  const Eigen::MatrixXd exponential = augmented.exp();
  return {exponential.topLeftCorner(n, n), exponential.topRightCorner(n, 1)};
}

/// Adds the integral q of the output, q' = C x + D u, as last state, which becomes the output.
Realisation with_integral(const Realisation& form) {
  const Eigen::Index n = form.A.rows();
  Realisation longer{Eigen::MatrixXd::Zero(n + 1, n + 1), Eigen::VectorXd(n + 1),
                     Eigen::RowVectorXd::Unit(n + 1, n), 0.0};
  longer.A.topLeftCorner(n, n) = form.A;
  longer.A.bottomLeftCorner(1, n) = form.C;
  longer.B << form.B, form.D;
  return longer;
}

/// Turns the last state, the integral of the output, into the mean of the output over one sample.
void take_means(DiscreteChannel& channel, double sample_time) {
  const Eigen::Index last = channel.A.rows() - 1;
  channel.A.col(last).setZero();
  channel.A.row(last) /= sample_time;
  channel.b_now(last) /= sample_time;
  channel.b_previous(last) /= sample_time;
}

/// theta = delay Ts + eps, 0 <= eps < Ts.
struct Delay {
  int samples;
  double remainder;
};

Delay split_dead_time(double dead_time, double sample_time) {
  constexpr double kRelativeRounding = 1e-9;
  const double ratio = dead_time / sample_time;
  if (!(ratio <= kMaxDelay)) {
    throw InputError("dead time in samples", fmt::format("{}", ratio), fmt::format("at most {}", kMaxDelay));
  }
  const double nearest = std::round(ratio);
  if (std::abs(ratio - nearest) <= kRelativeRounding * std::max(1.0, ratio)) {
    return {static_cast<int>(nearest), 0};
  }
  const double whole = std::floor(ratio);
  return {static_cast<int>(whole), (ratio - whole) * sample_time};
}

}  // namespace

namespace {

/// A channel split into K / s and the rest; K = 0 if the channel does not integrate.
struct IntegratorApart {
  double rate_gain;
  TransferFunction rest;
};

IntegratorApart integrator_apart(const TransferFunction& channel) {
  if (!channel.is_integrating())
    return {0.0, channel};
  const double K = channel.rate_gain();
  const Eigen::VectorXd denominator = channel.denominator().head(channel.order());  // over s
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(channel.order() + 1);          // N(s) - K D(s) / s
  difference.tail(channel.numerator().size()) = channel.numerator();
  difference.tail(denominator.size()) -= K * denominator;
  return {K, {difference.head(channel.order()), denominator, channel.dead_time()}};
}

/// The channel behind the filter of its samples y(k), f(k) = y(k) - w(k), w(k+1) = a w(k) + (1 - a) y(k).
/// With the integrator's state I split off, q = I - w replaces both I and w:
///
///   q(k+1) = a q(k) + K (integral of u over the sample) - (1 - a) y_rest(k),    f(k) = q(k) + y_rest(k).
DiscreteChannel behind_washout(const TransferFunction& channel, double sample_time) {
  const auto [K, rest] = integrator_apart(channel.without_washout());
  const double a = std::exp(-sample_time / channel.washout());
  const DiscreteChannel inner = discretise(rest, sample_time);
  const Delay delay = split_dead_time(channel.dead_time(), sample_time);
  const Eigen::Index n = inner.A.rows();
  DiscreteChannel result{.A = Eigen::MatrixXd::Zero(n + 1, n + 1),
                         .b_now = Eigen::VectorXd(n + 1),
                         .b_previous = Eigen::VectorXd(n + 1),
                         .c = Eigen::RowVectorXd(n + 1),
                         .d = inner.d,
                         .delay = delay.samples};
  result.A(0, 0) = a;
  result.A.topRightCorner(1, n) = -(1.0 - a) * inner.c;
  result.A.bottomRightCorner(n, n) = inner.A;
  result.b_now << K * (sample_time - delay.remainder), inner.b_now;
  result.b_previous << K * delay.remainder - (1.0 - a) * inner.d, inner.b_previous;
  result.c << 1.0, inner.c;
  return result;
}

/// The response F behind the washout is F_i = a F_(i-1) + S_i - S_(i-1). After the last coefficient m it
/// becomes F_(i+1) = a F_i + Ts rate: what is then added to F_m is the step response of a first-order channel
/// with m samples of dead time. Without a washout a = 1.
DiscreteChannel of_coefficients(const StepCoefficients& S, double sample_time, double washout,
                                OutputSampling sampling) {
  if (!(S.end() / sample_time <= kMaxDelay))
    throw InputError("coefficients of a step response in samples", fmt::format("{}", S.end() / sample_time),
                     fmt::format("at most {}", kMaxDelay));
  DiscreteChannel result;
  result.step = sampling == OutputSampling::average ? S.averaged(sample_time) : S.sampled(sample_time);
  const double rise = sample_time * S.rate();
  const double a = washout > 0 ? std::exp(-sample_time / washout) : 1.0;
  if (washout > 0) {
    double F = 0.0, before = 0.0;
    for (double& value : result.step) {
      F = a * F + value - before;
      before = std::exchange(value, F);
    }
  }
  const double added = washout > 0 ? rise - (1.0 - a) * result.step(result.step.size() - 1) : rise;
  const Eigen::Index n = washout > 0 || S.ramps() ? 1 : 0;
  result.A.setConstant(n, n, a);
  result.b_now.setConstant(n, added);
  result.b_previous.setZero(n);
  result.c.setOnes(n);
  result.delay = n > 0 ? static_cast<int>(result.step.size()) : 0;
  return result;
}

}  // namespace

void require_sample_time(double sample_time) {
  if (!std::isfinite(sample_time) || sample_time <= 0) {
    throw InputError("sample time", fmt::format("{}", sample_time), "a finite number > 0");
  }
}

DiscreteChannel discretise(const TransferFunction& channel, double sample_time, OutputSampling sampling) {
  require_sample_time(sample_time);
  const bool averages = sampling == OutputSampling::average;
  if (averages && channel.washout() > 0)
    throw InputError("averages of an output", "a washout, which filters samples", "a channel without one");
  if (const auto& S = channel.step_coefficients())
    return of_coefficients(*S, sample_time, channel.washout(), sampling);
  if (channel.washout() > 0)
    return behind_washout(channel, sample_time);
  const Delay delay = split_dead_time(channel.dead_time(), sample_time);
  const Realisation own = companion_form(channel);
  const Realisation form = averages ? with_integral(own) : own;

  const Hold newer = hold(form, sample_time - delay.remainder);
  DiscreteChannel result{newer.transition, newer.input, Eigen::VectorXd::Zero(form.A.rows()),
                         form.C,           form.D,      delay.samples};
  if (delay.remainder > 0) {
    const Hold older = hold(form, delay.remainder);
    result.b_previous = newer.transition * older.input;
    result.A = newer.transition * older.transition;
  }
  if (averages)
    take_means(result, sample_time);
  if (!result.A.allFinite() || !result.b_now.allFinite() || !result.b_previous.allFinite()) {
    throw InputError("zero-order-hold equivalent", fmt::format("overflow at sample time {}", sample_time),
                     "poles and sample times whose exponential is finite");
  }
  return result;
}

}  // namespace mpm
