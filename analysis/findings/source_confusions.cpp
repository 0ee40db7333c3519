#include "analysis/findings/source_confusions.hpp"

#include <cstddef>

namespace mpm {
namespace {

/// From `mpm` on, answers are sources in the same order.
LoopAnswer answer_naming(ToldSource source) {
  constexpr int kFirst = static_cast<int>(LoopAnswer::mpm) - static_cast<int>(ToldSource::mpm);
  return static_cast<LoopAnswer>(static_cast<int>(source) + kFirst);
}

}  // namespace

LoopAnswer loop_answer(const LoopOutcome& said) {
  if (!said.answered)
    return LoopAnswer::no_answer;
  if (!said.flagged)
    return LoopAnswer::none;
  return said.told == ToldSource::none ? LoopAnswer::unnamed : answer_naming(said.told);
}

LoopAnswer right_answer(ToldSource truth) {
  return truth == ToldSource::none ? LoopAnswer::none : answer_naming(truth);
}

void SourceConfusions::add(const SourceConfusions& more) {
  for (std::size_t row = 0; row < counts_.size(); ++row)
    for (std::size_t column = 0; column < kColumns; ++column)
      counts_[row][column] += more.counts_[row][column];
}

std::int64_t SourceConfusions::of(ToldSource truth, LoopAnswer answer) const {
  return counts_[static_cast<std::size_t>(truth)][static_cast<std::size_t>(answer)];
}

std::int64_t SourceConfusions::of(ToldSource truth) const {
  std::int64_t sum = 0;
  for (const LoopAnswer answer : enumerators<LoopAnswer>())
    sum += of(truth, answer);
  return sum;
}

std::int64_t SourceConfusions::of(LoopAnswer answer) const {
  std::int64_t sum = 0;
  for (const ToldSource truth : enumerators<ToldSource>())
    sum += of(truth, answer);
  return sum;
}

std::int64_t SourceConfusions::total() const {
  std::int64_t sum = 0;
  for (const ToldSource truth : enumerators<ToldSource>())
    sum += of(truth);
  return sum;
}

}  // namespace mpm
