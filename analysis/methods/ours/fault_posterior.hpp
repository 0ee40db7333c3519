#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/cv_evidence.hpp"
#include "analysis/methods/source_probabilities.hpp"

namespace mpm {

/// Which faults the method `likelihood` takes for possible beside one wrong parameter of a channel, a
/// disturbance on an output and both of them.
enum class FaultHypotheses : std::int8_t {
  learnt = 0,  ///< all where errors of the model are learnt, otherwise the basic ones
  basic = 1,   ///< none beside them
  /// a mismatch that begins within the record and grows; a disturbance on an MV; a valve that sticks; a
  /// sensor with a bias, a drift, or that is stuck, and a wrong measurement of an MD
  all = 2,
};

/// Of the method `likelihood`, analysis/methods/ours/likelihood_method.
struct LikelihoodOptions {
  FaultPriors priors = FaultPriors::wide;
  FaultHypotheses hypotheses = FaultHypotheses::learnt;
  double fault_probability = 0.5;  ///< of some fault in a loop, before the record is seen; of wide priors
  double flag_probability = 0.5;   ///< a loop or a CV is flagged when a fault is more probable than this
  /// A source is named when it is at least so probable, given that there is a fault; 0: always.
  double source_probability = 0.0;
  JudgedMismatches judged = JudgedMismatches::nearest;

  bool operator==(const LikelihoodOptions&) const = default;
};

/// How probable it is, given the record, that a CV has this fault, and how probable the faults of a loop are.
struct FaultProbabilities {
  struct OfCv {
    double mpm, ud, both;  ///< P(this CV has it)
    double log_odds;       ///< log(P(some fault of this CV) / P(none))
    double other = 0.0;    ///< as `mpm`, of neither
    double sensor = 0.0;   ///< the part of `other` that sensors have

    double fault() const { return mpm + ud + both + other; }
  };
  double healthy, mpm, ud, both;  ///< of the loop; with `other` they sum to 1
  double log_odds;                ///< log((1 - healthy) / healthy)
  std::vector<OfCv> cvs;
  double other = 0.0;
  double sensor = 0.0;  ///< the part of `other` that sensors have
};

/// Priors and evidence of all CVs together. Of one fault: the weight of each is prior times evidence. Of
/// several: the CVs are independent of each other, and with h_i, m_i, u_i, b_i what CV i has with which
/// probability, nothing is wrong in the loop with prod h_i, and there are mismatches alone with
/// prod (h_i + m_i) - prod h_i. A sensor beside a mismatch or a disturbance is not a fault of its own.
FaultProbabilities fault_probabilities(const FaultPriorSet& priors, const std::vector<CvEvidence>& evidence);

/// The same when a fault of an MV, which moves several CVs at once, may be the only one instead; its weight
/// against nothing is e^`log_weight`. The CVs in which it shows are those that show a fault by themselves. A
/// disturbance on the MV is a disturbance, a valve that sticks neither that nor a mismatch. The measurement
/// of an MD, which moves the model of several CVs, is counted in the same way.
FaultProbabilities with_input_disturbance(FaultProbabilities probabilities, double log_weight);
FaultProbabilities with_sticky_valve(FaultProbabilities probabilities, double log_weight);
FaultProbabilities with_wrong_md(FaultProbabilities probabilities, double log_weight);

/// How often each source is true where the evidence speaks for `seen`, in loops in which errors of the model
/// are learnt: no list of hypotheses has all faults, errors and backgrounds of a plant in it, and what lies
/// outside of it looks like one of them, most often like both of mismatch and disturbance, which can take any
/// shape. Shares of the loops of the standard suite on four plants under the development seed 7.
const SourceProbabilities& true_sources(FaultSource seen);

/// The method `likelihood` and, with the priors of the study, the ceiling of what any method can do on it.
std::unique_ptr<AssessmentMethod> make_fault_posterior(const AssessmentContext& context, FaultPriors priors);

/// The numbers that it gives.
std::vector<AssessmentNumberInfo> fault_posterior_numbers();

}  // namespace mpm
