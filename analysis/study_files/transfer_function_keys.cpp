#include "analysis/study_files/transfer_function_keys.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/non_finite.hpp"
#include "plants/linear/in_series.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMaxCoefficients = 20;
constexpr std::size_t kMaxStepCoefficients = 1000;

/// Returns the largest real part of the roots of p_0 s^n + ... + p_n, n >= 1, p_0 != 0, by the companion
/// matrix. The unit of s is chosen so that the geometric mean of the roots is 1; otherwise slow multiple
/// roots would drown in rounding. Not finite if the ratios of the coefficients are not.
double largest_real_part_of_roots(const Eigen::VectorXd& p) {
  const Eigen::Index n = p.size() - 1;
  const double mean_root = std::pow(std::abs(p(n) / p(0)), 1.0 / static_cast<double>(n));
  if (mean_root == 0) {
    return 0;
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(0, i) = -p(i + 1) / p(0) / std::pow(mean_root, static_cast<double>(i + 1));
  }
  companion.diagonal(-1).setOnes();
  if (!companion.allFinite()) {
    return kNaN;
  }
  return mean_root * companion.eigenvalues().real().maxCoeff();
}

WrittenTransferFunction read_step_coefficients(const TomlTable& table) {
  for (const char* other : {"gain", "rate_gain", "time_constant", "numerator", "denominator", "dead_time"})
    if (table.has(other))
      table.refuse(other, "a second way to write a channel", "step and step_interval alone");
  const Eigen::VectorXd coefficients =
      read_numbers(table, "step", NumberRule::finite(), kMaxStepCoefficients);
  const double interval = read_number(table, "step_interval", NumberRule::positive());
  const StepResponseFit fit =
      table.located("step", [&] { return fit_step_coefficients(coefficients, interval); });
  return {by_coefficients(fit, coefficients, interval), fit.largest_error};
}

}  // namespace

OptionKeys transfer_function_keys(const std::string& input, const std::string& poles) {
  return {key::option("gain", "number", "static gain in `gain / (time_constant s + 1)`", "CV / " + input)
              .otherwise("none; with `time_constant`")
              .allow("finite"),
          key::option("rate_gain", "number",
                      "gain of a channel that integrates, such as from a flow to a level: rate of the CV "
                      "under a constant input of 1, in `rate_gain / (s (time_constant s + 1))`",
                      "CV / " + input + " / time")
              .otherwise("none; instead of `gain`")
              .allow("finite"),
          key::option("time_constant", "number", "time constant of these two", "time")
              .otherwise("required with `gain`, none with `rate_gain`")
              .allow("> 0"),
          key::option("numerator", "list of numbers",
                      "coefficients in descending powers of s, at most as many as in the denominator",
                      "CV / " + input + " time^k")
              .otherwise("none; with `denominator`")
              .allow("1 to 20 finite numbers"),
          key::option("denominator", "list of numbers", "coefficients in descending powers of s", "time^k")
              .otherwise("none; with `numerator`")
              .allow("1 to 20 finite numbers, the first one not 0; " + poles),
          key::option("dead_time", "number", "dead time", "time")
              .otherwise("0; not beside `step`")
              .allow(">= 0, at most 10000 sample times"),
          key::option("step", "list of numbers",
                      "coefficients of the step response, as dynamic matrix control has them: values 1, 2, "
                      "... intervals after a step of 1. Simulation and prediction use these coefficients; "
                      "the last value holds from there on, or the last slope if the channel integrates. The "
                      "parameters of the channel are those of a transfer function fitted to the coefficients",
                      "CV / " + input)
              .otherwise("none; with `step_interval`")
              .allow("8 to 1000 finite numbers, until the response has settled"),
          key::option("step_interval", "number", "time between two coefficients", "time")
              .otherwise("none; with `step`")
              .allow("> 0")};
}

WrittenTransferFunction read_transfer_function(const TomlTable& table) {
  if (table.has("step") || table.has("step_interval"))
    return read_step_coefficients(table);
  const double dead_time = read_number_or(table, "dead_time", NumberRule::at_least(0), 0.0);
  const bool first_order = table.has("gain") || table.has("time_constant") || table.has("rate_gain");
  if (first_order == (table.has("numerator") || table.has("denominator"))) {
    table.refuse("", first_order ? "both ways to write a channel" : "no transfer function",
                 "either gain and time_constant, or rate_gain, or numerator and denominator, or step and "
                 "step_interval");
  }
  if (table.has("rate_gain")) {
    if (table.has("gain"))
      table.refuse("gain", "a static gain beside rate_gain", "one of them");
    const double rate = read_number(table, "rate_gain", NumberRule::finite());
    const TransferFunction integrator(Eigen::VectorXd::Constant(1, rate), Eigen::Vector2d(1, 0), dead_time);
    if (!table.has("time_constant"))
      return {integrator};
    return {in_series(integrator, TransferFunction::first_order(
                                      1, read_number(table, "time_constant", NumberRule::positive())))};
  }
  if (first_order) {
    return {TransferFunction::first_order(read_number(table, "gain", NumberRule::finite()),
                                          read_number(table, "time_constant", NumberRule::positive()),
                                          dead_time)};
  }
  Eigen::VectorXd numerator = read_numbers(table, "numerator", NumberRule::finite(), kMaxCoefficients);
  Eigen::VectorXd denominator = read_numbers(table, "denominator", NumberRule::finite(), kMaxCoefficients);
  return {table.located(
      "", [&] { return TransferFunction(std::move(numerator), std::move(denominator), dead_time); })};
}

void refuse_unstable(const TomlTable& table, const TransferFunction& channel, PolesAtOrigin allowed) {
  if (channel.is_zero() || channel.order() == 0) {
    return;
  }
  const bool integrates = channel.is_integrating() && allowed == PolesAtOrigin::one;
  const Eigen::VectorXd others = channel.denominator().head(channel.order() + (integrates ? 0 : 1));
  if (others.size() == 1)
    return;
  const double real_part = largest_real_part_of_roots(others);
  if (!std::isfinite(real_part)) {
    table.refuse("denominator", "coefficients whose ratios overflow", "coefficients of similar size");
  }
  if (!(real_part < 0)) {
    table.refuse("denominator",
                 integrates && real_part == 0 ? "a second pole at 0"
                                              : fmt::format("a pole with real part {:.3g}", real_part),
                 allowed == PolesAtOrigin::one
                     ? "poles with negative real parts; one pole may be 0"
                     : "poles with negative real parts, since the model of this CV has no pole at 0");
  }
}

void refuse_growing(const TomlTable& table, const TransferFunction& Gd) {
  const Eigen::VectorXd& all = Gd.denominator();
  Eigen::Index size = all.size();
  while (size > 1 && all(size - 1) == 0) {
    --size;  // an integrator
  }
  if (Gd.is_zero() || size == 1) {
    return;
  }
  const double real_part = largest_real_part_of_roots(all.head(size));
  if (!std::isfinite(real_part)) {
    table.refuse("denominator", "coefficients whose ratios overflow", "coefficients of similar size");
  }
  if (real_part > 0) {
    table.refuse("denominator", fmt::format("a pole with real part {:.3g}", real_part),
                 "poles with negative real parts, or at 0");
  }
}

void refuse_long_memory(const TomlTable& table, const std::string& key, const TransferFunction& channel,
                        double sample_time) {
  const double memory = channel.memory(), dead_time = channel.dead_time();
  if (memory / sample_time <= kMaxDeadTimeSamples)
    return;
  const std::string allowed = fmt::format("at most {} samples", kMaxDeadTimeSamples);
  if (memory > dead_time)
    table.refuse(table.has("step") ? "step" : "", fmt::format("coefficients over {}", memory), allowed);
  table.refuse(key, key.empty() ? fmt::format("a dead time of {}", dead_time) : fmt::format("{}", dead_time),
               allowed);
}

double largest_draw(const Distribution& draws) {
  constexpr double kFarOut = 10.0;  // standard deviations
  return draws.kind() == Distribution::Kind::normal ? draws.first() + kFarOut * draws.second()
                                                    : draws.maximum();
}

void refuse_long_draws(const TomlTable& table, const std::string& key, const Distribution& draws,
                       const TransferFunction& channel, const std::string& name, const LongestDraws& longest,
                       double sample_time) {
  const double dead_time = channel.dead_time();
  const double shifted = std::max(0.0, longest.dead_time_factor * dead_time + longest.dead_time_shift);
  double kept = shifted / sample_time;
  if (const auto& step = channel.step_coefficients()) {
    const double end = shifted + longest.time_factor * (step->end() - dead_time);
    const double apart = longest.least_time_factor * step->interval();
    kept =
        std::max(kept, longest.lag > 0.0 ? (end + kTimesToSettle * longest.lag) / std::min(sample_time, apart)
                                         : end / sample_time);
  }
  if (!(kept <= kMaxDelay))
    table.refuse(key,
                 fmt::format("draws up to {} ({} then looks back over {:.3g} samples)", largest_draw(draws),
                             name, kept),
                 fmt::format("draws with which no channel looks back over more than {}", kMaxDelay));
}

}  // namespace mpm
