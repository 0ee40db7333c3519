#include "analysis/methods/ours/fault_priors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/methods/ours/base_noise.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault_ranges.hpp"

namespace mpm {
namespace {

constexpr double kConstantWidth = 1e-3;
constexpr double kDeviations = 4.0;  // at which a normal distribution is cut off

// Wide priors: a factor of gain or time constant between a tenth and ten, a dead time that is up to twice as
// long or longer by a residence time, a disturbance of 0.1 to 1000 standard deviations of the noise with a
// time constant of a sample to half the record.
constexpr double kLargestFactor = 10.0;
constexpr double kBeyond = 1.1;  // of the largest factor, if the model has errors of its own
constexpr double kSmallestDisturbance = 0.1, kLargestDisturbance = 1000.0;
/// Shares of mismatch, disturbance and both, if there is a fault.
constexpr std::array kWideShares{0.4, 0.4, 0.2};
constexpr double kInputShare = 0.2;   // weight of a disturbance on an MV, over that of the others
constexpr double kSensorShare = 0.2;  // the same for a sensor of a CV, and for one of an MD
/// Standard deviation of the logarithm of the variance of the noise about that of the benchmark: 0.7, or a
/// factor of 1.4 in the standard deviation.
constexpr double kWideFreedom = 4.0;
/// The posterior of log(time constant) is seldom narrower than 0.3: its relative precision is that of so many
/// residence times as the record has.
constexpr double kTimeConstantStep = 0.3;

double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

/// If a study scales its sizes to their effect, the distribution that it draws from tells their direction,
/// but nothing about how large they are.
Distribution scaled_factor(const Distribution& drawn) {
  const auto [low, high] = support(drawn);
  return Distribution::log_uniform(low < 1.0 ? 1.0 / kLargestFactor : 1.0, high > 1.0 ? kLargestFactor : 1.0);
}

double longest_delay(const Study& study, const TransferFunction& channel) {
  return std::max(
      {channel.dead_time(), std::abs(channel.residence_time()), 2.0 * study.controller.sample_time});
}

/// Shifts between two numbers; the higher one if there is no room between them.
Distribution shift_between(double low, double high) {
  return low < high ? Distribution::uniform(low, high) : Distribution::constant(high);
}

Distribution study_shift(const Study& study, const TransferFunction& channel) {
  const Distribution& drawn = study.mismatch.dead_time_shift;
  const auto [low, high] = support(drawn);
  if (study.mismatch.impact)
    return shift_between(low < 0.0 ? -channel.dead_time() : 0.0,
                         high > 0.0 ? longest_delay(study, channel) : 0.0);
  return low >= -channel.dead_time() ? drawn : shift_between(-channel.dead_time(), high);
}

/// A size in residence times of the channel, in the time unit of the plant.
Distribution in_time(const Study& study, const Distribution& drawn, const TransferFunction& channel) {
  const double unit = std::max(std::abs(channel.residence_time()), study.controller.sample_time);
  const auto [low, high] = support(drawn);
  return study.mismatch.impact ? Distribution::log_uniform(1e-2 * unit, kLargestFactor * unit)
                               : shift_between(low * unit, high * unit);
}

Distribution study_size(const Study& study, const TransferFunction& channel, MismatchParameter parameter) {
  const MismatchRanges& ranges = study.mismatch;
  switch (parameter) {
    case MismatchParameter::gain:
      return ranges.impact ? scaled_factor(ranges.gain_factor) : ranges.gain_factor;
    case MismatchParameter::time_constant:
      return ranges.impact ? scaled_factor(ranges.time_constant_factor) : ranges.time_constant_factor;
    case MismatchParameter::dead_time:
      return study_shift(study, channel);
    case MismatchParameter::second_order:
      return in_time(study, ranges.second_order, channel);
    case MismatchParameter::inverse_response:
      return in_time(study, ranges.inverse_response, channel);
    case MismatchParameter::sign:
    case MismatchParameter::channel:
      break;
  }
  return Distribution::constant(-1.0);
}

Distribution wide_size(const Study& study, const TransferFunction& channel, MismatchParameter parameter,
                       bool imperfect) {
  if (parameter == MismatchParameter::dead_time)
    return shift_between(-channel.dead_time(), longest_delay(study, channel));
  const double largest = imperfect ? kBeyond * kLargestFactor : kLargestFactor;
  return Distribution::log_uniform(1.0 / largest, largest);
}

/// Relative frequencies of kRandomMismatchParameters.
auto parameter_weights(const Study& study, FaultPriors priors) {
  return priors == FaultPriors::study ? study.mismatch.parameter_weight
                                      : std::array<double, 6>{1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
}

std::vector<SizePrior> mismatches_of(const Study& study, FaultPriors priors, Eigen::Index cv,
                                     bool imperfect) {
  const auto weights = parameter_weights(study, priors);
  std::vector<SizePrior> mismatches;
  double total = 0.0;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
    const TransferFunction channel = study.assessed_channel(cv, mv);
    if (channel.is_zero())
      continue;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const MismatchParameter parameter = kRandomMismatchParameters[i];
      if (weights[i] == 0.0 ||
          (parameter == MismatchParameter::time_constant && !channel.has_time_constant()))
        continue;
      total += weights[i];
      mismatches.push_back({{cv, mv},
                            parameter,
                            weights[i],
                            priors == FaultPriors::study ? study_size(study, channel, parameter)
                                                         : wide_size(study, channel, parameter, imperfect)});
    }
  }
  for (SizePrior& mismatch : mismatches)
    mismatch.weight /= total;
  return mismatches;
}

/// Time constants, each in the middle of a cell, and their weights. The cells have the same width in the
/// logarithm.
std::vector<std::pair<double, double>> time_constants(const Distribution& distribution) {
  const auto [low, high] = support(distribution);
  const int count = std::max(1, static_cast<int>(std::ceil(std::log(high / low) / kTimeConstantStep)));
  const double ratio = std::pow(high / low, 1.0 / count);
  std::vector<std::pair<double, double>> nodes;
  double total = 0.0;
  for (int i = 0; i < count; ++i) {
    const double tau = low * std::pow(ratio, i + 0.5);
    nodes.emplace_back(tau, density(distribution, tau) * tau);
    total += nodes.back().second;
  }
  for (auto& [tau, weight] : nodes)
    weight /= total;
  return nodes;
}

std::vector<DisturbancePrior> disturbances_of(const Study& study, FaultPriors priors, double noise,
                                              bool imperfect) {
  const double Ts = study.controller.sample_time;
  const DisturbanceRanges& ranges = study.disturbance;
  const bool drawn = priors == FaultPriors::study;
  const Distribution taus =
      drawn ? ranges.time_constant
            : Distribution::log_uniform(Ts, std::max(2.0, 0.5 * study.simulation.samples) * Ts);
  const bool sized = drawn && !ranges.impact;
  const Distribution size =
      sized ? ranges.gain
            : Distribution::log_uniform(imperfect && !drawn ? kLargestBackground : kSmallestDisturbance,
                                        kLargestDisturbance);
  std::vector<DisturbancePrior> disturbances;
  for (const auto& [tau, weight] : time_constants(taus)) {
    const double a = std::exp(-Ts / tau);
    // For y_d of white v that is held over a sample, or for y_d of a given standard deviation.
    const double scale = sized ? ranges.v_standard_deviation * (1.0 - a) : noise * std::sqrt(1.0 - a * a);
    disturbances.push_back({a, weight, scale, size});
  }
  return disturbances;
}

bool draws_one_fault(const Study& study) {
  const auto& extents = study.mismatch.extent_weight;
  const auto& places = study.disturbance.place_weight;
  return study.mismatch.channels.empty() && study.disturbance.cvs.empty() &&
         std::all_of(extents.begin() + 1, extents.end(), [](double weight) { return weight == 0.0; }) &&
         std::all_of(places.begin() + 1, places.end(), [](double weight) { return weight == 0.0; });
}

/// The nu for which the logarithm of a scaled inverse chi-square variable has the same variance as the
/// logarithm of the factor's square. This variance is 2 / nu if nu is more than a few.
double freedom_of(const Distribution& factor) {
  const auto [low, high] = support(factor);
  const double width = std::log(high / std::max(low, 1e-3 * high));
  const double variance = factor.kind() == Distribution::Kind::constant ? 0.0 : 4.0 * width * width / 12.0;
  return variance > 0.0 ? 2.0 / variance : kInfinity;
}

/// The weight of a fault of one of `count` inputs. A fault of some input is `share` times as probable as all
/// faults of CVs together.
double input_weight(double share, double fault_probability, Eigen::Index count) {
  return count == 0 ? 0.0
                    : share * fault_probability / (1.0 - fault_probability) / static_cast<double>(count);
}

/// The weights of the kinds of a study against its loops without a fault. The basis case is one of these, so
/// that there always is one.
CvPrior kinds_of(const Study& study) {
  const ExperimentCounts& counts = study.experiments;
  const double healthy = 1.0 + counts.healthy + counts.tuning;
  return {counts.mpm / healthy, counts.ud / healthy, counts.mpm_ud / healthy, {}, {}};
}

}  // namespace

std::pair<double, double> support(const Distribution& distribution) {
  switch (distribution.kind()) {
    case Distribution::Kind::constant: {
      const double c = distribution.first();
      const double width = c == 0.0 ? kConstantWidth : kConstantWidth * std::abs(c);
      return {c - width, c + width};
    }
    case Distribution::Kind::normal:
      return {distribution.first() - kDeviations * distribution.second(),
              distribution.first() + kDeviations * distribution.second()};
    case Distribution::Kind::uniform:
    case Distribution::Kind::log_uniform:
      break;
  }
  return {distribution.minimum(), distribution.maximum()};
}

double density(const Distribution& distribution, double x) {
  const auto [low, high] = support(distribution);
  if (x < low || x > high)
    return 0.0;
  switch (distribution.kind()) {
    case Distribution::Kind::log_uniform:
      return 1.0 / (x * std::log(high / low));
    case Distribution::Kind::normal:
      return normal_density((x - distribution.first()) / distribution.second()) / distribution.second();
    case Distribution::Kind::constant:
    case Distribution::Kind::uniform:
      break;
  }
  return 1.0 / (high - low);
}

FaultPriorSet fault_priors(const Study& study, FaultPriors priors, double fault_probability,
                           const Eigen::Ref<const Eigen::VectorXd>& noise, bool imperfect) {
  const bool drawn = priors == FaultPriors::study && !study.names_scenarios();
  FaultPriorSet set{{},
                    drawn ? 0.0 : input_weight(kInputShare, fault_probability, study.mv_count()),
                    drawn ? 0.0 : input_weight(kSensorShare, fault_probability, study.md_count()),
                    drawn && draws_one_fault(study),
                    drawn ? freedom_of(study.simulation.noise.factor) : kWideFreedom,
                    drawn};
  const auto ny = static_cast<double>(study.cv_count());
  double channels = 0.0;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const FaultPriors used = drawn ? FaultPriors::study : FaultPriors::wide;
    CvPrior prior = drawn ? kinds_of(study) : CvPrior{};
    if (!drawn) {
      const double odds = std::pow(1.0 - fault_probability, -1.0 / ny) - 1.0;
      prior.mpm = odds * kWideShares[0];
      prior.ud = odds * kWideShares[1];
      prior.both = odds * kWideShares[2];
      prior.sensor = odds * kSensorShare;
    }
    prior.mismatches = mismatches_of(study, used, cv, imperfect);
    prior.disturbances = disturbances_of(study, used, noise(cv), imperfect);
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      channels += study.plant.G(cv, mv).is_zero() ? 0.0 : 1.0;
    set.cvs.push_back(std::move(prior));
  }
  for (Eigen::Index cv = 0; cv < study.cv_count() && drawn; ++cv) {
    CvPrior& prior = set.cvs[static_cast<std::size_t>(cv)];
    double own = 0.0;
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      own += study.plant.G(cv, mv).is_zero() ? 0.0 : 1.0;
    // The study draws one channel out of all, and a disturbance has the CV of the mismatch if there is one.
    prior.mpm *= own / channels;
    prior.both *= own / channels;
    prior.ud /= ny;
  }
  for (CvPrior& prior : set.cvs)
    if (prior.mismatches.empty())
      prior.mpm = prior.both = 0.0;
  return set;
}

}  // namespace mpm
