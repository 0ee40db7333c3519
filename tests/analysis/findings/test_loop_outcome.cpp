#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/findings/loop_outcome.hpp"

namespace mpm {

TEST_CASE("every truth has a letter of its own, and comes back from it", "[outcome]") {
  std::set<char> letters;
  for (int kind = 0; kind <= static_cast<int>(ExperimentKind::other); ++kind)
    for (const bool impact : {false, true})
      for (const bool one_cv : {false, true}) {
        const FaultTruth truth{static_cast<ExperimentKind>(kind), impact, one_cv};
        if (!truth.faulty() && (impact || one_cv))
          continue;
        CHECK(letters.insert(letter_of(truth)).second);
        CHECK(fault_truth(letter_of(truth)) == truth);
      }
  CHECK(letters.count(kNoLoop) == 0);
}

TEST_CASE("every outcome comes back from its letter, and other characters are none", "[outcome]") {
  int known = 0;
  for (int byte = 0; byte < 256; ++byte) {
    const char letter = static_cast<char>(byte);
    if (const auto outcome = loop_outcome(letter)) {
      ++known;
      CHECK(letter_of(*outcome) == letter);
      CHECK((outcome->answered || letter == 'A'));
      CHECK((outcome->flagged || !outcome->right_cv));
    }
  }
  // Without an answer one; with one 2^5, less the quarter with a right CV that is not flagged.
  CHECK(known == 1 + 24);
  CHECK_FALSE(loop_outcome(kNoLoop).has_value());
  CHECK_FALSE(fault_truth('!').has_value());
  CHECK_FALSE(fault_truth('/').has_value());  // more bits than a truth has
}

}  // namespace mpm
