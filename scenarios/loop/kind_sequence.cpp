#include "scenarios/loop/kind_sequence.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

KindSequence::KindSequence(const ExperimentCounts& counts) {
  // A kind without experiments is never behind, so that a new kind in the list changes no old study.
  constexpr std::array kinds{ExperimentKind::mpm,     ExperimentKind::ud,     ExperimentKind::mpm_ud,
                             ExperimentKind::healthy, ExperimentKind::tuning, ExperimentKind::other};
  std::array<std::pair<ExperimentKind, int>, kinds.size()> wanted;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    wanted[k] = {kinds[k], counts.of(kinds[k])};
  for (const auto& [kind, count] : wanted)
    if (count < 0)
      throw InputError("experiments", fmt::format("{}", count), "counts >= 0");
  if (counts.total() == 0)
    throw InputError("experiments", "no experiment at all", "at least one");

  int divisor = 0;
  for (const auto& [kind, count] : wanted)
    divisor = std::gcd(divisor, count);
  const int length = counts.total() / divisor;
  std::array<int, kinds.size()> placed{};
  for (int i = 0; i < length; ++i) {
    // The kind that is furthest behind its share of the first i + 1 experiments; ties go in order of kind.
    std::size_t next = 0;
    std::array<std::int64_t, kinds.size()> behind{};
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      behind[k] = std::int64_t{wanted[k].second / divisor} * (i + 1) - std::int64_t{placed[k]} * length;
      if (behind[k] > behind[next])
        next = k;
    }
    ++placed[next];
    period_.push_back(wanted[next].first);
  }
}

ExperimentKind KindSequence::operator[](std::int64_t index) const {
  return period_[static_cast<std::size_t>(index) % period_.size()];
}

std::int64_t KindSequence::earlier(std::int64_t index) const {
  const auto length = static_cast<std::int64_t>(period_.size());
  const ExperimentKind kind = (*this)[index];
  const auto within = period_.begin() + static_cast<std::ptrdiff_t>(index % length);
  return index / length * std::count(period_.begin(), period_.end(), kind) +
         std::count(period_.begin(), within, kind);
}

}  // namespace mpm
