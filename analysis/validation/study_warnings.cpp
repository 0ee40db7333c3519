#include "analysis/validation/study_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/sensitivity/active_limit.hpp"
#include "analysis/sensitivity/loop_stability.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/settling_time.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

using Warnings = std::vector<StudyWarning>;

constexpr double kLargestNoiseShare = 0.05;  // of a range or a step; shipped studies have 1 to 2 %
constexpr double kMostlyNoise = 0.5;         // of the variance of a CV
constexpr double kOftenAtLimit = 0.1;        // of the samples of the basis case
constexpr double kEdge = 0.75;               // of the way from 1 to the end of the band
constexpr double kPoorStepFit = 0.01;  // of the largest coefficient: models are a few percent off anyway
constexpr int kFewSamples = 100;

std::string_view name_of(const std::vector<PlantModel::Variable>& variables, Eigen::Index i) {
  return variables[static_cast<std::size_t>(i)].name;
}

std::string with_unit(double value, std::string_view unit) {
  return unit == "1" ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

/// Writes a number below 1e9 with every digit, a larger one with three.
std::string count_text(double count) {
  constexpr double kMostCounted = 1e9;
  return count < kMostCounted ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

std::string_view cv_unit(const Study& study, Eigen::Index cv) {
  return study.plant.cvs[static_cast<std::size_t>(cv)].unit;
}

// --- Time ---

/// A time of a channel from an MV, and the name of the channel.
struct ChannelTime {
  double time;
  std::string channel;
};

/// Returns the smallest and the largest `time` over the channels from MVs that are not zero and whose time is
/// above 0.
template <class Time>
std::pair<ChannelTime, ChannelTime> range_of(const Study& study, Time time) {
  ChannelTime smallest{kInfinity, ""}, largest{0.0, ""};
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
      const TransferFunction& channel = study.plant.G(cv, mv);
      const double of_channel = channel.is_zero() ? 0.0 : time(channel);
      if (!(of_channel > 0.0))
        continue;
      const std::string name =
          fmt::format("{}/{}", name_of(study.plant.cvs, cv), name_of(study.plant.mvs, mv));
      if (of_channel < smallest.time)
        smallest = {of_channel, name};
      if (of_channel > largest.time)
        largest = {of_channel, name};
    }
  return {smallest, largest};
}

void check_times(const Study& study, Warnings& warnings) {
  const std::string& unit = study.plant.time_unit;
  const double Ts = study.controller.sample_time;
  const ChannelTime fastest = range_of(study, sum_of_time_constants).first;
  if (Ts > fastest.time)
    warnings.push_back({"controller.sample_time",
                        fmt::format("{} is above the time constant of {}, {}", with_unit(Ts, unit),
                                    fastest.channel, with_unit(fastest.time, unit)),
                        fmt::format("times are in {}; use a sample time of at most {} to see its response",
                                    unit, with_unit(fastest.time / 3.0, unit))});
  const ChannelTime longest =
      range_of(study, [](const TransferFunction& channel) { return channel.dead_time(); }).second;
  if (longest.time > 0.0 && longest.time < Ts)
    warnings.push_back(
        {"controller.sample_time",
         fmt::format("the longest dead time, {} of {}, is less than a sample of {}",
                     with_unit(longest.time, unit), longest.channel, with_unit(Ts, unit)),
         "the simulation handles it exactly, but a dead-time mismatch within one sample hardly shows"});
  const ChannelTime slowest = range_of(study, settling_time).second;
  const double horizon = Ts * study.controller.prediction_horizon;
  if (horizon < slowest.time)
    warnings.push_back(
        {"controller.prediction_horizon",
         fmt::format("{} samples, {}, are shorter than the settling time of {}, {}",
                     study.controller.prediction_horizon, with_unit(horizon, unit), slowest.channel,
                     with_unit(slowest.time, unit)),
         fmt::format("use {} samples to see it settle", count_text(std::ceil(slowest.time / Ts)))});
  const int samples = study.simulation.samples;
  if (samples * Ts < 3.0 * slowest.time)
    warnings.push_back(
        {"simulation.samples",
         fmt::format("a record of {}, {:.1f} settling times of {}", with_unit(samples * Ts, unit),
                     samples * Ts / slowest.time, slowest.channel),
         fmt::format("variances need several settling times: {} samples are three of them",
                     count_text(std::ceil(3.0 * slowest.time / Ts)))});
  else if (samples < kFewSamples)
    warnings.push_back({"simulation.samples", fmt::format("{}", samples),
                        "the variance of so few samples is mostly chance"});
}

void check_step_fits(const Study& study, Warnings& warnings) {
  for (const PlantModel::StepFit& fit : study.plant.step_fits)
    if (fit.error > kPoorStepFit)
      warnings.push_back(
          {"plant.channel[].step",
           fmt::format("the transfer function of {}/{} leaves up to {:.2g} % of its coefficients",
                       name_of(study.plant.cvs, fit.cv),
                       input_names(study.plant)[static_cast<std::size_t>(fit.input)], 100 * fit.error),
           "plant and controller have the coefficients; methods that need parameters (directions of a "
           "mismatch, "
           "starts of a search, spectral_radius) have those of the transfer function"});
}

// --- Setpoints and limits ---

void check_setpoint(const Study& study, Eigen::Index cv, double setpoint, const std::string& key,
                    Warnings& warnings) {
  const Limits& hard = study.controller.cv_hard;
  if (setpoint < hard.lower(cv) || setpoint > hard.upper(cv))
    warnings.push_back(
        {key,
         fmt::format("{} for {} is outside its hard limits [{}, {}]", with_unit(setpoint, cv_unit(study, cv)),
                     name_of(study.plant.cvs, cv), hard.lower(cv), hard.upper(cv)),
         "the loop becomes infeasible or never reaches it"});
}

/// Returns the interval in which the CV can be at rest with all MVs within their hard limits; unbounded for a
/// CV that integrates.
std::pair<double, double> reach(const Study& study, Eigen::Index cv) {
  if (study.plant.G.is_integrating(cv))
    return {-kInfinity, kInfinity};
  const Limits& hard = study.controller.mv_hard;
  double low = 0.0, high = 0.0;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
    const double gain = study.plant.G(cv, mv).static_gain();
    if (gain == 0.0)
      continue;
    low += gain * (gain > 0.0 ? hard.lower(mv) : hard.upper(mv));
    high += gain * (gain > 0.0 ? hard.upper(mv) : hard.lower(mv));
  }
  return {low, high};
}

/// Warns if the MVs cannot bring the CV into [wanted_low, wanted_high].
void check_reach(const Study& study, Eigen::Index cv, double wanted_low, double wanted_high,
                 const std::string& key, Warnings& warnings) {
  const auto [low, high] = reach(study, cv);
  if (wanted_low > high || wanted_high < low)
    warnings.push_back(
        {key,
         fmt::format("[{:.4g}, {:.4g}] {}, but within their hard limits the MVs can only bring {} to "
                     "[{:.4g}, {:.4g}]",
                     wanted_low, wanted_high, cv_unit(study, cv), name_of(study.plant.cvs, cv), low, high),
         "check the signs of the gains and of the limits"});
}

void check_cvs(const Study& study, Warnings& warnings) {
  const MpcOptions& controller = study.controller;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const std::string table = fmt::format("controller.cv.{}", name_of(study.plant.cvs, cv));
    if (controller.has_setpoint(cv)) {
      const double setpoint = study.simulation.initial_setpoint(cv);
      check_setpoint(study, cv, setpoint, table + ".setpoint", warnings);
      check_reach(study, cv, setpoint, setpoint, table + ".setpoint", warnings);
    } else if (controller.has_soft_limit(cv)) {
      check_reach(study, cv, controller.cv_soft.lower(cv), controller.cv_soft.upper(cv), table + ".soft",
                  warnings);
    }
  }
  for (const SignalStep& step : study.simulation.setpoint_steps) {
    check_setpoint(study, step.variable, step.level, "simulation.step", warnings);
    check_reach(study, step.variable, step.level, step.level, "simulation.step", warnings);
  }
  for (const LimitStep& step : study.simulation.limit_steps)
    check_reach(study, step.cv, step.lower, step.upper, "simulation.limit_step", warnings);
}

// --- Noise and excitation ---

/// Returns what the noise of a CV is compared with: its soft range, or the largest step of its setpoint; 0 if
/// neither is known.
std::pair<double, std::string_view> scale_of(const Study& study, Eigen::Index cv) {
  double largest = 0.0, level = study.simulation.initial_setpoint(cv);
  for (const SignalStep& step : study.simulation.setpoint_steps)
    if (step.variable == cv) {
      largest = std::max(largest, std::abs(step.level - level));
      level = step.level;
    }
  if (study.controller.has_setpoint(cv))
    return {largest, "the largest step of its setpoint"};
  const double width = study.controller.cv_soft.upper(cv) - study.controller.cv_soft.lower(cv);
  return {std::isfinite(width) ? width : 0.0, "the width of its soft range"};
}

void check_noise(const Study& study, Warnings& warnings) {
  const std::string key = "simulation.noise_standard_deviation";
  if (study.simulation.noise_standard_deviation.isZero(0)) {
    warnings.push_back({key, "0 for every CV", "without noise every method looks better than it is"});
    return;
  }
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const double noise = study.simulation.noise_standard_deviation(cv);
    const auto [scale, what] = scale_of(study, cv);
    if (noise == 0.0)
      warnings.push_back({key, fmt::format("0 for {}", name_of(study.plant.cvs, cv)),
                          "without noise every method looks better than it is"});
    else if (scale > 0.0 && noise > kLargestNoiseShare * scale)
      warnings.push_back({key,
                          fmt::format("{} for {} is {} % of {}, {}", with_unit(noise, cv_unit(study, cv)),
                                      name_of(study.plant.cvs, cv), count_text(100.0 * noise / scale), what,
                                      with_unit(scale, cv_unit(study, cv))),
                          "1 to 2 % is usual; check whether it is a variance or in another unit"});
  }
}

void check_excitation(const Study& study, Warnings& warnings) {
  if (!study.simulation.is_excited() && study.diagnosis.self_check == SelfCheck::ivar)
    warnings.push_back(
        {"diagnosis.self_check", "\"ivar\" in a study without excitation",
         "y0 has no variance there, so the self-check fails; \"repeat\" checks what the truth needs"});
}

void check_counts(const Study& study, Warnings& warnings) {
  if (!study.names_scenarios() && study.experiments.healthy == 0 && study.experiments.tuning == 0)
    warnings.push_back({"experiments.healthy", "0, and no bad tunings",
                        "no false alarm can be counted, so a method that flags every loop looks perfect"});
}

// --- The basis case ---

void check_self_check(const Study& study, const BasisCase& basis, Warnings& warnings) {
  const DiagnosisOptions& options = study.diagnosis;
  if (!basis.healthy) {
    warnings.push_back(
        {"diagnosis.self_check", basis.explanation,
         "a run refuses such a study: excite it more, lower the noise, or lengthen the record"});
    return;
  }
  if (options.self_check != SelfCheck::ivar)
    return;
  for (Eigen::Index cv = 0; cv < basis.diagnosis.ivar.size(); ++cv) {
    const double ivar = basis.diagnosis.ivar(cv);
    const double end = ivar > 1.0 ? options.self_check_upper : options.self_check_lower;
    if (std::abs(ivar - 1.0) > kEdge * std::abs(end - 1.0))
      warnings.push_back({"diagnosis.self_check_band",
                          fmt::format("Ivar of the basis case is {:.3f} for {}, near the end {} of the band",
                                      ivar, name_of(study.plant.cvs, cv), end),
                          "another seed may fail it; excite the loop more or lower the noise"});
  }
}

void check_noise_share(const Study& study, const BasisCase& basis, Warnings& warnings) {
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const Eigen::RowVectorXd y = basis.trajectory.y.row(cv);
    const double variance = (y.array() - y.mean()).square().mean();
    const double noise = study.simulation.noise_standard_deviation(cv);
    if (noise * noise > kMostlyNoise * variance)
      warnings.push_back(
          {"simulation.noise_standard_deviation",
           fmt::format("noise is {:.0f} % of the variance of {} in the basis case",
                       std::min(100.0, 100.0 * noise * noise / variance), name_of(study.plant.cvs, cv)),
           "a fault there has an impact only if it outweighs the noise"});
  }
}

void check_mvs(const Study& study, const BasisCase& basis, Warnings& warnings) {
  const Limits& hard = study.controller.mv_hard;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
    if (hard.lower(mv) == hard.upper(mv))
      continue;  // held there on purpose
    Eigen::Index at_limit = 0;
    for (const double u : basis.trajectory.u.row(mv))
      at_limit += at_or_below(u, hard.lower(mv)) || at_or_above(u, hard.upper(mv)) ? 1 : 0;
    const double share = static_cast<double>(at_limit) / static_cast<double>(basis.trajectory.u.cols());
    if (share > kOftenAtLimit)
      warnings.push_back({fmt::format("controller.mv.{}.hard", name_of(study.plant.mvs, mv)),
                          fmt::format("at a limit in {:.0f} % of the basis case", 100.0 * share),
                          "S0 does not describe the controller there; widen the limits, excite less, or use "
                          "sensitivity.structure = \"by-instant\""});
  }
}

void check_worlds(const Study& study, const BasisCase& basis, Warnings& warnings) {
  const LoopStability stability(study, basis.point);
  std::vector<int> unstable;
  for (int world = 0; study.world && world < study.world->count; ++world)
    if (stability.spectral_radius(basis_draw(world)) >= 1.0)
      unstable.push_back(world);
  if (unstable.empty())
    return;
  const bool excluded = study.diagnosis.unstable == UnstableLoops::exclude;
  warnings.push_back(
      {"world",
       fmt::format("{} of {} worlds are unstable without a fault, the first of them number {}",
                   unstable.size(), study.world->count, unstable.front()),
       excluded
           ? "the study leaves their experiments out; draw smaller errors, or detune the controller"
           : "nobody would leave such loops in operation: diagnosis.unstable = \"exclude\" leaves them out"});
}

}  // namespace

std::string to_string(const StudyWarning& warning) {
  return fmt::format("{}: {}; {}", warning.key, warning.found, warning.advice);
}

std::vector<StudyWarning> study_warnings(const Study& study) {
  Warnings warnings;
  check_times(study, warnings);
  check_step_fits(study, warnings);
  check_cvs(study, warnings);
  check_noise(study, warnings);
  check_excitation(study, warnings);
  check_counts(study, warnings);
  return warnings;
}

std::vector<StudyWarning> basis_warnings(const Study& study, const BasisCase& basis) {
  Warnings warnings;
  check_self_check(study, basis, warnings);
  if (basis.trajectory.status != ControlStatus::ok)
    return warnings;
  check_noise_share(study, basis, warnings);
  check_mvs(study, basis, warnings);
  check_worlds(study, basis, warnings);
  return warnings;
}

}  // namespace mpm
