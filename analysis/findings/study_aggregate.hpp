#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/false_alarms.hpp"
#include "analysis/findings/s0_curves.hpp"
#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/regression.hpp"

namespace mpm {

/// Least, mean and largest value of a quantity over experiments, with a t interval of the mean.
struct SampleSummary {
  std::int64_t count = 0;
  double least = std::numeric_limits<double>::quiet_NaN();
  double mean = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
  Interval mean_interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
};

/// Summary of `values` without its NaNs; the interval needs two values.
SampleSummary summarise(const std::vector<double>& values, double confidence);

/// What the experiments of one kind show.
struct KindAggregate {
  ExperimentKind kind = ExperimentKind::none;
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  Rate infeasible;  ///< of the experiments that did not fail
  Rate impactful;   ///< of the feasible ones
  /// Ivar_basis against Ivar over all CVs of all feasible experiments (figures 6.18, 6.22), and CV by CV.
  LinearFitIntervals regression;
  std::vector<LinearFitIntervals> regression_of_cv;
  ConfusionMatrix confusion{1};  ///< true CV against located CV over the impactful experiments (6.20, 6.23)
  Rate located;                  ///< its accuracy
  /// Experiments whose I_MPM lies on the side of the threshold that their single fault belongs to (6.21),
  /// over the population that the study names. No trials for experiments with both faults.
  Rate source_recognised;
  SampleSummary i_mpm;  ///< over the same population
};

/// I_MPM of the experiments with both faults whose dominance lies in [lower, upper) (figure 6.24).
struct DominanceBin {
  double lower, upper;
  SampleSummary i_mpm;
  Rate above_threshold;
};

/// All that a study reports, each number with its uncertainty.
struct StudyAggregate {
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  Rate infeasible;
  std::vector<KindAggregate> kinds;  ///< the kinds with a fault that the study has: mpm, ud, mpm_ud
  std::vector<DominanceBin>
      dominance;  ///< edges 0, 0.3, 0.5, 0.7, 1; empty without experiments of both faults
  std::optional<S0Changes> s0_changes;    ///< none in a study that does not perturb S0
  std::vector<FalseAlarms> false_alarms;  ///< empty without healthy experiments and bad tunings
};

/// One number of an aggregate under the name by which studies, gates and people refer to it.
struct AggregateValue {
  std::string name;
  std::string description;
  double value;
  Interval interval;   ///< NaN ends where there is none
  std::int64_t count;  ///< experiments (or pairs, for regressions) behind it
};

/// Aggregates the experiments of a study; the order of `records` does not matter beyond the last bits.
StudyAggregate aggregate(const Study& study, std::span<const ExperimentRecord> records);

/// The headline numbers by name, e.g. `infeasible`, `mpm.r_squared`, `ud.source_recognised`,
/// `mpm_ud.located`, `false_alarm_healthy`.
std::vector<AggregateValue> named_values(const StudyAggregate& aggregate);

/// Can the number of this name have an interval? Least and largest values never have one.
bool has_interval(std::string_view name);

}  // namespace mpm
