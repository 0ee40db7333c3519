#include "analysis/findings/study_aggregate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "analysis/experiment/verdict.hpp"
#include "scenarios/random_stream.hpp"

namespace mpm {
namespace {

constexpr std::array<double, 5> kDominanceEdges{0.0, 0.3, 0.5, 0.7, 1.0};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Pairs (Ivar, Ivar_basis) of the CVs [first, last) of the feasible experiments, experiment by experiment.
struct IvarPairs {
  std::vector<double> x, y;
  std::vector<std::int64_t> experiment;

  void add(const ExperimentRecord& record, Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index cv = first; cv < last; ++cv) {
      x.push_back(record.diagnosis.ivar(cv));
      y.push_back(record.diagnosis.ivar_basis(cv));
      experiment.push_back(record.draw.index);
    }
  }

  LinearFitIntervals fit(const Study& study, std::uint64_t which) const {
    RandomStream stream(study.seed, which, StreamId::bootstrap);
    const auto size = static_cast<Eigen::Index>(x.size());
    return cluster_bootstrap(Eigen::Map<const Eigen::VectorXd>(x.data(), size),
                             Eigen::Map<const Eigen::VectorXd>(y.data(), size), experiment, stream,
                             {study.aggregate.bootstrap_replications, study.aggregate.confidence});
  }
};

void fit_regressions(const Study& study, std::span<const ExperimentRecord> records, KindAggregate& result) {
  const Eigen::Index ny = study.cv_count();
  IvarPairs all;
  std::vector<IvarPairs> of_cv(static_cast<std::size_t>(ny));
  for (const ExperimentRecord& record : records) {
    if (record.draw.kind != result.kind || record.status != ExperimentStatus::ok)
      continue;
    all.add(record, 0, ny);
    for (Eigen::Index cv = 0; cv < ny; ++cv)
      of_cv[static_cast<std::size_t>(cv)].add(record, cv, cv + 1);
  }
  // A bootstrap stream of its own for every fit, so that no fit depends on which others are made.
  const auto first = static_cast<std::uint64_t>(result.kind) * static_cast<std::uint64_t>(ny + 1);
  result.regression = all.fit(study, first);
  for (Eigen::Index cv = 0; cv < ny; ++cv)
    result.regression_of_cv.push_back(
        of_cv[static_cast<std::size_t>(cv)].fit(study, first + 1 + static_cast<std::uint64_t>(cv)));
}

KindAggregate aggregate_kind(const Study& study, std::span<const ExperimentRecord> records,
                             ExperimentKind kind) {
  const double confidence = study.aggregate.confidence;
  KindAggregate result;
  result.kind = kind;
  result.confusion = ConfusionMatrix(study.cv_count());
  std::int64_t feasible = 0, infeasible = 0, judged = 0, recognised = 0;
  std::vector<double> i_mpm;
  for (const ExperimentRecord& record : records) {
    if (record.draw.kind != kind)
      continue;
    ++result.experiments;
    if (record.status == ExperimentStatus::failed)
      ++result.failed;
    if (record.status == ExperimentStatus::infeasible)
      ++infeasible;
    if (record.status != ExperimentStatus::ok)
      continue;
    ++feasible;
    if (record.diagnosis.impactful)
      result.confusion.add(record.draw.true_cv(), record.diagnosis.predicted_cv);
    if (in_source_population(study, record))
      i_mpm.push_back(record.diagnosis.indicator.i_mpm);
    const Verdict source = source_verdict(study, record);
    judged += source == Verdict::none ? 0 : 1;
    recognised += source == Verdict::right ? 1 : 0;
  }
  result.infeasible = rate(infeasible, feasible + infeasible, confidence);
  result.impactful = rate(result.confusion.total(), feasible, confidence);
  result.located = result.confusion.accuracy(confidence);
  result.i_mpm = summarise(i_mpm, confidence);
  result.source_recognised = rate(recognised, judged, confidence);
  fit_regressions(study, records, result);
  return result;
}

std::vector<DominanceBin> aggregate_dominance(const Study& study, std::span<const ExperimentRecord> records) {
  std::vector<DominanceBin> bins;
  for (std::size_t b = 0; b + 1 < kDominanceEdges.size(); ++b) {
    const double lower = kDominanceEdges[b];
    const double upper = kDominanceEdges[b + 1];
    const bool last = b + 2 == kDominanceEdges.size();
    std::vector<double> i_mpm;
    std::int64_t above = 0;
    for (const ExperimentRecord& record : records) {
      if (record.draw.kind != ExperimentKind::mpm_ud || !in_source_population(study, record))
        continue;
      const double dominance = record.dominance_mpm;
      if (!(dominance >= lower && (dominance < upper || (last && dominance <= upper))))
        continue;
      i_mpm.push_back(record.diagnosis.indicator.i_mpm);
      if (record.diagnosis.indicator.i_mpm > study.diagnosis.mpm_threshold)
        ++above;
    }
    bins.push_back({lower, upper, summarise(i_mpm, study.aggregate.confidence),
                    rate(above, static_cast<std::int64_t>(i_mpm.size()), study.aggregate.confidence)});
  }
  return bins;
}

AggregateValue of_rate(std::string name, std::string description, const Rate& value) {
  return {std::move(name), std::move(description), value.value, value.interval, value.total};
}

void add_change(std::vector<AggregateValue>& values, const std::string& of, const char* parameter,
                const S0Change& change) {
  values.push_back({of + ".largest_change",
                    fmt::format("largest relative change of Ivar_diag, {} of S0 within tolerance", parameter),
                    change.largest,
                    {kNaN, kNaN},
                    change.within_band.total});
  values.push_back(
      of_rate(of + ".within_band",
              fmt::format("experiments whose Ivar_diag stays in band, {} of S0 within tolerance", parameter),
              change.within_band));
}

/// All shares of a kind; of one parameter that was changed the false alarms only.
void add_false_alarms(std::vector<AggregateValue>& values, const FalseAlarms& group) {
  const std::string name = group.name();
  const auto add = [&](const char* quantity, const std::string& description, const Rate& share) {
    values.push_back(of_rate(fmt::format("{}_{}", quantity, name), description, share));
  };
  if (!group.parameter)
    add("infeasible", "share of infeasible experiments", group.infeasible);
  add("false_alarm", "share of experiments with impact where model and plant agree", group.false_alarm);
  if (group.parameter)
    return;
  add("false_mpm", "share of experiments in which the false alarm is a mismatch", group.false_mpm);
  add("false_ud", "share of experiments in which the false alarm is a disturbance", group.false_ud);
}

}  // namespace

SampleSummary summarise(const std::vector<double>& values, double confidence) {
  SampleSummary summary;
  double sum = 0.0;
  for (const double value : values) {
    if (std::isnan(value))
      continue;
    summary.least = summary.count == 0 ? value : std::min(summary.least, value);
    summary.largest = summary.count == 0 ? value : std::max(summary.largest, value);
    sum += value;
    ++summary.count;
  }
  if (summary.count == 0)
    return summary;
  const auto n = static_cast<double>(summary.count);
  summary.mean = sum / n;
  if (summary.count < 2)
    return summary;
  double squares = 0.0;
  for (const double value : values)
    if (!std::isnan(value))
      squares += (value - summary.mean) * (value - summary.mean);
  const boost::math::students_t student(n - 1.0);
  const double half =
      boost::math::quantile(student, 0.5 + 0.5 * confidence) * std::sqrt(squares / (n - 1.0) / n);
  summary.mean_interval = {summary.mean - half, summary.mean + half};
  return summary;
}

StudyAggregate aggregate(const Study& study, std::span<const ExperimentRecord> records) {
  StudyAggregate result;
  std::int64_t infeasible = 0;
  for (const ExperimentRecord& record : records) {
    ++result.experiments;
    if (record.status == ExperimentStatus::failed)
      ++result.failed;
    if (record.status == ExperimentStatus::infeasible)
      ++infeasible;
  }
  result.infeasible = rate(infeasible, result.experiments - result.failed, study.aggregate.confidence);
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud})
    if (study.experiments.of(kind) > 0)
      result.kinds.push_back(aggregate_kind(study, records, kind));
  if (study.experiments.mpm_ud > 0)
    result.dominance = aggregate_dominance(study, records);
  if (!study.s0_perturbation.multipliers.empty())
    result.s0_changes = s0_changes(study, records);
  result.false_alarms = false_alarms(study, records);
  return result;
}

std::vector<AggregateValue> named_values(const StudyAggregate& aggregate) {
  std::vector<AggregateValue> values;
  values.push_back(of_rate("infeasible", "share of infeasible experiments", aggregate.infeasible));
  for (const KindAggregate& kind : aggregate.kinds) {
    const std::string of(to_string(kind.kind));
    const SampleSummary& i_mpm = kind.i_mpm;
    values.push_back(of_rate(of + ".infeasible", "share of infeasible experiments", kind.infeasible));
    values.push_back(
        of_rate(of + ".impactful", "share of impactful ones among the feasible", kind.impactful));
    values.push_back({of + ".r_squared", "R^2 of Ivar_basis on Ivar, all CVs", kind.regression.fit.r_squared,
                      kind.regression.r_squared, kind.regression.fit.pairs});
    values.push_back({of + ".slope", "slope of Ivar_basis on Ivar, all CVs", kind.regression.fit.slope,
                      kind.regression.slope, kind.regression.fit.pairs});
    values.push_back(
        of_rate(of + ".located", "CV located by Ivar_diag, impactful experiments", kind.located));
    if (kind.kind != ExperimentKind::mpm_ud)
      values.push_back(of_rate(of + ".source_recognised", "I_MPM on the right side of its threshold",
                               kind.source_recognised));
    values.push_back({of + ".i_mpm_min", "smallest I_MPM", i_mpm.least, {kNaN, kNaN}, i_mpm.count});
    values.push_back({of + ".i_mpm_mean", "mean I_MPM", i_mpm.mean, i_mpm.mean_interval, i_mpm.count});
    values.push_back({of + ".i_mpm_max", "largest I_MPM", i_mpm.largest, {kNaN, kNaN}, i_mpm.count});
  }
  for (const DominanceBin& bin : aggregate.dominance)
    values.push_back({fmt::format("mpm_ud.i_mpm_mean_at_dominance_{:g}_to_{:g}", bin.lower, bin.upper),
                      fmt::format("mean I_MPM at dominance {:g} to {:g}", bin.lower, bin.upper),
                      bin.i_mpm.mean, bin.i_mpm.mean_interval, bin.i_mpm.count});
  if (aggregate.s0_changes) {
    add_change(values, "s0_time_constant", "time constant", aggregate.s0_changes->time_constant);
    add_change(values, "s0_damping", "damping", aggregate.s0_changes->damping);
  }
  for (const FalseAlarms& group : aggregate.false_alarms)
    add_false_alarms(values, group);
  return values;
}

bool has_interval(std::string_view name) {
  return !name.ends_with(".i_mpm_min") && !name.ends_with(".i_mpm_max") && !name.ends_with(".largest_change");
}

}  // namespace mpm
