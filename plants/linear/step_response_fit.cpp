#include "plants/linear/step_response_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/QR>
#include <fmt/format.h>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/transfer_matrix.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kFewestResponseSamples = 8;
constexpr double kUnsettledShare = 0.1;  // of the largest value: e^(-2.3), two or three time constants
constexpr double kSettled = 0.01;        // of the largest value: the most that the last eighth may move
constexpr double kSameResponse = 1e-9;   // of the largest value
constexpr double kFastestLag = 0.02;     // time constant in samples: the response jumps within the first one
constexpr double kSlowestLag = 20.0;     // time constant in lengths of the record
constexpr double kLeastDamping = 0.05, kMostDamping = 20.0;
constexpr double kShortestDeadTime = 1e-6;  // in samples; a shorter one counts as 0

constexpr double kStillMoves = 0.3;  // slope at the end over the largest one: e^(-1.2)

enum class StepForm { no_lag, first_order, second_order, with_zero };

Eigen::Index shape_count(StepForm form) {
  return form == StepForm::no_lag ? 1 : form == StepForm::first_order ? 2 : 3;
}

Eigen::Index gain_count(StepForm form) {
  return form == StepForm::with_zero ? 2 : 1;
}

/// The misfit as a function of (dead time, log tau, log xi), in the form that Eigen's port of MINPACK
/// requires; all times in samples.
struct StepMisfit {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  static constexpr int InputsAtCompileTime = Eigen::Dynamic;
  static constexpr int ValuesAtCompileTime = Eigen::Dynamic;

  const Eigen::VectorXd& response;
  StepForm form;
  bool integrates;

  int inputs() const { return static_cast<int>(shape_count(form)); }
  int values() const { return static_cast<int>(response.size()); }

  double dead_time(const Eigen::VectorXd& x) const {
    return std::clamp(x(0), 0.0, static_cast<double>(response.size() - 1));
  }
  double time_constant(const Eigen::VectorXd& x) const {
    return std::clamp(std::exp(x(1)), kFastestLag, kSlowestLag * static_cast<double>(response.size()));
  }
  double damping(const Eigen::VectorXd& x) const {
    return std::clamp(std::exp(x(2)), kLeastDamping, kMostDamping);
  }

  Eigen::VectorXd denominator(const Eigen::VectorXd& x) const {
    Eigen::VectorXd lags = Eigen::VectorXd::Ones(1);
    if (form == StepForm::first_order)
      lags = Eigen::Vector2d(time_constant(x), 1.0);
    else if (form != StepForm::no_lag)
      lags = Eigen::Vector3d(std::pow(time_constant(x), 2), 2.0 * time_constant(x) * damping(x), 1.0);
    if (integrates) {
      lags.conservativeResize(lags.size() + 1);
      lags(lags.size() - 1) = 0.0;
    }
    return lags;
  }
  /// Responses of 1 and of s over the denominator, samples x gains.
  Eigen::MatrixXd basis(const Eigen::VectorXd& x) const {
    TransferMatrix parts(gain_count(form), 1);
    parts(0, 0) = TransferFunction(Eigen::VectorXd::Ones(1), denominator(x), dead_time(x));
    if (form == StepForm::with_zero)
      parts(1, 0) = TransferFunction(Eigen::Vector2d(1.0, 0.0), denominator(x), dead_time(x));
    return step_response(parts, 1.0, response.size()).front().transpose();
  }
  Eigen::VectorXd gains(const Eigen::MatrixXd& columns) const {
    return columns.colPivHouseholderQr().solve(response);
  }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& misfit) const {
    const Eigen::MatrixXd columns = basis(x);
    misfit = columns * gains(columns) - response;
    return 0;
  }
};

/// Samples until the response first passes this share of its largest value.
double rise_time(const Eigen::VectorXd& response, double share) {
  const double level = share * response.cwiseAbs().maxCoeff();
  Eigen::Index k = 0;
  while (std::abs(response(k)) < level)
    ++k;
  return static_cast<double>(k + 1);
}

/// Changes from one sample to the next; the first one is the change from 0.
Eigen::VectorXd increments_of(const Eigen::VectorXd& response) {
  Eigen::VectorXd increments = response;
  increments.tail(response.size() - 1) -= response.head(response.size() - 1);
  return increments;
}

/// Whether the response still moves at its end as it did before.
bool still_moves(const Eigen::VectorXd& response) {
  const Eigen::Index part = std::max<Eigen::Index>(2, response.size() / 8);
  double largest = 0.0;
  for (Eigen::Index k = 0; k + part < response.size(); ++k)
    largest = std::max(largest, std::abs(response(k + part) - response(k)));
  return std::abs(response(response.size() - 1) - response(response.size() - 1 - part)) >
         kStillMoves * largest;
}

/// Starting points of the search: dead times from 0 to the one at which the response is first seen, dampings
/// from an oscillation to two lags that are far apart. For a form with an integrator, `response` is that of
/// the form without it.
std::vector<Eigen::VectorXd> step_fit_starts(const Eigen::VectorXd& response, StepForm form) {
  const double seen = rise_time(response, 0.02) - 1.0, risen = rise_time(response, 0.6);
  std::vector<Eigen::VectorXd> points;
  for (const double part : {0.0, 0.7, 1.0}) {
    const double dead_time = part * seen, rest = std::max(risen - dead_time, 0.3);
    if (form == StepForm::no_lag) {
      points.emplace_back(Eigen::VectorXd::Constant(1, dead_time));
      continue;
    }
    if (form == StepForm::first_order) {
      points.emplace_back(Eigen::Vector2d(dead_time, std::log(rest)));
      continue;
    }
    for (const double damping : {0.5, 1.0, 2.5})
      points.emplace_back(
          Eigen::Vector3d(dead_time, std::log(rest / (0.6 + 1.1 * damping)), std::log(damping)));
  }
  return points;
}

/// A form with its best parameters; the error is the sum of squares.
struct StepCandidate {
  TransferFunction channel = TransferFunction::zero();
  double error;
  Eigen::Index parameters = 0;
};

/// The channel with these parameters, in the time unit of the study.
TransferFunction channel_of(const StepMisfit& misfit, const Eigen::VectorXd& x, double sample_time) {
  const Eigen::VectorXd gains = misfit.gains(misfit.basis(x));
  Eigen::VectorXd numerator(gains.size());
  for (Eigen::Index power = 0; power < gains.size(); ++power)
    numerator(gains.size() - 1 - power) = gains(power) * (power == 0 ? 1.0 : sample_time);
  Eigen::VectorXd denominator = misfit.denominator(x);
  for (Eigen::Index power = 1; power < denominator.size(); ++power)
    denominator(denominator.size() - 1 - power) *= std::pow(sample_time, static_cast<double>(power));
  const double dead_time = misfit.dead_time(x);
  return {numerator, denominator, dead_time < kShortestDeadTime ? 0.0 : dead_time * sample_time};
}

StepCandidate best_of_form(const Eigen::VectorXd& response, StepForm form, bool integrates,
                           double sample_time) {
  const StepMisfit misfit{response, form, integrates};
  Eigen::NumericalDiff<StepMisfit, Eigen::Central> derivative(misfit);
  std::optional<Eigen::VectorXd> best;
  double least = kInfinity;
  for (Eigen::VectorXd x : step_fit_starts(integrates ? increments_of(response) : response, form)) {
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<StepMisfit, Eigen::Central>> method(derivative);
    method.parameters.xtol = method.parameters.ftol = 1e-12;
    method.parameters.maxfev = 200;
    method.minimize(x);
    if (!(method.fnorm < least))
      continue;
    least = method.fnorm;
    best = x;
  }
  StepCandidate candidate{.error = kInfinity, .parameters = shape_count(form) + gain_count(form)};
  if (best) {
    candidate.channel = channel_of(misfit, *best, sample_time);
    candidate.error = least * least;
  }
  return candidate;
}

}  // namespace

StepResponseFit fit_step_response(const Eigen::Ref<const Eigen::VectorXd>& response, double sample_time,
                                  double negligible, double share) {
  if (response.size() < kFewestResponseSamples)
    throw InputError("step response", fmt::format("{} samples", response.size()),
                     fmt::format("at least {}", kFewestResponseSamples));
  if (!response.allFinite())
    throw InputError("step response", "a number that is not finite", "finite numbers");
  if (!(sample_time > 0 && std::isfinite(sample_time)))
    throw InputError("sample time", fmt::to_string(sample_time), "> 0");
  const Eigen::VectorXd values = response;
  const auto n = static_cast<double>(values.size());
  const double floor = std::max(negligible, 1e-300) * std::max(negligible, 1e-300) +
                       std::pow(share * values.cwiseAbs().maxCoeff(), 2);
  const auto score = [&](const StepCandidate& candidate) {
    return n * std::log(candidate.error / n + floor) +
           static_cast<double>(candidate.parameters) * std::log(n);
  };
  StepCandidate best{.error = values.squaredNorm()};
  const auto try_form = [&](StepForm form, bool integrates) {
    if (StepCandidate candidate = best_of_form(values, form, integrates, sample_time);
        score(candidate) < score(best))
      best = std::move(candidate);
  };
  if (values.cwiseAbs().maxCoeff() > negligible) {
    for (const StepForm form : {StepForm::first_order, StepForm::second_order, StepForm::with_zero})
      try_form(form, false);
    if (still_moves(values))
      for (const StepForm form :
           {StepForm::no_lag, StepForm::first_order, StepForm::second_order, StepForm::with_zero})
        try_form(form, true);
  }
  const double power = values.squaredNorm();
  StepResponseFit fit{.channel = best.channel,
                      .rms_error = std::sqrt(best.error / n),
                      .explained = power > 0.0 ? 1.0 - best.error / power : 1.0,
                      .largest_error = 0.0};
  if (power > 0.0) {
    const Eigen::VectorXd found =
        step_response(TransferMatrix{{fit.channel}}, sample_time, values.size()).front().transpose();
    fit.largest_error = (found - values).cwiseAbs().maxCoeff() / values.cwiseAbs().maxCoeff();
  }
  return fit;
}

StepResponseFit fit_step_coefficients(const Eigen::VectorXd& coefficients, double interval,
                                      double negligible) {
  StepResponseFit fit = fit_step_response(coefficients, interval, negligible, kNegligibleOfCoefficients);
  const ResponseEnd end = response_end(fit.channel, coefficients, interval);
  const Eigen::Index before = coefficients.size() - 1 - coefficients.size() / 8;
  const bool moves =
      fit.channel.is_integrating() || std::abs(end.last - coefficients(before)) > kSettled * end.largest;
  if (moves && std::abs(end.last - end.fitted) > kUnsettledShare * end.largest)
    throw InputError("step response",
                     fmt::format("{}{:.6g} at its end, where the fitted transfer function goes to {:.4g}",
                                 fit.channel.is_integrating() ? "a rate of " : "", end.last, end.fitted),
                     "coefficients until the response has settled; of a CV that integrates, its rate");
  return fit;
}

TransferFunction by_coefficients(const StepResponseFit& fit, const Eigen::VectorXd& coefficients,
                                 double interval) {
  const ResponseEnd end = response_end(fit.channel, coefficients, interval);
  if (fit.largest_error <= kSameResponse && std::abs(end.last - end.fitted) <= kSameResponse * end.largest)
    return fit.channel;
  return fit.channel.with_step_coefficients(coefficients, interval);
}

std::optional<TransferFunction> with_fewest_digits(const TransferFunction& channel,
                                                   const Eigen::VectorXd& coefficients, double interval,
                                                   const Eigen::VectorXd& tolerances) {
  constexpr int kMostDigits = 16;  // 17 digits give the number itself
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    const auto shortened = [digits](double value) {
      return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
    };
    const bool is_dead =
        channel.dead_time() > 0.5 * std::pow(10.0, -digits) * interval;  // not a remnant of the search
    const TransferFunction shorter(channel.numerator().unaryExpr(shortened),
                                   channel.denominator().unaryExpr(shortened),
                                   is_dead ? shortened(channel.dead_time()) : 0.0);
    const Eigen::VectorXd response =
        step_response(TransferMatrix{{shorter}}, interval, coefficients.size()).front().transpose();
    if (((response - coefficients).cwiseAbs().array() <= tolerances.array()).all())
      return shorter;
  }
  return std::nullopt;
}

ResponseEnd response_end(const TransferFunction& fit, const Eigen::Ref<const Eigen::VectorXd>& response,
                         double sample_time) {
  const Eigen::Index last = response.size() - 1;
  if (!fit.is_integrating())
    return {response(last), fit.static_gain(), response.cwiseAbs().maxCoeff()};
  const Eigen::VectorXd rates = increments_of(response) / sample_time;
  return {rates(last), fit.rate_gain(), rates.cwiseAbs().maxCoeff()};
}

}  // namespace mpm
