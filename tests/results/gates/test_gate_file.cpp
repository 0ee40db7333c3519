#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_file.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

const std::vector<Finding>& findings() {
  static const std::vector<Finding> list = gate_findings(find_study("chapter6"));
  return list;
}

std::string refused(const std::string& text) {
  try {
    parse_gates(text, "g.toml", findings());
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::string kGate = "[[gate]]\naggregate = \"ud.located\"\nminimum = 0.5\n";

TEST_CASE("gate file: every key is read") {
  const GateFile file = parse_gates(R"(
inconclusive = "pass"
confidence = 0.9
maximum_failed = 3
minimum_experiments = 40
minimum_answered = 0.5
[[gate]]
aggregate = "infeasible"
maximum = 0.1
[[gate]]
aggregate = "mpm.slope"
minimum = -1
maximum = 2.5
with_confidence = true
minimum_count = 12
reason = "why"
[baseline]
archive = "old/a.h5"
significance = 0.01
maximum_lost = 0
)",
                                    "folder/g.toml", findings());
  CHECK(file.inconclusive == InconclusivePolicy::pass);
  CHECK(file.confidence == 0.9);
  CHECK(file.maximum_failed == 3);
  CHECK(file.minimum_experiments == 40);
  CHECK(file.minimum_answered == 0.5);
  REQUIRE(file.gates.size() == 2);
  CHECK(file.gates[0].name == "infeasible");
  CHECK(file.gates[0].minimum == -mpm::kInfinity);
  CHECK(file.gates[0].maximum == 0.1);
  CHECK_FALSE(file.gates[0].with_confidence);
  CHECK(file.gates[1].minimum == -1.0);
  CHECK(file.gates[1].maximum == 2.5);
  CHECK(file.gates[1].with_confidence);
  CHECK(file.gates[1].minimum_count == 12);
  CHECK(file.gates[1].reason == "why");
  REQUIRE(file.baseline);
  CHECK(file.baseline->archive == "folder/old/a.h5");
  CHECK(file.baseline->significance == 0.01);
  CHECK(file.baseline->maximum_lost == 0);
}

TEST_CASE("gate file: defaults, an absolute path, and a baseline without gates") {
  const GateFile file = parse_gates("[baseline]\narchive = \"/x/a.h5\"\n", "folder/g.toml", findings());
  CHECK(file.inconclusive == InconclusivePolicy::fail);
  CHECK_FALSE(file.confidence);
  CHECK(file.maximum_failed == 0);
  CHECK(file.minimum_experiments == 1);
  CHECK(file.minimum_answered == 0.9);
  CHECK(file.gates.empty());
  CHECK(file.baseline->archive == "/x/a.h5");
  CHECK(file.baseline->significance == 0.05);
  CHECK_FALSE(file.baseline->maximum_lost);
}

TEST_CASE("gate file: the shipped file is read, and every gate in it says why") {
  const GateFile file =
      parse_gates(project_file("scenarios/gates/chapter6.toml"), "scenarios/gates/chapter6.toml", findings());
  CHECK(file.gates.size() > 5);
  for (const Gate& gate : file.gates)
    CHECK_FALSE(gate.reason.empty());
}

TEST_CASE("gate file: the numbers of a gate are those that the summary has") {
  CHECK(find_finding(findings(), "infeasible") != nullptr);
  const Campaign campaign = made_up_campaign();
  const std::vector<Finding> found = gate_findings(campaign.study);
  const std::vector<Finding> rows = findings_of(campaign).rows;
  REQUIRE(found.size() == rows.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].name == rows[i].name);
    CHECK(found[i].has_interval == rows[i].has_interval);
    if (!found[i].has_interval)
      CHECK(std::isnan(rows[i].interval.lower));
  }
}

TEST_CASE("gate file: every number of an archive can have a gate, also one that only some loops give") {
  Campaign campaign = made_up_campaign();
  for (ExperimentRecord& record : campaign.records)
    record.conditions = {.spectral_radius = record.draw.index % 2 == 0 ? 0.5 : 1.5, .other_cv_active = 0.0};
  const std::vector<Finding> rows = findings_of(campaign).rows, found = gate_findings(campaign);
  CHECK(rows.size() > gate_findings(campaign.study).size());
  for (const Finding& row : rows)
    CHECK(find_finding(found, row.name) != nullptr);
}

TEST_CASE("gate file: mistakes are refused with line, key, what was found and what is allowed") {
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"", "g.toml:1: gate: found nothing; allowed: a list of tables, one or more"},
      {"gate = []\n", "g.toml:1: gate: found a list of 0; allowed: a list of tables, one or more"},
      {"inconclusive = \"maybe\"\n", "g.toml:1: inconclusive: found 'maybe'; allowed: fail, pass"},
      {"confidence = 95\n", "g.toml:1: confidence: found 95; allowed: a number in (0, 1)"},
      {"maximum_failed = -1\n",
       "g.toml:1: maximum_failed: found -1; allowed: a whole number from 0 to 2147483647"},
      {"minimum_experiments = 0\n",
       "g.toml:1: minimum_experiments: found 0; allowed: a whole number from 1 to 2147483647"},
      {"[baselin]\narchive = \"a\"\n",
       "g.toml:1: top level: found unknown key 'baselin' (nearest: 'baseline'); allowed: inconclusive, "
       "confidence, maximum_failed, minimum_experiments, minimum_answered, gate, baseline"},
      {"[[gate]]\nmaximum = 0.1\nminumum = 0\n",
       "g.toml:3: gate[0]: found unknown key 'minumum' (nearest: 'minimum'); allowed: aggregate, minimum, "
       "maximum, with_confidence, minimum_count, reason"},
      {"[[gate]]\naggregate = \"infeasible\"\n",
       "g.toml:1: gate[0]: found no limit; allowed: minimum, maximum or both"},
      {kGate + "maximum = 0.4\n",
       "g.toml:4: gate[0].maximum: found 0.4; allowed: a number >= the minimum, 0.5"},
      {"[[gate]]\naggregate = \"ud.located\"\nminimum = 95\n",
       "g.toml:3: gate[0].minimum: found 95; allowed: a number in [0, 1]"},
      {"[[gate]]\naggregate = \"ud.slope\"\nminimum = nan\n",
       "g.toml:3: gate[0].minimum: found nan; allowed: a finite number"},
      {kGate + "with_confidence = 1\n", "g.toml:4: gate[0].with_confidence: found 1; allowed: true or false"},
      {kGate + "minimum_count = 0\n",
       "g.toml:4: gate[0].minimum_count: found 0; allowed: a whole number from 1 to 2147483647"},
      {kGate + "reason = \"\"\n", "g.toml:4: gate[0].reason: found ''; allowed: a text that is not empty"},
      {kGate + "[[gate]]\naggregate = \"ud.i_mpm_max\"\nmaximum = 1\nwith_confidence = true\n",
       "g.toml:7: gate[1].with_confidence: found true; allowed: false: 'ud.i_mpm_max' has no interval"},
      {"[baseline]\n", "g.toml:1: baseline.archive: found nothing; allowed: a text that is not empty"},
      {"[baseline]\narchive = \"a\"\nsignificance = 0\n",
       "g.toml:3: baseline.significance: found 0; allowed: a number in (0, 1)"},
      {"[baseline]\narchive = \"a\"\nmaximum_lost = 1.5\n",
       "g.toml:3: baseline.maximum_lost: found 1.5; allowed: a whole number from 0 to 2147483647"},
  };
  for (const auto& [text, message] : mistakes)
    CHECK(refused(text) == message);
  const std::string unknown = refused("[[gate]]\naggregate = \"mpm.locatd\"\nminimum = 0\n");
  CHECK_THAT(unknown,
             Catch::StartsWith("g.toml:2: gate[0].aggregate: found 'mpm.locatd' (nearest: 'mpm.located', ") &&
                 Catch::Contains("); allowed: one of "));
  CHECK(refused(kGate) == "accepted");
  CHECK_THROWS_WITH(load_gates("none.toml", findings()),
                    "none.toml: found no such file; allowed: a gate file");
}

}  // namespace
