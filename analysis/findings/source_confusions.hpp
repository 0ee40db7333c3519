#pragma once

#include <array>
#include <cstdint>

#include "analysis/findings/loop_outcome.hpp"
#include "base/enum_words.hpp"
#include "scenarios/faults/told_source.hpp"

// The true sources of loops against the answers of a method at its own threshold.

namespace mpm {

/// The answer of a method about the source of a loop.
enum class AnsweredSource : std::int8_t {
  no_answer = 0,  ///< no verdict
  none = 1,       ///< not flagged
  unnamed = 2,    ///< flagged, without a source
  mpm = 3,        ///< flagged with this source, as all below
  ud = 4,
  mpm_ud = 5,
  other = 6,
  sensor = 7,
  valve = 8,
  data = 9,
};

template <>
inline constexpr auto kWords<AnsweredSource> = word_list("no_answer", "none", "unnamed", "mpm", "ud",
                                                         "mpm_ud", "other", "sensor", "valve", "data");

AnsweredSource answered_source(const LoopOutcome& said);
/// Returns the answer that is right for this truth.
AnsweredSource right_answer(ToldSource truth);

/// The number of loops with each truth (row) and each answer (column). They add up to the number of loops.
/// Bad tuning has the truth `none`.
class SourceConfusions {
 public:
  void add(const FaultTruth& truth, const LoopOutcome& said) { ++at(truth.source(), answered_source(said)); }
  void add(const SourceConfusions& more);

  std::int64_t of(ToldSource truth, AnsweredSource answer) const;
  std::int64_t of(ToldSource truth) const;
  std::int64_t of(AnsweredSource answer) const;
  std::int64_t total() const;

 private:
  static constexpr std::size_t kColumns = kWords<AnsweredSource>.size();

  std::int64_t& at(ToldSource truth, AnsweredSource answer) {
    return counts_[static_cast<std::size_t>(truth)][static_cast<std::size_t>(answer)];
  }

  std::array<std::array<std::int64_t, kColumns>, kWords<ToldSource>.size()> counts_{};
};

}  // namespace mpm
