#include "plants/linear/transfer_function.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/same_members.hpp"

namespace mpm {
namespace {

void require_finite_polynomial(const char* quantity, const Eigen::VectorXd& coefficients) {
  if (coefficients.size() == 0) {
    throw InputError(quantity, "no coefficients", "one or more");
  }
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    if (!std::isfinite(coefficients(i))) {
      throw InputError(fmt::format("{} coefficient {}", quantity, i), fmt::format("{}", coefficients(i)),
                       "finite numbers");
    }
  }
}

/// The zero polynomial keeps one coefficient.
Eigen::VectorXd without_leading_zeros(const Eigen::VectorXd& coefficients) {
  Eigen::Index first = 0;
  while (first + 1 < coefficients.size() && coefficients(first) == 0) {
    ++first;
  }
  return coefficients.tail(coefficients.size() - first);
}

/// Cancels the factors s that both polynomials have, so that "integrating" is decided by the denominator.
void cancel_common_factors_s(Eigen::VectorXd& numerator, Eigen::VectorXd& denominator) {
  Eigen::Index common = 0;
  while (common + 1 < numerator.size() && numerator(numerator.size() - 1 - common) == 0 &&
         denominator(denominator.size() - 1 - common) == 0) {
    ++common;
  }
  numerator = Eigen::VectorXd(numerator.head(numerator.size() - common));
  denominator = Eigen::VectorXd(denominator.head(denominator.size() - common));
}

std::complex<double> evaluate(const Eigen::VectorXd& coefficients, std::complex<double> s) {
  std::complex<double> value = 0;
  for (const double coefficient : coefficients) {
    value = value * s + coefficient;
  }
  return value;
}

/// p(s) / s^n, n the number of roots at the origin.
Eigen::VectorXd without_roots_at_origin(const Eigen::VectorXd& p) {
  Eigen::Index size = p.size();
  while (size > 1 && p(size - 1) == 0)
    --size;
  return p.head(size);
}

/// p'(0) / p(0).
double relative_slope(const Eigen::VectorXd& p) {
  return p.size() > 1 ? p(p.size() - 2) / p(p.size() - 1) : 0.0;
}

/// p(s) -> p(factor * s).
Eigen::VectorXd with_argument_scaled(Eigen::VectorXd coefficients, double factor) {
  double power = 1;
  for (Eigen::Index i = coefficients.size() - 1; i >= 0; --i) {
    coefficients(i) *= power;
    power *= factor;
  }
  return coefficients;
}

template <class Change>
std::optional<StepCoefficients> with_change(const std::optional<StepCoefficients>& step,
                                            const Change& change) {
  return step ? std::optional(change(*step)) : std::nullopt;
}

}  // namespace

TransferFunction::TransferFunction(Eigen::VectorXd numerator, Eigen::VectorXd denominator, double dead_time)
    : numerator_(std::move(numerator)), denominator_(std::move(denominator)), dead_time_(dead_time) {
  require_finite_polynomial("transfer function numerator", numerator_);
  require_finite_polynomial("transfer function denominator", denominator_);
  if (denominator_(0) == 0) {
    throw InputError("leading denominator coefficient of a transfer function", "0", "any other number");
  }
  numerator_ = without_leading_zeros(numerator_);
  if (numerator_.size() > denominator_.size()) {
    throw InputError("numerator degree of a transfer function", fmt::format("{}", numerator_.size() - 1),
                     fmt::format("at most the denominator degree {}", denominator_.size() - 1));
  }
  if (!std::isfinite(dead_time_) || dead_time_ < 0) {
    throw InputError("dead time of a transfer function", fmt::format("{}", dead_time_),
                     "a finite number >= 0");
  }
  cancel_common_factors_s(numerator_, denominator_);
}

TransferFunction TransferFunction::first_order(double gain, double time_constant, double dead_time) {
  if (!std::isfinite(time_constant) || time_constant <= 0) {
    throw InputError("time constant of a first-order transfer function", fmt::format("{}", time_constant),
                     "a finite number > 0");
  }
  return {Eigen::VectorXd::Constant(1, gain), Eigen::Vector2d(time_constant, 1), dead_time};
}

TransferFunction TransferFunction::zero() {
  return {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
}

double TransferFunction::static_gain() const {
  if (is_integrating()) {
    throw InputError("static gain of a transfer function", "a pole at s = 0 (integrating channel)",
                     "channels without a pole at s = 0");
  }
  if (step_)
    return washout_ > 0 ? washout_ * step_->rate() : step_->last();
  return is_zero() ? 0.0 : numerator_(numerator_.size() - 1) / denominator_(order());
}

double TransferFunction::rate_gain() const {
  if (!is_integrating())
    return 0.0;
  return step_ ? step_->rate() : numerator_(numerator_.size() - 1) / denominator_(order() - 1);
}

std::complex<double> TransferFunction::operator()(std::complex<double> s) const {
  return evaluate(numerator_, s) / evaluate(denominator_, s) * std::exp(-s * dead_time_);
}

TransferFunction TransferFunction::with_gain_scaled(double factor) const {
  if (!std::isfinite(factor)) {
    throw InputError("gain factor", fmt::format("{}", factor), "a finite number");
  }
  const TransferFunction G = without_washout();
  return with_rational_part(G.numerator_ * factor, G.denominator_, dead_time_,
                            with_change(step_, [&](const auto& S) { return S.with_gain_scaled(factor); }));
}

TransferFunction TransferFunction::with_time_scaled(double factor) const {
  if (!std::isfinite(factor) || factor <= 0) {
    throw InputError("time factor", fmt::format("{}", factor), "a finite number > 0");
  }
  const TransferFunction G = without_washout();
  const auto integrators =
      static_cast<double>(G.denominator_.size() - without_roots_at_origin(G.denominator_).size());
  return with_rational_part(
      std::pow(factor, integrators) * with_argument_scaled(G.numerator_, factor),
      with_argument_scaled(G.denominator_, factor), dead_time_,
      with_change(step_, [&](const auto& S) { return S.with_time_scaled(factor, dead_time_); }));
}

TransferFunction TransferFunction::with_dead_time_shifted(double delta) const {
  const double shifted = dead_time_ + delta;
  if (!std::isfinite(shifted) || shifted < 0) {
    throw InputError("dead time after a shift", fmt::format("{} + {} = {}", dead_time_, delta, shifted),
                     "a finite number >= 0");
  }
  const TransferFunction G = without_washout();
  return with_rational_part(G.numerator_, G.denominator_, shifted, with_change(step_, [&](const auto& S) {
                              return S.with_dead_time_shifted(delta);
                            }));
}

double TransferFunction::residence_time() const {
  if (is_zero())
    return 0.0;
  const TransferFunction G = without_washout();
  return relative_slope(without_roots_at_origin(G.denominator_)) -
         relative_slope(without_roots_at_origin(G.numerator_));
}

bool TransferFunction::has_time_constant() const {
  return step_ || (!is_zero() && without_roots_at_origin(without_washout().denominator_).size() > 1);
}

TransferFunction TransferFunction::behind_washout(double time_constant) const {
  if (!std::isfinite(time_constant) || time_constant <= 0)
    throw InputError("time constant of a washout", fmt::format("{}", time_constant), "a finite number > 0");
  const TransferFunction G = without_washout();
  TransferFunction washed(polynomial_product(G.numerator_, Eigen::Vector2d(time_constant, 0)),
                          polynomial_product(G.denominator_, Eigen::Vector2d(time_constant, 1)), dead_time_);
  washed.washout_ = time_constant;
  washed.own_numerator_ = G.numerator_;
  washed.own_denominator_ = G.denominator_;
  washed.step_ = step_;
  return washed;
}

TransferFunction TransferFunction::without_washout() const {
  if (washout_ == 0)
    return *this;
  TransferFunction G(own_numerator_, own_denominator_, dead_time_);
  G.step_ = step_;
  return G;
}

TransferFunction TransferFunction::with_step_coefficients(const Eigen::VectorXd& values,
                                                          double interval) const {
  return with_step_coefficients(StepCoefficients(values, interval, without_washout().is_integrating()));
}

TransferFunction TransferFunction::with_step_coefficients(StepCoefficients step) const {
  TransferFunction G = *this;
  G.step_ = std::move(step);
  return G;
}

TransferFunction TransferFunction::without_step_coefficients() const {
  TransferFunction G = *this;
  G.step_.reset();
  return G;
}

TransferFunction TransferFunction::with_rational_part(Eigen::VectorXd numerator, Eigen::VectorXd denominator,
                                                      double dead_time,
                                                      std::optional<StepCoefficients> step) const {
  TransferFunction G(std::move(numerator), std::move(denominator), dead_time);
  G.step_ = std::move(step);
  return washout_ > 0 ? G.behind_washout(washout_) : G;
}

Eigen::VectorXd polynomial_product(const Eigen::VectorXd& p, const Eigen::VectorXd& q) {
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(p.size() + q.size() - 1);
  for (Eigen::Index i = 0; i < p.size(); ++i)
    coefficients.segment(i, q.size()) += p(i) * q;
  return coefficients;
}

bool operator==(const TransferFunction& a, const TransferFunction& b) {
  return same(a.numerator_, b.numerator_) && same(a.denominator_, b.denominator_) &&
         same(a.dead_time_, b.dead_time_) && same(a.washout_, b.washout_) &&
         same(a.own_numerator_, b.own_numerator_) && same(a.own_denominator_, b.own_denominator_) &&
         same(a.step_, b.step_);
}

}  // namespace mpm
