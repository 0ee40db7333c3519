#include "analysis/findings/source_confusions.hpp"

#include <cstddef>

namespace mpm {
namespace {

/// Returns the answer that names this source. From `mpm` on, the answers have the order of the sources.
AnsweredSource answer_naming(ToldSource source) {
  constexpr int kFirst = static_cast<int>(AnsweredSource::mpm) - static_cast<int>(ToldSource::mpm);
  return static_cast<AnsweredSource>(static_cast<int>(source) + kFirst);
}

}  // namespace

AnsweredSource answered_source(const LoopOutcome& said) {
  if (!said.answered)
    return AnsweredSource::no_answer;
  if (!said.flagged)
    return AnsweredSource::none;
  return said.told == ToldSource::none ? AnsweredSource::unnamed : answer_naming(said.told);
}

AnsweredSource right_answer(ToldSource truth) {
  return truth == ToldSource::none ? AnsweredSource::none : answer_naming(truth);
}

void SourceConfusions::add(const SourceConfusions& more) {
  for (std::size_t row = 0; row < counts_.size(); ++row)
    for (std::size_t column = 0; column < kColumns; ++column)
      counts_[row][column] += more.counts_[row][column];
}

std::int64_t SourceConfusions::of(ToldSource truth, AnsweredSource answer) const {
  return counts_[static_cast<std::size_t>(truth)][static_cast<std::size_t>(answer)];
}

std::int64_t SourceConfusions::of(ToldSource truth) const {
  std::int64_t sum = 0;
  for (const AnsweredSource answer : enumerators<AnsweredSource>())
    sum += of(truth, answer);
  return sum;
}

std::int64_t SourceConfusions::of(AnsweredSource answer) const {
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
