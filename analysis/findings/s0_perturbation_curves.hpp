#pragma once

#include <cstdint>
#include <vector>

#include "analysis/findings/collector.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"

// The effect of the modified models of s0_perturbation.hpp on Ivar_diag over the experiments of a study.

namespace mpm {

/// Five numbers of Ivar_diag(modified)/Ivar_diag(true) over experiments.
struct RatioSpread {
  double least, lower_quartile, median, upper_quartile, largest;
};

/// How far Ivar_diag moves while the multiplier stays within the tolerance of the study.
struct S0Change {
  /// Largest |ratio - 1| over experiments and multipliers.
  double largest = kNaN;
  /// Experiments whose ratio stays within the band of impact.
  Rate within_band;
};

/// The ratios of the experiments whose affected CV is `cv`, multiplier by multiplier (figures 6.27 to 6.29).
struct S0Curve {
  Eigen::Index cv;
  std::int64_t experiments = 0;
  std::vector<RatioSpread> time_constant, damping;  ///< one per multiplier of the study
  S0Change time_constant_change, damping_change;
};

/// Collects the curves of the CVs that have such experiments, in the order of the CVs. Leaves out ratios that
/// are not finite. `study` must outlive the collector.
Collector<std::vector<S0Curve>> s0_curve_collector(const Study& study);

/// The same change over the experiments of all CVs.
struct S0Changes {
  S0Change time_constant, damping;
};
Collector<S0Changes> s0_change_collector(const Study& study);

}  // namespace mpm
