#include <catch2/catch.hpp>

#include "tests/scenarios/mutator.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

using namespace testing;

bool names_place_and_rule(const std::string& message) {
  return message.starts_with("s.toml:") && message.find("; allowed: ") != std::string::npos;
}

/// Any other exception than InputError would leave refusal() and fail the test; a crash would end it.
void try_mutations(const std::string& original, std::uint64_t seed, int count) {
  Mutator mutator(seed);
  int accepted = 0;
  for (int i = 0; i < count; ++i) {
    const std::string message = refusal(mutator.mutated_toml(original));
    if (message == "accepted")
      ++accepted;
    else if (!names_place_and_rule(message))
      FAIL_CHECK("a refusal without place or rule: " << message);
  }
  // Comments and free numbers can change without harm, most else cannot: a reader that accepts or refuses
  // everything is no reader.
  CHECK(accepted > count / 100);
  CHECK(accepted < count / 2);
}

TEST_CASE("thousands of damaged studies are read or refused", "[study_file]") {
  try_mutations(project_file("scenarios/studies/chapter6.toml"), 1, 3000);
  try_mutations(project_file("scenarios/studies/wood-berry.toml"), 2, 2000);
  try_mutations(small_study(), 3, 2000);
  try_mutations(project_file("scenarios/studies/chapter6-scenarios.toml"), 5, 2000);
}

TEST_CASE("studies that are cut off anywhere are refused", "[study_file]") {
  const std::string whole = small_study();
  int accepted = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string message = refusal(whole.substr(0, length));
    if (message == "accepted")
      ++accepted;  // in the last number, or behind it
    else
      CHECK(names_place_and_rule(message));
  }
  CHECK(accepted < 100);
}

TEST_CASE("random bytes are refused", "[study_file]") {
  Mutator mutator(4);
  for (int i = 0; i < 2000; ++i)
    CHECK(names_place_and_rule(refusal(mutator.random_bytes(300))));
}

}  // namespace
}  // namespace mpm
