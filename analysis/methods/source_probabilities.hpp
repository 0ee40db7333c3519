#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "scenarios/faults/fault.hpp"

// A method may state, besides its verdict, how probable each source of a fault is. It does so by five numbers
// of the whole loop. This holds for methods of this program, for programs, and for files of verdicts.

namespace mpm {

/// The probability of each FaultSource, in their order: none, mpm, ud, mpm_ud, other.
using SourceProbabilities = std::array<double, kWords<FaultSource>.size()>;

/// The numbers that state them, in the same order: p_healthy, p_mpm, p_ud, p_both, p_other.
const std::vector<AssessmentNumberInfo>& source_probability_numbers();

/// Does a method have the numbers that state probabilities?
bool states_probabilities(const MethodDescription& method);

/// The probabilities that an answer states for a loop, scaled to the sum 1; none if it states none that are
/// valid.
std::optional<SourceProbabilities> stated_probabilities(const AssessmentRecord& said);

/// The least probability of the truth that the logarithmic score counts: a method that states a smaller one,
/// such as 0, is counted as if it had stated this.
inline constexpr double kLeastScoredProbability = 0.001;

/// -ln p / -ln kLeastScoredProbability, p the stated probability of the truth: 0 for a certain and right
/// statement, 1 for a certain and wrong one. A proper score (Gneiting and Raftery, "Strictly proper scoring
/// rules, prediction, and estimation", J. Am. Stat. Assoc. 102, 2007, 359-378).
double log_score(const SourceProbabilities& stated, FaultSource truth);

/// Half of Brier's score, sum over the sources of (p - o)^2 / 2, o = 1 for the truth and 0 for the others.
double brier_score(const SourceProbabilities& stated, FaultSource truth);

/// How well the stated probabilities of the likeliest source agree with how often it is the truth, in bins of
/// a tenth (a reliability diagram has one point a bin).
class Reliability {
 public:
  struct Bin {
    double stated = 0.0;  ///< sum of the probabilities
    std::int64_t count = 0, right = 0;
  };
  static constexpr std::size_t kBins = 10;

  Reliability() = default;
  explicit Reliability(const std::array<Bin, kBins>& bins) : bins_(bins) {}

  void add(const SourceProbabilities& stated, FaultSource truth);
  void add(const Reliability& more);
  const std::array<Bin, kBins>& bins() const { return bins_; }
  /// Mean over the loops of |mean stated probability - share of right answers| of their bin; NaN without a
  /// loop.
  double error() const;
  std::int64_t count() const;

 private:
  std::array<Bin, kBins> bins_{};
};

}  // namespace mpm
