#include "analysis/methods/ours/source_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scenarios/faults/fault.hpp"

namespace mpm {
namespace {

std::string number_of(RecordSource source) {
  return fmt::format("q_{}", to_string(source));
}

/// The most probable source of a CV; none without an answer.
FaultSource source_in(const Assessment& likelihood, Eigen::Index cv) {
  FaultSource best = FaultSource::none;
  double most = 0.0;
  for (const auto& [name, source] :
       {std::pair{"cv_p_mpm", FaultSource::mpm}, std::pair{"cv_p_ud", FaultSource::ud},
        std::pair{"cv_p_both", FaultSource::mpm_ud}, std::pair{"cv_p_other", FaultSource::other}})
    if (const double share = likelihood.number(name, cv); share > most) {
      most = share;
      best = source;
    }
  return best;
}

/// The posterior of `likelihood` over its list of faults, from that of each CV: the CVs are independent of
/// each other. The probabilities that it states for the loop are not used: they are those of loops of the
/// suites, in which a mismatch beside a disturbance is rare. In a plant it is not.
OfSources posterior_of(const Assessment& likelihood) {
  double healthy = 1.0, neither = 1.0, no_mismatch = 1.0, no_disturbance = 1.0;
  for (Eigen::Index cv = 0; cv < std::ssize(likelihood.cvs); ++cv) {
    const double mpm = likelihood.number("cv_p_mpm", cv), ud = likelihood.number("cv_p_ud", cv),
                 other = likelihood.number("cv_p_other", cv);
    const double none = std::max(0.0, 1.0 - mpm - ud - other - likelihood.number("cv_p_both", cv));
    healthy *= none;
    neither *= none + other;
    no_mismatch *= none + other + ud;
    no_disturbance *= none + other + mpm;
  }
  OfSources weights;
  weights[RecordSource::mismatch] = no_disturbance - neither;
  weights[RecordSource::disturbance] = no_mismatch - neither;
  weights[RecordSource::both] = std::max(0.0, 1.0 - no_disturbance - no_mismatch + neither);
  const double other = likelihood.number("p_other");
  const double of_sensors = other > 0.0 ? likelihood.number("p_sensor") / other : 0.0;
  weights[RecordSource::sensor] = (neither - healthy) * of_sensors;
  weights[RecordSource::valve] = (neither - healthy) * (1.0 - of_sensors);
  return weights;
}

RecordSource largest(const OfSources& weights) {
  RecordSource best = RecordSource::unknown;
  for (const RecordSource source : kFaultSources)
    if (weights[source] > weights[best])
      best = source;
  return best;
}

/// The weights with a drift counted as the sensor's, whichever of its causes it has.
OfSources by_cause(const SourceWeights& weights) {
  OfSources of = weights.of;
  of[RecordSource::sensor] += weights.drift;
  of[RecordSource::disturbance] -= weights.drift;
  return of;
}

SourceWeights with_drift_of_both(OfSources of) {
  const double drift = 0.5 * of[RecordSource::sensor];
  of[RecordSource::sensor] = drift;
  of[RecordSource::disturbance] += drift;
  return {of, drift};
}

}  // namespace

RecordSource record_source(FaultSource source, ToldSource told) {
  switch (source) {
    case FaultSource::mpm:
      return RecordSource::mismatch;
    case FaultSource::ud:
      return RecordSource::disturbance;
    case FaultSource::mpm_ud:
      return RecordSource::both;
    case FaultSource::other:
      return told == ToldSource::sensor  ? RecordSource::sensor
             : told == ToldSource::valve ? RecordSource::valve
             : told == ToldSource::data  ? RecordSource::data
                                         : RecordSource::unknown;
    case FaultSource::none:
      break;
  }
  return RecordSource::unknown;
}

std::pair<FaultSource, ToldSource> told_source(RecordSource source) {
  switch (source) {
    case RecordSource::nothing:
      return {FaultSource::none, ToldSource::none};
    case RecordSource::mismatch:
      return {FaultSource::mpm, ToldSource::other};
    case RecordSource::disturbance:
      return {FaultSource::ud, ToldSource::other};
    case RecordSource::both:
      return {FaultSource::mpm_ud, ToldSource::other};
    case RecordSource::sensor:
      return {FaultSource::other, ToldSource::sensor};
    case RecordSource::valve:
      return {FaultSource::other, ToldSource::valve};
    case RecordSource::data:
      return {FaultSource::other, ToldSource::data};
    case RecordSource::unknown:
      break;
  }
  return {FaultSource::other, ToldSource::other};
}

OfSources source_weights(const Assessment& likelihood, const Assessment& said) {
  OfSources weights = likelihood.status == AssessmentStatus::ok ? posterior_of(likelihood) : OfSources{};
  const std::optional<Eigen::Index> worst = said.worst_cv();
  if (!worst)
    return weights;
  const CvAssessment& of_worst = said.cvs[static_cast<std::size_t>(*worst)];
  if (of_worst.source == FaultSource::none) {
    double& mismatch = weights[RecordSource::mismatch];
    double& disturbance = weights[RecordSource::disturbance];
    mismatch = disturbance = 0.5 * (mismatch + disturbance);
    return weights;
  }
  const RecordSource named = record_source(of_worst.source, of_worst.about);
  if (record_source(source_in(likelihood, *worst), ToldSource::valve) == named)
    return weights;
  const auto best = std::max_element(weights.each.begin(), weights.each.end());
  if (*best > 0.0)
    std::swap(weights[named], *best);
  else
    weights[named] = 1.0;
  return weights;
}

SourceWeights with_comparison(const OfSources& weights, const FaultLikelihoods& found) {
  constexpr double kPrior = 0.1;
  // A source that the likelihood rules out keeps this probability, since the likelihood takes the noise for
  // an autoregression of order 1 that never changes. Chosen on the records under the seeds 83 and 84
  // (tests/reliability/records.py).
  constexpr double kDoubt = 0.01;
  OfSources all;
  const double most = std::max({found.mismatch, found.disturbance, found.valve, found.sensor, found.data});
  const auto share = [most](double likelihood) { return std::exp(likelihood - most); };
  const double mismatch = weights[RecordSource::mismatch], both = weights[RecordSource::both],
               disturbance = weights[RecordSource::disturbance], unknown = weights[RecordSource::unknown],
               sum = std::max(mismatch + both + disturbance + unknown, 1e-300),
               wrong_model = std::max((mismatch + both) / sum, kDoubt) * share(found.mismatch),
               // The methods know of no mismatch of an MD, and see a disturbance in it.
      alone = found.md < 0 && mismatch + both > 0.0 ? mismatch / (mismatch + both) : 1.0;
  all[RecordSource::mismatch] = alone * wrong_model;
  all[RecordSource::both] = (1.0 - alone) * wrong_model;
  all[RecordSource::disturbance] = std::max(disturbance / sum, kDoubt) * share(found.disturbance);
  all[RecordSource::unknown] = unknown / sum * share(std::max(found.mismatch, found.disturbance));
  all[RecordSource::valve] = kPrior * share(found.valve);
  all[RecordSource::sensor] = 2.0 * kPrior * share(found.sensor);  // for its two causes
  all[RecordSource::data] = kPrior * share(found.data);
  return with_drift_of_both(all);
}

RecordSource heaviest(const SourceWeights& weights) {
  return largest(by_cause(weights));
}

NamedSource named_source(const SourceWeights& weights) {
  const bool drifts = weights.drift > 0.0 && heaviest(weights) == RecordSource::sensor;
  if (!drifts)
    return {largest(weights.of)};
  const bool is_sensor = weights.of[RecordSource::sensor] > weights.of[RecordSource::disturbance];
  return {is_sensor ? RecordSource::sensor : RecordSource::disturbance, drifts};
}

SourceWeights with_none_of_these(SourceWeights weights, double r) {
  if (!(r > 1.0))
    return weights;
  OfSources of = by_cause(weights);
  const RecordSource best = largest(of);
  const double kept = of[best] / (r * r);
  of[RecordSource::unknown] += of[best] - kept;
  of[best] = kept;
  return with_drift_of_both(of);
}

std::vector<AssessmentNumberInfo> source_weight_numbers() {
  std::vector<AssessmentNumberInfo> numbers;
  for (const RecordSource source : kFaultSources)
    numbers.emplace_back(number_of(source), NumberScope::loop,
                         "weight of this source against the others, given that something is wrong");
  const std::vector<AssessmentNumberInfo> further{
      {"q_drift", NumberScope::loop,
       "part of `q_sensor` and of `q_disturbance` each that a CV has which drifts"},
      {"likely_cv", NumberScope::loop, "CV of the most likely mismatch beside noise of any shape, from 0"},
      {"likely_mv", NumberScope::loop, "its MV"},
      {"likely_parameter", NumberScope::loop, "its parameter: 0 gain, 1 time constant, 2 dead time"},
      {"likely_md", NumberScope::loop, "its MD, where it is of none of the MVs"},
      {"sensor_cv", NumberScope::loop, "the CV that most probably drifts or jumps"},
      {"sensor_jumps", NumberScope::loop, "1: it jumps, 0: it drifts"},
      {"sensor_stuck", NumberScope::loop, "1: it shows one value instead"},
      {"stem_mv", NumberScope::loop, "the MV whose valve most probably sticks beside noise of any shape"},
      {"late", NumberScope::loop, "samples by which CVs are most probably late, below 0: early"},
      {"late_cv", NumberScope::loop, "the CV that is; -1: all are"},
      {"dependence", NumberScope::loop,
       "what the inputs tell of the errors beside the source of the largest weight, over what chance does"}};
  numbers.insert(numbers.end(), further.begin(), further.end());
  return numbers;
}

void add_weights(const SourceWeights& weights, Assessment& assessment) {
  for (const RecordSource source : kFaultSources)
    assessment.numbers.push_back({number_of(source), weights.of[source]});
  assessment.numbers.push_back({"q_drift", weights.drift});
}

void add_likeliest(const FaultLikelihoods& found, Assessment& assessment) {
  const auto add = [&assessment](const char* name, auto value) {
    assessment.numbers.push_back({name, static_cast<double>(value)});
  };
  if (found.named) {
    add("likely_cv", found.named->channel.cv);
    add("likely_mv", found.named->channel.mv);
    add("likely_parameter", static_cast<int>(found.named->parameter));
  }
  add("likely_md", found.md);
  add("sensor_cv", found.sensor_cv);
  add("sensor_jumps", found.sensor_jumps);
  add("sensor_stuck", found.sensor_stuck);
  add("stem_mv", found.valve_mv);
  add("late", found.late);
  add("late_cv", found.data_cv);
}

SourceWeights stated_weights(const AssessmentRecord& said) {
  SourceWeights weights;
  if (!said.answered() || std::isnan(said.number("q_drift")))
    return weights;
  for (const RecordSource source : kFaultSources)
    weights.of[source] = said.number(number_of(source));
  weights.drift = said.number("q_drift");
  return weights;
}

std::optional<FaultLikelihoods> stated_likeliest(const AssessmentRecord& said) {
  if (!said.answered() || std::isnan(said.number("dependence")))
    return std::nullopt;
  const auto place = [&said](const char* name) { return static_cast<Eigen::Index>(said.number(name)); };
  FaultLikelihoods found{.data_cv = place("late_cv"),
                         .late = said.number("late"),
                         .sensor_cv = place("sensor_cv"),
                         .valve_mv = place("stem_mv"),
                         .sensor_jumps = said.number("sensor_jumps") != 0.0,
                         .sensor_stuck = said.number("sensor_stuck") != 0.0,
                         .md = place("likely_md")};
  if (found.md < 0)
    found.named = {{place("likely_cv"), place("likely_mv")},
                   static_cast<MismatchParameter>(place("likely_parameter"))};
  return found;
}

}  // namespace mpm
