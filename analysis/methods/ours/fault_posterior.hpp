#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/cv_evidence.hpp"
#include "analysis/methods/source_probabilities.hpp"

namespace mpm {

/// Which faults the method `likelihood` takes to be possible besides one wrong parameter of a channel, a
/// disturbance on an output, and both of them.
enum class FaultHypotheses : std::int8_t {
  learnt = 0,  ///< all if errors of the model are learnt, otherwise the basic ones
  basic = 1,   ///< none besides these
  /// a mismatch that begins within the record and grows; a disturbance on an MV; a valve that sticks; a
  /// sensor with a bias, a drift, or that is stuck, and a wrong measurement of an MD
  all = 2,
};

/// Options of the method `likelihood`, analysis/methods/ours/likelihood_method.
struct LikelihoodOptions {
  FaultPriors priors = FaultPriors::wide;
  FaultHypotheses hypotheses = FaultHypotheses::learnt;
  double fault_probability = 0.5;  ///< of some fault in a loop before the record is seen, with wide priors
  double flag_probability = 0.5;   ///< a loop or a CV is flagged if a fault is more probable than this
  /// A source is named if it is at least this probable, given that there is a fault; 0: always.
  double source_probability = 0.0;
  JudgedMismatches judged = JudgedMismatches::nearest;

  bool operator==(const LikelihoodOptions&) const = default;
};

/// The probabilities, given the record, of the faults of each CV and of those of the loop.
struct FaultProbabilities {
  struct OfCv {
    double mpm, ud, both;  ///< P(this CV has this fault)
    double log_odds;       ///< log(P(some fault of this CV) / P(none))
    double other = 0.0;    ///< as `mpm`, for a fault that is neither
    double sensor = 0.0;   ///< the part of `other` that belongs to sensors

    double fault() const { return mpm + ud + both + other; }
  };
  double healthy, mpm, ud, both;  ///< of the loop; with `other` they sum to 1
  double log_odds;                ///< log((1 - healthy) / healthy)
  std::vector<OfCv> cvs;
  double other = 0.0;
  double sensor = 0.0;  ///< the part of `other` that belongs to sensors
};

/// Combines priors and evidence of all CVs. If a loop has at most one fault, the weight of each fault is
/// prior times evidence. If it may have several, the CVs are independent of each other: let h_i, m_i, u_i,
/// b_i be the probabilities that CV i has nothing, a mismatch, a disturbance, or both. Then nothing is wrong
/// in the loop with the probability prod h_i, and there are mismatches alone with prod (h_i + m_i) - prod
/// h_i. A sensor beside a mismatch or a disturbance is not a fault of its own.
FaultProbabilities fault_probabilities(const FaultPriorSet& priors, const std::vector<CvEvidence>& evidence);

/// The same if a fault of an MV, which moves several CVs at once, may be the only fault instead. Its weight
/// against nothing is e^`log_weight`. It shows in those CVs that show a fault by themselves. A disturbance on
/// the MV counts as a disturbance, a sticking valve as neither disturbance nor mismatch. A wrong measurement
/// of an MD, which moves the model of several CVs, is counted in the same way.
FaultProbabilities with_input_disturbance(FaultProbabilities probabilities, double log_weight);
FaultProbabilities with_sticky_valve(FaultProbabilities probabilities, double log_weight);
FaultProbabilities with_wrong_md(FaultProbabilities probabilities, double log_weight);

/// How often each source is true if the evidence speaks for `seen`, in loops in which errors of the model are
/// learnt. No list of hypotheses has all faults, errors and backgrounds of a plant. What is missing in the
/// list looks like one of its hypotheses, most often like mismatch and disturbance together, which can take
/// any shape. The numbers are shares of the loops of the standard suite on four plants under the development
/// seed 7.
const SourceProbabilities& true_sources(FaultSource seen);

/// The method `likelihood` and, with the priors of the study, the ceiling of what any method can do on it.
std::unique_ptr<AssessmentMethod> make_fault_posterior(const AssessmentContext& context, FaultPriors priors);

/// The numbers that this method gives.
std::vector<AssessmentNumberInfo> fault_posterior_numbers();

}  // namespace mpm
