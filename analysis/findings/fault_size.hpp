#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/experiment/record_range.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// The measures of how large a fault is.
enum class FaultSize {
  gain_factor,            ///< of the mismatched channel, 1: none
  time_constant_factor,   ///< of the mismatched channel, 1: none
  dead_time_shift,        ///< of the mismatched channel, in the time unit of the plant, 0: none
  disturbance_deviation,  ///< standard deviation of the unmeasured disturbance, in the unit of the CV
};

template <>
inline constexpr auto kWords<FaultSize> = word_list("gain_factor", "time_constant_factor", "dead_time_shift",
                                                    "disturbance_deviation");

/// Stationary standard deviation of y_d = gain / (time_constant s + 1) v, for white v of standard deviation
/// `v_deviation` held over each sample:
///
///   sigma = |gain| v_deviation sqrt((1 - a)/(1 + a)),   a = exp(-Ts/time_constant)
double disturbance_deviation(const Disturbance& disturbance, double v_deviation, double sample_time);

/// One experiment with a single fault and a verdict: how large the fault is and what came of it.
struct SizedFault {
  std::int64_t experiment;  ///< its index
  double size;
  bool flagged;    ///< the fault is seen
  bool diagnosed;  ///< seen, and both the CV and the source are right
};

/// Returns the experiments whose only fault is measured by `size` and on which the method at place `method`
/// of the assessments gave a verdict, the smallest fault first.
std::vector<SizedFault> faults_by_size(const Study& study, std::size_t method, const RecordRange& records,
                                       FaultSize size);

/// Faults of similar size, with the share that is flagged and the share that is diagnosed correctly. Both are
/// shares of all faults of the bin.
struct SizeBin {
  double smallest, median, largest;
  Rate flagged;
  Rate diagnosed;
};

/// Cuts `faults` (in ascending order) into `bins` parts with as nearly equal numbers as possible. Each share
/// then has about the same uncertainty, whatever the distribution of the sizes. Returns fewer parts if there
/// are fewer faults.
/// @throws InputError unless bins >= 1 and 0 < confidence < 1
std::vector<SizeBin> size_bins(std::span<const SizedFault> faults, int bins, double confidence);

}  // namespace mpm
