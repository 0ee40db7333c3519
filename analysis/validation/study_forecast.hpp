#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/validation/study_warnings.hpp"

namespace mpm {

/// The forecast of a study from its first experiments (a pilot). For any N, the first N experiments have the
/// proportions of the whole study.
///
/// The loops of a world share its model errors and its benchmark. With the correlation rho of two verdicts in
/// one world (kWorldCorrelation), n loops spread over W worlds are worth
///
///     min(n, n / (1 + (n / W - 1) rho) (z / t)^2)
///
/// independent loops, with t for W - 1 degrees of freedom (clustered_rate()), and at most W / rho (z / t)^2.
struct StudyForecast {
  std::int64_t experiments = 0;  ///< of the whole study
  Rate feasible;                 ///< of the pilot: status ok
  Rate impact;                   ///< of the feasible loops with a fault: the fault has an impact
  Rate to_keep;                  ///< of the feasible loops: the first method is wrong, StorePolicy::flagged
  double loops_with_impact = 0;  ///< expected in the whole study; the interval is from `impact`
  Interval loops_with_impact_interval{0, 0};
  double loops_without_fault = 0;
  /// Width of Wilson's interval of a rate of 1/2 over the loops with impact, and of a rate of 1/20 over the
  /// loops without a fault: how precise the rates of the study will be. 1 without loops.
  double detection_width = 1;
  double false_alarm_width = 1;
  int worlds = 0;  ///< drawn at random, which the intervals take into account; 0: none
  /// With worlds: the limits of the two widths with ever more loops in the same worlds.
  double detection_width_limit = 1, false_alarm_width_limit = 1;
  std::int64_t bytes_of_a_loop = 0;  ///< its data in an archive, before compression
  /// Median processor time of an assessment by each method of the study, ms.
  struct MethodCost {
    std::string method;
    double milliseconds;
  };
  std::vector<MethodCost> methods;
};

/// The approximate correlation of the verdicts of one method on loops in one world: see docs/methods.md.
inline constexpr double kWorldCorrelation = 0.3;

/// Makes the forecast from `pilot`, the first experiments of the study, at least one.
StudyForecast forecast(const Study& study, std::span<const ExperimentRecord> pilot);

/// Returns warnings about what the pilot shows: many loops that do not run to their end, methods without a
/// verdict on any loop, faults of which none has an impact, rates that the study will not determine well.
std::vector<StudyWarning> forecast_warnings(const Study& study, const StudyForecast& forecast,
                                            std::span<const ExperimentRecord> pilot);

}  // namespace mpm
