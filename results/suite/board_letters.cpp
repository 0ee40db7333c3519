#include "results/suite/board_letters.hpp"

#include <string_view>

namespace mpm {
namespace {

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr unsigned kLetterBits = 6;
constexpr unsigned kKindBits = 3, kKindMask = (1U << kKindBits) - 1;

std::optional<unsigned> bits_of(char each) {
  const std::size_t place = kLetters.find(each);
  return place == std::string_view::npos ? std::nullopt : std::optional(static_cast<unsigned>(place));
}

/// Calls visit(fact, text, lowest bit) for each fact; returns the number of texts.
template <class Visit>
std::size_t each_fact(Visit visit) {
  std::size_t text = 0;
  unsigned used = 0;
  for (const OutcomeFact& fact : outcome_facts()) {
    if (used + fact.bits > kLetterBits) {
      ++text;
      used = 0;
    }
    visit(fact, text, used);
    used += fact.bits;
  }
  return text + 1;
}

char letter_of(const FaultTruth& truth) {
  return kLetters[static_cast<unsigned>(truth.kind) | static_cast<unsigned>(truth.impact) << kKindBits |
                  static_cast<unsigned>(truth.one_cv) << (kKindBits + 1)];
}

}  // namespace

std::string truth_letters(const LoopTruths& truths) {
  std::string letters;
  for (const std::optional<FaultTruth>& truth : truths)
    letters += truth ? letter_of(*truth) : kNoLoop;
  return letters;
}

std::optional<FaultTruth> fault_truth(char letter) {
  for (int kind = 0; kind <= static_cast<int>(ExperimentKind::other); ++kind)
    for (const bool impact : {false, true})
      for (const bool one_cv : {false, true}) {
        const FaultTruth truth{static_cast<ExperimentKind>(kind), impact, one_cv};
        if (letter_of(truth) == letter && (truth.faulty() || !(impact || one_cv)))
          return truth;
      }
  return std::nullopt;
}

std::size_t outcome_text_count() {
  return each_fact([](const OutcomeFact&, std::size_t, unsigned) {});
}

std::vector<std::string> outcome_letters(const LoopOutcomes& outcomes) {
  std::vector<std::string> texts(outcome_text_count());
  for (const std::optional<LoopOutcome>& outcome : outcomes) {
    std::vector<unsigned> bits(texts.size());
    if (outcome)
      each_fact([&](const OutcomeFact& fact, std::size_t text, unsigned lowest) {
        bits[text] |= fact.get(*outcome) << lowest;
      });
    for (std::size_t text = 0; text < texts.size(); ++text)
      texts[text] += outcome ? kLetters[bits[text]] : kNoLoop;
  }
  return texts;
}

std::optional<LoopOutcome> loop_outcome(const std::string& letters) {
  std::vector<unsigned> bits(outcome_text_count()), known(bits.size());
  for (std::size_t text = 0; text < letters.size(); ++text) {
    const std::optional<unsigned> found = bits_of(letters[text]);
    if (!found)
      return std::nullopt;
    bits[text] = *found;
  }
  LoopOutcome outcome;
  each_fact([&](const OutcomeFact& fact, std::size_t text, unsigned lowest) {
    const unsigned number = bits[text] >> lowest & ((1U << fact.bits) - 1);
    fact.set(outcome, number);
    known[text] |= fact.get(outcome) << lowest;
  });
  return known == bits ? std::optional(outcome) : std::nullopt;
}

}  // namespace mpm
