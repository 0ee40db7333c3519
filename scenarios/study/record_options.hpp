#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/enum_words.hpp"
#include "plants/output_sampling.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/random/distribution.hpp"

namespace mpm {

/// What a reader of the record finds where a sample is missing.
enum class GapFill {
  none,    ///< nothing: NaN
  hold,    ///< the last value before the gap
  linear,  ///< the straight line between the values on both sides of the gap
};

/// What replaces a bad value.
enum class BadValue : std::int8_t {
  stuck = 0,      ///< the last good one
  off_scale = 1,  ///< one far off, always the same
};

template <>
inline constexpr auto kWords<BadValue> = word_list("stuck", "off_scale");

/// How the historian stores the measured CVs (historian.hpp). By default: every sample, as it was measured.
/// The sizes are in standard deviations of the measurement noise of the CV
/// (SimulationOptions::noise_standard_deviation), by which ranges and resolutions of transmitters are chosen.
struct RecordOptions {
  static constexpr int kMostCandidates = 9;  ///< each has a stream of its own
  /// The largest shifts of rows, samples. kMostEarly is 1 because a loop goes on for one sample after its
  /// last row.
  static constexpr int kMostLate = 10, kMostEarly = 1;

  /// How the CVs are sampled, and by how many samples the rows of each CV, MV and MD are later than their
  /// number says (scenarios/loop/record_rows); empty: by none.
  OutputSampling sampling = OutputSampling::snapshot;
  std::vector<double> cv_shift = {}, mv_shift = {}, md_shift = {};
  double outlier_share = 0.0;                              ///< of the samples of each CV, drawn one by one
  Distribution outlier_size = Distribution::constant(10);  ///< added, with either sign
  double quantisation = 0.0;                               ///< step between two values; 0: none
  double missing_share = 0.0;                              ///< of the samples of each CV, in the long run
  double missing_length = 1.0;                             ///< mean length of a gap, samples
  GapFill fill = GapFill::none;
  double bad_share = 0.0;   ///< of the samples of each CV that are bad, in the long run
  double bad_length = 1.0;  ///< mean length of a spell of bad values, samples
  BadValue bad_value = BadValue::stuck;
  double bad_size = 20.0;        ///< of a value that is off scale, from the operating point
  bool bad_quality = false;      ///< the record has their quality, so that its reader makes them gaps
  double exception = 0.0;        ///< largest change since the last report that is not reported; 0: all are
  double compression = 0.0;      ///< largest deviation that the historian allows; 0: it keeps every sample
  int candidates = 0;            ///< further signals that the historian keeps (logged_candidates)
  double candidate_share = 0.5;  ///< of the disturbed loops in which one of them drives the disturbance

  const std::vector<double>& shifts_of(VariableSort sort) const {
    return sort == VariableSort::cv ? cv_shift : sort == VariableSort::mv ? mv_shift : md_shift;
  }
  /// Do rows of CVs differ from their measurements at the samples?
  bool resamples() const {
    return sampling == OutputSampling::average ||
           std::any_of(cv_shift.begin(), cv_shift.end(), [](double shift) { return shift != 0.0; });
  }
  /// The same for any variable.
  bool moves_rows() const { return resamples() || !mv_shift.empty() || !md_shift.empty(); }
  /// Do rows need the plant between the samples?
  bool looks_between_samples() const {
    return sampling == OutputSampling::average ||
           std::any_of(cv_shift.begin(), cv_shift.end(),
                       [](double shift) { return shift != static_cast<double>(static_cast<int>(shift)); });
  }
  /// Whether the historian changes the measurements of the CVs in any way.
  bool alters() const {
    return resamples() || outlier_share > 0.0 || quantisation > 0.0 || missing_share > 0.0 ||
           bad_share > 0.0 || exception > 0.0 || compression > 0.0;
  }

  bool operator==(const RecordOptions&) const = default;
};

}  // namespace mpm
