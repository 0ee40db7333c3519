#include <set>

#include <catch2/catch.hpp>

#include "analysis/findings/loop_outcome.hpp"

namespace mpm {

TEST_CASE("every fact of an outcome is put back as it was taken out, and is one of its own", "[outcome]") {
  LoopOutcome all;
  for (const OutcomeFact& fact : outcome_facts()) {
    LoopOutcome one;
    fact.set(one, 1);
    CHECK(fact.get(one) == 1);
    unsigned others = 0;
    for (const OutcomeFact& other : outcome_facts())
      others += other.get(one);
    CHECK(others == 1);
    CHECK(fact.get(all) == 0);
    fact.set(all, 1);
    fact.set(one, 3);
    // Of yes or no; of a verdict, none of which has this number; of a count.
    CHECK(fact.get(one) == (fact.bits == 1 ? 1U : fact.bits == 2 ? 0U : 3U));
  }
  // A member that is in no fact is missing here.
  const auto& [answered, flagged, above_05, above_chosen, right_cv, right_source, above_01, above_not_mpm,
               names_source, channel, parameter, size, candidate, window, mismatch, redrawn_05, told] = all;
  for (const bool member : {answered, flagged, above_05, above_chosen, right_cv, right_source, above_01,
                            above_not_mpm, names_source})
    CHECK(member);
  for (const Correctness member : {channel, parameter, size, candidate, window, mismatch})
    CHECK(member == Correctness::wrong);
  CHECK(redrawn_05 == 1);
  CHECK(told == ToldSource::mpm);
}

TEST_CASE("a method says nothing that it cannot, and nothing right of what is not there", "[outcome]") {
  const FaultTruth fault{ExperimentKind::mpm, true, true}, healthy{};
  const OutcomeScope scope{.locates_cvs = true, .tells_sources = true, .at_05 = true};
  const auto possible = [&](const LoopOutcome& said, const FaultTruth& truth) {
    return is_possible(said, truth, scope);
  };
  CHECK(possible({}, fault));
  CHECK_FALSE(possible({.flagged = true}, fault));  // without an answer
  CHECK(possible(
      {.answered = true, .flagged = true, .above_05 = true, .right_cv = true, .right_source = true}, fault));
  CHECK_FALSE(possible({.answered = true, .above_chosen = true}, fault));  // there is no such threshold
  CHECK_FALSE(possible({.answered = true, .right_cv = true}, fault));      // of a loop that is not flagged
  CHECK_FALSE(possible({.answered = true, .right_source = true}, healthy));
  CHECK_FALSE(possible({.answered = true, .names_source = true}, fault));
  CHECK(possible(
      {.answered = true, .flagged = true, .parameter = Correctness::right, .size = Correctness::wrong},
      fault));
  CHECK_FALSE(possible({.answered = true, .flagged = true, .size = Correctness::wrong}, fault));
  CHECK_FALSE(possible({.answered = true, .channel = Correctness::right}, fault));
  CHECK_FALSE(possible({.answered = true, .channel = Correctness::wrong}, healthy));
  CHECK(possible({.answered = true, .mismatch = Correctness::right}, fault));
  CHECK_FALSE(possible({.answered = true, .mismatch = Correctness::right}, healthy));
  CHECK_FALSE(
      possible({.answered = true, .mismatch = Correctness::wrong}, {ExperimentKind::other, true, false}));
  CHECK_FALSE(possible({.answered = true, .redrawn_05 = 5}, fault));  // no worlds to draw
  CHECK_FALSE(possible({.answered = true, .window = Correctness::right}, healthy));
}

}  // namespace mpm
