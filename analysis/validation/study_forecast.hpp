#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/validation/study_warnings.hpp"

namespace mpm {

/// What a study will be, by its first experiments (a pilot): any first N of them keep the proportions of the
/// whole.
///
/// The loops of a world share its errors of the model and its benchmark. With the correlation rho of two
/// verdicts in one world (kWorldCorrelation), n loops spread over W worlds are worth
///
///     min(n, n / (1 + (n / W - 1) rho) (z / t)^2)
///
/// independent ones, t with W - 1 degrees of freedom (clustered_rate()), and W / rho (z / t)^2 at most.
struct StudyForecast {
  std::int64_t experiments = 0;  ///< of the whole study
  Rate feasible;                 ///< of the pilot: status ok
  Rate impact;                   ///< of the feasible ones with a fault: the fault has an impact
  Rate to_keep;                  ///< of the feasible ones: the first method is wrong, StorePolicy::flagged
  double loops_with_impact = 0;  ///< expected in the whole study, and where `impact` has its interval
  Interval loops_with_impact_interval{0, 0};
  double loops_without_fault = 0;
  /// Width of Wilson's interval of a rate of 1/2 over the loops with impact, and of one of 1/20 over those
  /// without a fault: how precise the rates of the study will be. 1 without a loop.
  double detection_width = 1;
  double false_alarm_width = 1;
  int worlds = 0;  ///< drawn at random, of which the intervals are; 0: none
  /// With worlds: the limits of the two widths for ever more loops in the same worlds.
  double detection_width_limit = 1, false_alarm_width_limit = 1;
  std::int64_t bytes_of_a_loop = 0;  ///< its data in an archive, before compression
  /// Median processor time of an assessment by each method of the study, ms.
  struct MethodCost {
    std::string method;
    double milliseconds;
  };
  std::vector<MethodCost> methods;
};

/// Of verdicts of one method on loops in one world, about: see docs/methods.md.
inline constexpr double kWorldCorrelation = 0.3;

/// `pilot` are the first experiments of the study, one at least.
StudyForecast forecast(const Study& study, std::span<const ExperimentRecord> pilot);

/// What the pilot shows: loops that cannot be run, methods that say nothing of any loop, no impact or too
/// many, rates that the study will not know well.
std::vector<StudyWarning> forecast_warnings(const Study& study, const StudyForecast& forecast,
                                            std::span<const ExperimentRecord> pilot);

}  // namespace mpm
