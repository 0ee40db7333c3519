#include "plants/linear/step_coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/same_members.hpp"

namespace mpm {
namespace {

constexpr double kRoundingOfPlace = 1e-9;  // of an interval

/// Returns the nearest whole number if x differs from it by rounding only, otherwise x.
double snapped(double x) {
  const double nearest = std::round(x);
  return std::abs(x - nearest) <= kRoundingOfPlace * std::max(1.0, std::abs(x)) ? nearest : x;
}

}  // namespace

StepCoefficients::StepCoefficients(Eigen::VectorXd values, double interval, bool ramps)
    : values_(std::make_shared<const Eigen::VectorXd>(std::move(values))),
      interval_(interval),
      ramps_(ramps) {
  if (values_->size() < 2 || !values_->allFinite())
    throw InputError("coefficients of a step response",
                     values_->size() < 2 ? fmt::format("{}", values_->size()) : "one that is not finite",
                     "two or more finite numbers");
  if (!(std::isfinite(interval_) && interval_ > 0))
    throw InputError("time between two coefficients", fmt::format("{}", interval_), "a finite number > 0");
}

double StepCoefficients::operator()(double t) const {
  return t <= 0.0 ? 0.0 : after_start(t);
}

double StepCoefficients::after_start(double t) const {
  const double place = snapped((t - start_) / interval_);
  if (place <= 0.0)
    return 0.0;
  const Eigen::Index n = values_->size();
  if (place >= static_cast<double>(n))
    return last() + rate() * interval_ * (place - static_cast<double>(n));
  const auto before = static_cast<Eigen::Index>(place);
  const double from = before > 0 ? (*values_)(before - 1) : 0.0;
  const double share = place - static_cast<double>(before);
  return gain_ * (from + share * ((*values_)(before)-from));
}

double StepCoefficients::rate() const {
  const Eigen::Index n = values_->size();
  return ramps_ ? gain_ * ((*values_)(n - 1) - (*values_)(n - 2)) / interval_ : 0.0;
}

Eigen::VectorXd StepCoefficients::sampled(double sample_time) const {
  const auto count = static_cast<Eigen::Index>(std::max(2.0, std::ceil(snapped(end() / sample_time))));
  Eigen::VectorXd values(count);
  for (Eigen::Index k = 0; k < count; ++k)
    values(k) = (*this)(sample_time * static_cast<double>(k + 1));
  return values;
}

double StepCoefficients::integral(double from, double to) const {
  double sum = 0.0;
  while (from < to) {
    const double piece = std::floor(snapped((from - start_) / interval_)) + 1.0;
    const double end = std::min(to, start_ + interval_ * piece);
    sum += (end - from) * (after_start(from) + after_start(end)) / 2.0;
    from = std::max(end, std::nextafter(from, to));
  }
  return sum;
}

Eigen::VectorXd StepCoefficients::averaged(double sample_time) const {
  Eigen::VectorXd values(sampled(sample_time).size() + 1);
  for (Eigen::Index k = 0; k < values.size(); ++k)
    values(k) = integral(sample_time * static_cast<double>(k), sample_time * static_cast<double>(k + 1)) /
                sample_time;
  return values;
}

StepCoefficients StepCoefficients::with_gain_scaled(double factor) const {
  StepCoefficients changed = *this;
  changed.gain_ *= factor;
  return changed;
}

StepCoefficients StepCoefficients::with_time_scaled(double factor, double about) const {
  StepCoefficients changed = *this;
  changed.interval_ *= factor;
  changed.start_ = about + (start_ - about) * factor;
  if (ramps_)
    changed.gain_ *= factor;
  return changed;
}

StepCoefficients StepCoefficients::with_dead_time_shifted(double delta) const {
  StepCoefficients changed = *this;
  changed.start_ += delta;
  return changed;
}

bool operator==(const StepCoefficients& a, const StepCoefficients& b) {
  return same(*a.values_, *b.values_) && a.interval_ == b.interval_ && a.ramps_ == b.ramps_ &&
         a.start_ == b.start_ && a.gain_ == b.gain_;
}

}  // namespace mpm
