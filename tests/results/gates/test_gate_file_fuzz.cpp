#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_report.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Reads gate files and holds one campaign against those that can be read.
class GateReader {
 public:
  GateReader() : campaign_(made_up_campaign()), findings_(gate_findings(campaign_.study)) {
    campaign_.study.aggregate.bootstrap_replications = 100;
  }

  /// True when the text was accepted. Another exception than InputError goes on and fails the test.
  bool accepts(const std::string& text) {
    try {
      const GateFile file = parse_gates(text, "g.toml", findings_);
      judge(file);
      return true;
    } catch (const InputError& error) {
      const std::string message = error.what();
      if (!message.starts_with("g.toml:") || message.find("; allowed: ") == std::string::npos)
        FAIL_CHECK("a refusal without place or rule: " << message);
      return false;
    }
  }

 private:
  /// One in so many, because the bootstrap takes most of the time.
  void judge(const GateFile& file) {
    if (++accepted_ % 8 != 0)
      return;
    const GateCheck check = check_gates(campaign_, file, file.baseline ? &campaign_ : nullptr);
    REQUIRE(check.results.size() >= 3 + file.gates.size());
    REQUIRE_FALSE(gates_text(check).empty());
    REQUIRE_FALSE(gates_junit(check, "a.h5").empty());
  }

  Campaign campaign_;
  std::vector<Finding> findings_;
  int accepted_ = 0;
};

const std::string kGates = R"(inconclusive = "pass"
confidence = 0.9
maximum_failed = 3
minimum_experiments = 40

[[gate]]
aggregate = "infeasible"
maximum = 0.1

[[gate]]
aggregate = "mpm.slope"  # any number will do here
minimum = -1
maximum = 2.5
with_confidence = true
minimum_count = 12
reason = "some text, <which> & \"may\" be changed to almost anything"

[baseline]
archive = "old/a.h5"
significance = 0.01
maximum_lost = 0
)";

TEST_CASE("thousands of damaged gate files are read or refused") {
  GateReader reader;
  REQUIRE(reader.accepts(kGates));
  Mutator mutator(1);
  constexpr int kTrials = 4000;
  int accepted = 0;
  for (int i = 0; i < kTrials; ++i)
    accepted += reader.accepts(mutator.mutated_toml(kGates)) ? 1 : 0;
  CHECK(accepted > kTrials / 100);
  CHECK(accepted < kTrials / 2);
  const std::string shipped = project_file("scenarios/gates/chapter6.toml");
  for (int i = 0; i < 1000; ++i)
    reader.accepts(mutator.mutated_toml(shipped));
}

TEST_CASE("gate files that are cut off anywhere, and random bytes, are read or refused") {
  GateReader reader;
  for (std::size_t length = 0; length < kGates.size(); ++length)
    reader.accepts(kGates.substr(0, length));
  Mutator mutator(2);
  for (int i = 0; i < 2000; ++i) {
    std::string text = mutator.random_bytes(300);
    CHECK_FALSE(reader.accepts(text));
  }
}

}  // namespace
