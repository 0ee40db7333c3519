#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "results/suite/board_letters.hpp"

namespace mpm {

TEST_CASE("board letters: every truth has one of its own, and comes back from it", "[suite]") {
  std::set<std::string> letters;
  for (int kind = 0; kind <= static_cast<int>(ExperimentKind::other); ++kind)
    for (const bool impact : {false, true})
      for (const bool one_cv : {false, true}) {
        const FaultTruth truth{static_cast<ExperimentKind>(kind), impact, one_cv};
        if (!truth.faulty() && (impact || one_cv))
          continue;
        const std::string letter = truth_letters({truth});
        CHECK(letters.insert(letter).second);
        CHECK(fault_truth(letter[0]) == truth);
      }
  CHECK(truth_letters({std::nullopt}) == std::string(1, kNoLoop));
  for (const char none : {kNoLoop, '!', '/'})  // the last one has more bits than a truth
    CHECK_FALSE(fault_truth(none).has_value());
}

TEST_CASE("board letters: every outcome comes back from its letters, and other characters are none",
          "[suite]") {
  LoopOutcomes outcomes{LoopOutcome{}, std::nullopt};
  for (const OutcomeFact& fact : outcome_facts())
    for (unsigned number = 1; number < (fact.bits == 1   ? 2U
                                        : fact.bits == 2 ? 3U
                                                         : 1U << fact.bits);
         ++number) {
      LoopOutcome outcome{.answered = true};
      fact.set(outcome, number);
      outcomes.emplace_back(outcome);
    }
  const std::vector<std::string> texts = outcome_letters(outcomes);
  REQUIRE(texts.size() == outcome_text_count());
  std::set<std::string> seen;
  for (std::size_t loop = 0; loop < outcomes.size(); ++loop) {
    std::string letters;
    for (const std::string& text : texts)
      letters += text[loop];
    seen.insert(letters);
    CHECK(loop_outcome(letters) == outcomes[loop]);
  }
  CHECK(seen.size() == outcomes.size());
  CHECK(loop_outcome("B") == LoopOutcome{.answered = true});
  CHECK_FALSE(loop_outcome("!").has_value());
  CHECK_FALSE(loop_outcome("B/").has_value());  // a verdict that there is not
}

}  // namespace mpm
