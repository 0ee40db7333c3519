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

/// What a method names, as the sources of a record have it.
RecordSource record_source(FaultSource source, ToldSource told);
/// The same the other way, as CvAssessment::source and about.
std::pair<FaultSource, ToldSource> told_source(RecordSource source);

/// The posterior of `likelihood`. Where `said` has a source for its worst CV, another one than the most
/// probable one there, this and the most probable one of the loop change places: it has asked more. Where it
/// leaves open whether it is a mismatch or a disturbance, both are as probable.
OfSources source_weights(const Assessment& likelihood, const Assessment& said);

/// Weights of the sources, and what they have of a CV that drifts.
struct SourceWeights {
  OfSources of = {};
  /// Part of the weights of sensor and of disturbance each: in a closed loop a sensor that drifts and a
  /// disturbance on its CV that grows as fast look the same.
  double drift = 0.0;
};

/// The weights where further hypotheses count, each by its likelihood: mismatch and both, and disturbance, as
/// probable before as `weights` has them, at least 1 in 100; valve, drift and data a tenth as probable, a
/// drift by either of its causes.
SourceWeights with_comparison(const OfSources& weights, const FaultLikelihoods& found);

/// The source with the largest weight, a drift by both of its causes together as that of the sensor; unknown
/// where none has a weight.
RecordSource heaviest(const SourceWeights& weights);

/// The source that weights name: the heaviest one, and of a drift the heavier one of its causes.
struct NamedSource {
  RecordSource source = RecordSource::unknown;
  bool drifts = false;  ///< by either of its causes
};
NamedSource named_source(const SourceWeights& weights);

/// What the inputs tell of the errors beside the heaviest source (FaultComparison::dependence_beside()) is r
/// times what they tell in loops without a mismatch: with r > 1, 1 - 1 / r^2 of its weight goes to none of
/// these.
SourceWeights with_none_of_these(SourceWeights weights, double r);

/// The numbers by which a method says weights, and what is most likely of each source:
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

/// What an answer says of them; none where it has asked nothing of noise of any shape.
SourceWeights stated_weights(const AssessmentRecord& said);
std::optional<FaultLikelihoods> stated_likeliest(const AssessmentRecord& said);

}  // namespace mpm
