#include "analysis/validation/study_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/student.hpp"

namespace mpm {
namespace {

constexpr double kOftenInfeasible = 0.2;
constexpr double kWideInterval = 0.3;

/// The width of Wilson's interval of the rate `p` over about `loops` loops.
double interval_width(double p, double loops, double confidence) {
  const auto total = static_cast<std::int64_t>(std::llround(loops));
  const auto hits = static_cast<std::int64_t>(std::llround(p * static_cast<double>(total)));
  const Interval interval = wilson_interval(hits, total, confidence);
  return interval.upper - interval.lower;
}

/// The width of the interval of a rate over some loops in several worlds, and its limit with ever more loops.
struct WorldWidths {
  double now, limit;
};

WorldWidths world_widths(double p, double loops, int worlds, double confidence) {
  const double W = std::min(static_cast<double>(worlds), loops);
  const auto width = [&](double trials) {
    const Interval interval = score_interval(p, trials, confidence);
    return interval.upper - interval.lower;
  };
  if (W < 2.0)
    return {1.0, 1.0};
  const double t = two_sided_student_quantile(confidence, static_cast<std::int64_t>(W) - 1);
  const double shrink = std::pow(two_sided_normal_quantile(confidence) / t, 2);
  const double design = 1.0 + (loops / W - 1.0) * kWorldCorrelation;
  return {width(std::min(loops, loops / design * shrink)),
          width(static_cast<double>(worlds) / kWorldCorrelation * shrink)};
}

/// Replaces the widths of the intervals of independent loops by those of worlds.
void widen_for_worlds(const Study& study, StudyForecast& forecast) {
  forecast.worlds = study.world->count;
  const double confidence = study.aggregate.confidence;
  const WorldWidths detection = world_widths(0.5, forecast.loops_with_impact, forecast.worlds, confidence);
  const WorldWidths alarms = world_widths(0.05, forecast.loops_without_fault, forecast.worlds, confidence);
  forecast.detection_width = std::max(forecast.detection_width, detection.now);
  forecast.detection_width_limit = detection.limit;
  forecast.false_alarm_width = std::max(forecast.false_alarm_width, alarms.now);
  forecast.false_alarm_width_limit = alarms.limit;
}

double median_cost(std::span<const ExperimentRecord> pilot, std::size_t method) {
  std::vector<double> costs;
  for (const ExperimentRecord& record : pilot)
    if (record.status == ExperimentStatus::ok)
      costs.push_back(record.assessments[method].milliseconds);
  return costs.empty() ? 0.0 : upper_median(std::move(costs));
}

std::int64_t loop_bytes(const Study& study) {
  const Eigen::Index setpoints = study.controller.has_setpoints() ? study.cv_count() : 0;
  const Eigen::Index rows =
      2 * study.cv_count() + 2 * study.mv_count() + study.md_count() + setpoints;  // y, y_sim, u, u_target, d
  return static_cast<std::int64_t>(rows) * study.simulation.samples *
         static_cast<std::int64_t>(sizeof(double));
}

/// The reason on the first loop if the method has a verdict on no loop; empty if it has a verdict on some
/// loop.
std::string why_silent(std::span<const ExperimentRecord> pilot, std::size_t method) {
  std::string reason;
  for (const ExperimentRecord& record : pilot) {
    if (record.status != ExperimentStatus::ok)
      continue;
    if (record.assessments[method].answered())
      return "";
    if (reason.empty())
      reason = record.assessments[method].reason;
  }
  return reason;
}

}  // namespace

StudyForecast forecast(const Study& study, std::span<const ExperimentRecord> pilot) {
  std::int64_t ok = 0, faulty = 0, with_impact = 0, without_fault = 0, wrong = 0;
  for (const ExperimentRecord& record : pilot) {
    if (record.status != ExperimentStatus::ok)
      continue;
    ++ok;
    const bool fault = to_be_flagged(study, record, FlagTruth::fault);
    faulty += fault ? 1 : 0;
    without_fault += fault ? 0 : 1;
    with_impact += to_be_flagged(study, record, FlagTruth::impact) ? 1 : 0;
    wrong += !record.assessments.empty() && judge(study, record, record.assessments.front()).wrong() ? 1 : 0;
  }
  const double confidence = study.aggregate.confidence;
  const auto run = static_cast<std::int64_t>(pilot.size());
  StudyForecast forecast;
  forecast.experiments = study.experiment_count();
  forecast.feasible = rate(ok, run, confidence);
  forecast.impact = rate(with_impact, faulty, confidence);
  forecast.to_keep = rate(wrong, ok, confidence);
  const double scale = static_cast<double>(forecast.experiments) / static_cast<double>(run);
  forecast.loops_with_impact = scale * static_cast<double>(with_impact);
  const double faults = scale * static_cast<double>(faulty);
  if (faulty > 0)
    forecast.loops_with_impact_interval = {faults * forecast.impact.interval.lower,
                                           faults * forecast.impact.interval.upper};
  forecast.loops_without_fault = scale * static_cast<double>(without_fault);
  forecast.detection_width = interval_width(0.5, forecast.loops_with_impact, confidence);
  forecast.false_alarm_width = interval_width(0.05, forecast.loops_without_fault, confidence);
  if (study.world)
    widen_for_worlds(study, forecast);
  forecast.bytes_of_a_loop = loop_bytes(study);
  for (std::size_t m = 0; m < pilot.front().assessments.size(); ++m)
    forecast.methods.push_back({pilot.front().assessments[m].form->method().name, median_cost(pilot, m)});
  return forecast;
}

std::vector<StudyWarning> forecast_warnings(const Study& study, const StudyForecast& forecast,
                                            std::span<const ExperimentRecord> pilot) {
  std::vector<StudyWarning> warnings;
  const Rate& feasible = forecast.feasible;
  if (feasible.value < 1.0 - kOftenInfeasible)
    warnings.push_back({"experiments",
                        fmt::format("{} of {} loops of the pilot do not run to their end",
                                    feasible.total - feasible.hits, feasible.total),
                        "every rate leaves them out: widen hard limits, or draw smaller faults"});
  for (std::size_t m = 0; m < forecast.methods.size(); ++m)
    if (const std::string reason = why_silent(pilot, m); !reason.empty())
      warnings.push_back({"methods.names",
                          fmt::format("{} gives no verdict on any loop of the pilot: {}",
                                      forecast.methods[m].method, reason),
                          "leave it out, or give it what it needs"});
  if (study.names_scenarios())
    return warnings;
  if (forecast.impact.total > 0 && forecast.impact.hits == 0)
    warnings.push_back(
        {"experiments",
         fmt::format("none of the {} faults of the pilot has an impact", forecast.impact.total),
         "draw larger faults; otherwise rates over loops with impact have no loops"});
  else if (forecast.impact.total > 0 && forecast.detection_width > kWideInterval)
    warnings.push_back(
        {"experiments",
         fmt::format("about {:.0f} loops with impact: a rate of 0.5 over them is known to +- {:.2f}",
                     forecast.loops_with_impact, forecast.detection_width / 2.0),
         forecast.worlds == 0
             ? "four times as many experiments halve the interval"
             : fmt::format("the {} worlds are the limit: more experiments in them bring it to "
                           "+- {:.2f} at best, four times as many worlds (world.count) halve it",
                           forecast.worlds, forecast.detection_width_limit / 2.0)});
  return warnings;
}

}  // namespace mpm
