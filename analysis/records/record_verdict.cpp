#include "analysis/records/record_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "analysis/methods/ours/repair_prospects.hpp"

namespace mpm {
namespace {

constexpr double kHalfAGain = 0.5;  ///< a record that would not show this error of a gain tells nothing

const CvCost* cost_of(const std::vector<CvCost>& costs, Eigen::Index cv) {
  const auto found =
      std::find_if(costs.begin(), costs.end(), [cv](const CvCost& cost) { return cost.cv == cv; });
  return found == costs.end() ? nullptr : &*found;
}

/// Dearer CVs first, the largest ratio first.
bool costs_more(const CvCost& a, const CvCost& b) {
  return a.is_dearer() != b.is_dearer() ? a.is_dearer() : a.ratio > b.ratio;
}

/// The CVs that the model does not explain: first the dearer ones by falling ratio, then the others by
/// falling score.
std::vector<UnexplainedPart> unexplained_parts(const VerdictEvidence& evidence,
                                               const std::vector<CvCost>& costs) {
  std::vector<UnexplainedPart> parts = evidence.noisy;
  for (Eigen::Index cv = 0; cv < evidence.model_scores.size(); ++cv) {
    const bool is_noisy =
        std::any_of(parts.begin(), parts.end(), [cv](const UnexplainedPart& part) { return part.cv == cv; });
    if (evidence.model_scores(cv) > evidence.model_threshold && !is_noisy)
      parts.push_back({cv, evidence.model_scores(cv), evidence.model_threshold});
  }
  const auto excess = [&costs](const UnexplainedPart& part) {
    const CvCost* const cost = cost_of(costs, part.cv);
    return cost != nullptr && cost->is_dearer() ? cost->ratio : 0.0;
  };
  std::stable_sort(parts.begin(), parts.end(), [&excess](const UnexplainedPart& a, const UnexplainedPart& b) {
    return excess(a) != excess(b) ? excess(a) > excess(b) : a.score > b.score;
  });
  return parts;
}

OfSources probabilities_of(const VerdictEvidence& evidence, bool fails) {
  const TrialCounts& counts = *evidence.trials;
  const auto share = [](std::int64_t hits, std::int64_t all) {
    return (static_cast<double>(hits) + 1.0) / (static_cast<double>(all) + 2.0);
  };
  OfSources probabilities;
  const double nothing =
      fails ? share(counts.healthy_above, counts.above) : share(counts.healthy_below, counts.below);
  probabilities[RecordSource::nothing] = nothing;
  double sum = 0.0;
  for (const RecordSource source : kFaultSources)
    sum += evidence.weights.of[source];
  const double trust = sum > 0.0 ? share(counts.right, counts.same) : 0.0;
  for (const RecordSource source : kFaultSources)
    probabilities[source] = (1.0 - nothing) * ((sum > 0.0 ? trust * evidence.weights.of[source] / sum : 0.0) +
                                               (1.0 - trust) / static_cast<double>(std::size(kFaultSources)));
  return probabilities;
}

RecordVerdict::Model model_answer(const VerdictEvidence& evidence, const std::vector<CvCost>& costs) {
  RecordVerdict::Model model;
  const auto known = !evidence.model_scores.array().isNaN();
  const bool has_scores = known.any() && !std::isnan(evidence.model_threshold);
  model.threshold = evidence.model_threshold;
  if (has_scores)
    model.score = known.select(evidence.model_scores.array(), -kInfinity).maxCoeff();
  model.at = unexplained_parts(evidence, costs);
  const bool fails = !model.at.empty();
  model.answer = fails                                                ? ModelAnswer::fails
                 : has_scores && evidence.least_visible <= kHalfAGain ? ModelAnswer::explains
                                                                      : ModelAnswer::cannot_tell;
  if (evidence.trials && (fails || has_scores))
    model.probabilities = probabilities_of(evidence, fails);
  model.late_is_corrected = evidence.late_is_corrected;
  if (evidence.late_is_corrected) {
    model.late = evidence.late;
    model.late_cvs = evidence.late_cvs;
  }
  if (!fails)
    return model;
  model.since = evidence.onset;
  const NamedSource named = named_source(evidence.weights);
  model.source = named.source;
  model.drifts = named.drifts;
  if (model.has_mismatch()) {
    model.mismatch = evidence.mismatch;
    model.md = evidence.md;
  }
  if (model.source == RecordSource::valve)
    model.valve_mv = evidence.valve_mv;
  if (model.source == RecordSource::sensor || model.drifts) {
    model.sensor_cv = evidence.sensor_cv;
    model.jumps = evidence.jumps;
  }
  if (model.source == RecordSource::sensor)
    model.stuck = evidence.stuck;
  if (model.source == RecordSource::data && !evidence.late_is_corrected) {
    model.late = evidence.late;
    model.late_cvs = evidence.late_cvs;
  }
  return model;
}

RecordVerdict::Loop loop_answer(const VerdictEvidence& evidence) {
  RecordVerdict::Loop loop;
  std::copy_if(evidence.costs.begin(), evidence.costs.end(), std::back_inserter(loop.costs),
               [](const CvCost& cost) { return !std::isnan(cost.ratio); });
  for (CvCost& cost : loop.costs)
    cost.threshold = std::isnan(cost.threshold) ? kNaN : std::max(cost.threshold, 1.0);
  std::stable_sort(loop.costs.begin(), loop.costs.end(), costs_more);
  const bool is_known = std::any_of(loop.costs.begin(), loop.costs.end(),
                                    [](const CvCost& cost) { return !std::isnan(cost.threshold); });
  const bool is_dearer =
      std::any_of(loop.costs.begin(), loop.costs.end(), [](const CvCost& cost) { return cost.is_dearer(); });
  loop.answer = is_dearer ? LoopAnswer::dearer : is_known ? LoopAnswer::as_designed : LoopAnswer::cannot_tell;
  return loop;
}

/// What to do about a mismatch.
RecordVerdict::Action action_on_channel(const VerdictEvidence& evidence, const RecordVerdict& verdict) {
  RecordVerdict::Action action{.kind = ActionKind::test};
  if (!verdict.model.mismatch)
    return action;
  action.channel = verdict.model.mismatch->channel;
  const bool is_dearer = verdict.loop.answer == LoopAnswer::dearer;
  if (!evidence.promise) {
    action.kind = is_dearer ? ActionKind::test : ActionKind::wait;
    return action;
  }
  const Eigen::VectorXd& ratio = evidence.promise->variance_ratio;
  for (Eigen::Index cv = 0; cv < ratio.size(); ++cv)
    if (ratio(cv) > kNoticeableChange)
      action.worsened.push_back(cv);
  if (!action.worsened.empty())
    return action;
  action.promise = evidence.promise;
  const bool has_size = evidence.tells_apart || !std::isnan(verdict.model.mismatch->size);
  if (evidence.promise->gain > (is_dearer ? kNoGain : evidence.worth))
    action.kind = has_size ? ActionKind::repair : ActionKind::test;
  else
    action.kind = is_dearer ? ActionKind::test : ActionKind::wait;
  return action;
}

RecordVerdict::Action action_on(const VerdictEvidence& evidence, const RecordVerdict& verdict) {
  const RecordVerdict::Model& model = verdict.model;
  const bool is_dearer = verdict.loop.answer == LoopAnswer::dearer;
  if (model.answer != ModelAnswer::fails) {
    if (is_dearer || !evidence.controller_is_alike)
      return {.kind = evidence.controller_is_alike ? ActionKind::limit : ActionKind::controller};
    if (model.late_is_corrected)
      return {.kind = ActionKind::column};
    return {.kind = model.answer == ModelAnswer::explains && verdict.loop.answer == LoopAnswer::as_designed
                        ? ActionKind::nothing
                        : ActionKind::wait};
  }
  if (model.at.front().is_noise)
    return {.kind = ActionKind::sensor, .cv = model.at.front().cv};
  if (model.drifts)
    return {.kind = ActionKind::sensor, .cv = model.sensor_cv < 0 ? model.at.front().cv : model.sensor_cv};
  switch (model.source) {
    case RecordSource::mismatch:
    case RecordSource::both:
      return action_on_channel(evidence, verdict);
    case RecordSource::disturbance:
      return {.kind = is_dearer ? ActionKind::disturbance : ActionKind::wait, .cv = model.at.front().cv};
    case RecordSource::sensor:
      return {.kind = ActionKind::sensor, .cv = model.sensor_cv < 0 ? model.at.front().cv : model.sensor_cv};
    case RecordSource::valve:
      return {.kind = model.valve_mv < 0 ? ActionKind::test : ActionKind::valve, .mv = model.valve_mv};
    case RecordSource::data:
      return {.kind = ActionKind::column};
    case RecordSource::nothing:
    case RecordSource::unknown:
      break;
  }
  return {.kind = ActionKind::test};
}

/// Keeps the changes of variances if they point the same way as the gain; otherwise keeps the gain alone.
std::optional<PromisedGain> in_agreement(std::optional<PromisedGain> promise) {
  if (!promise || promise->variance_ratio.size() == 0)
    return promise;
  const bool falls = (promise->variance_ratio.array() < 1.0).any(),
             rises = (promise->variance_ratio.array() > 1.0).any();
  if (promise->gain > 0.0 ? !falls : falls && !rises)
    promise->variance_ratio.resize(0);
  return promise;
}

/// Decides what becomes of the best period if no benchmark is in use.
RecordBenchmark decided_benchmark(const VerdictEvidence& evidence, ModelAnswer answer) {
  RecordBenchmark benchmark = evidence.benchmark;
  if (benchmark.use == BenchmarkUse::named || benchmark.use == BenchmarkUse::found)
    return benchmark;
  const bool is_asked = answer == ModelAnswer::fails && benchmark.is_wanted;
  const bool is_fit =
      benchmark.first < benchmark.end && !(benchmark.channel_score > evidence.model_threshold);
  benchmark.use = !is_asked ? BenchmarkUse::none : is_fit ? BenchmarkUse::proposed : BenchmarkUse::unfit;
  return benchmark;
}

}  // namespace

Eigen::Index RecordVerdict::named_cv() const {
  return !model.at.empty()                                          ? model.at.front().cv
         : !loop.costs.empty() && loop.answer == LoopAnswer::dearer ? loop.costs.front().cv
                                                                    : -1;
}

bool RecordVerdict::names_dearest() const {
  return loop.answer != LoopAnswer::dearer || loop.costs.front().cv == named_cv();
}

const char* RecordVerdict::found() const {
  if (model.answer == ModelAnswer::fails)
    return "fault";
  if (loop.answer == LoopAnswer::dearer)
    return controller_is_alike ? "unexplained_cost" : "other_controller";
  if (model.answer == ModelAnswer::cannot_tell && loop.answer == LoopAnswer::cannot_tell)
    return "none";
  return controller_is_alike ? "nothing" : "other_controller";
}

RecordVerdict record_verdict(const VerdictEvidence& evidence) {
  RecordVerdict verdict{.model = {}, .loop = loop_answer(evidence), .action = {}, .benchmark = {}};
  verdict.model = model_answer(evidence, verdict.loop.costs);
  verdict.benchmark = decided_benchmark(evidence, verdict.model.answer);
  verdict.has_trials = evidence.trials.has_value();
  verdict.controller_is_alike = evidence.controller_is_alike;
  verdict.action = action_on(evidence, verdict);
  verdict.action.promise = in_agreement(std::move(verdict.action.promise));
  return verdict;
}

}  // namespace mpm
