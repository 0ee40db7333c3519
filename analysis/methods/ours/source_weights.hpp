#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "analysis/methods/assessment.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/methods/ours/record_source.hpp"

// How probable each sort of fault is in a loop, given that there is one: what the likelihood says, and what
// noise of any shape leaves of it.

namespace mpm {

/// The source of a record that corresponds to what a method names.
RecordSource record_source(FaultSource source, ToldSource told);
/// The reverse: CvAssessment::source and about for a source of a record.
std::pair<FaultSource, ToldSource> told_source(RecordSource source);

/// The posterior of `likelihood`. If `said` names a source for its worst CV that is not the most probable one
/// there, this source and the most probable one of the loop change places, since `said` has asked more. If
/// `said` leaves open whether it is a mismatch or a disturbance, both are equally probable.
OfSources source_weights(const Assessment& likelihood, const Assessment& said);

/// Weights of the sources, and the part of them that belongs to a CV that drifts.
struct SourceWeights {
  OfSources of = {};
  /// This part is in the weight of the sensor and in that of the disturbance: in a closed loop a sensor that
  /// drifts and a disturbance on its CV that grows as fast look the same.
  double drift = 0.0;
};

/// The weights if further hypotheses count, each by its likelihood. Beforehand a mismatch, alone or with a
/// disturbance, and a disturbance alone are as probable as in `weights`, but at least 1 in 100. Valve, drift
/// and data are a tenth as probable, a drift for each of its causes.
SourceWeights with_comparison(const OfSources& weights, const FaultLikelihoods& found);

/// The source with the largest weight. A drift counts as the sensor's, both of its causes together. Unknown
/// if no source has a weight.
RecordSource heaviest(const SourceWeights& weights);

/// The source that the weights name. If a drift outweighs all others, it is the heavier one of its causes;
/// otherwise it is the source with the largest weight, its part of a drift included.
struct NamedSource {
  RecordSource source = RecordSource::unknown;
  bool drifts = false;  ///< by either of its causes
};
NamedSource named_source(const SourceWeights& weights);

/// Moves weight from the heaviest source to "none of these". r is what the inputs tell about the errors
/// beside this source (FaultComparison::dependence_beside()), over what they tell in loops without a
/// mismatch. If r > 1, the part 1 - 1 / r^2 of the weight is moved.
SourceWeights with_none_of_these(SourceWeights weights, double r);

/// The numbers by which a method states the weights, and the most likely fault of each source:
///
/// | number                                      | meaning                                               |
/// |---------------------------------------------|-------------------------------------------------------|
/// | q_mismatch ... q_none_of_these              | SourceWeights::of                                     |
/// | q_drift                                     | SourceWeights::drift                                  |
/// | likely_cv, likely_mv, likely_parameter      | FaultLikelihoods::named                               |
/// | likely_md                                   | FaultLikelihoods::md                                  |
/// | sensor_cv, sensor_jumps, sensor_stuck, late | those of FaultLikelihoods                             |
/// | stem_mv, late_cv                            | valve_mv, data_cv                                     |
/// | dependence                                  | dependence_beside() the heaviest one                  |
std::vector<AssessmentNumberInfo> source_weight_numbers();
void add_weights(const SourceWeights& weights, Assessment& assessment);
void add_likeliest(const FaultLikelihoods& found, Assessment& assessment);

/// The weights and the likeliest faults that an answer states; none if it did not compare sources beside
/// noise of any shape.
SourceWeights stated_weights(const AssessmentRecord& said);
std::optional<FaultLikelihoods> stated_likeliest(const AssessmentRecord& said);

}  // namespace mpm
