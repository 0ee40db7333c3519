#include <cmath>
#include <functional>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/non_finite.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

/// A campaign with calibration loops whose scores are all different, an awkward one of each sort among them.
Campaign calibrated_campaign() {
  Campaign campaign = faultless_campaign();
  campaign.study = parse_study(campaign.study.source + "\n[calibration]\nhealthy = 20\nud = 3\n", "small");
  const Study loops = calibration_study(campaign.study);
  campaign.study.methods = method_names(campaign);
  campaign.calibration.seed = loops.seed;
  double score = 0.0;
  for (std::int64_t index = 0; index < loops.experiment_count(); ++index) {
    campaign.calibration.loops.push_back({draw_experiment(loops, index).kind, {}});
    for (std::size_t method = 0; method < campaign.methods.size(); ++method)
      campaign.calibration.loops.back().scores.push_back(score += 0.125);
  }
  campaign.calibration.loops[2].scores[0] = kNaN;
  campaign.calibration.loops[3].scores[1] = -kInfinity;
  campaign.calibration.loops[4].scores[2] = kInfinity;
  return campaign;
}

std::string refusal_after(const std::function<void(Campaign&)>& damage) {
  const TemporaryFolder folder;
  Campaign campaign = calibrated_campaign();
  const StudyFindings findings = findings_of(campaign);
  damage(campaign);
  write_archive(folder / "a.h5", campaign, findings);
  try {
    read_archive(folder / "a.h5");
    return "accepted";
  } catch (const ArchiveError& error) {
    return error.what();
  }
}

TEST_CASE("archive: calibration loops come back bit for bit, and give the same thresholds") {
  const TemporaryFolder folder;
  const Campaign campaign = calibrated_campaign();
  const StudyFindings findings = findings_of(campaign);
  write_archive(folder / "a.h5", campaign, findings);
  const Campaign read = read_archive(folder / "a.h5");
  CHECK(read.calibration.seed == campaign.calibration.seed);
  REQUIRE(read.calibration.loops.size() == campaign.calibration.loops.size());
  for (std::size_t i = 0; i < read.calibration.loops.size(); ++i) {
    const CalibrationLoop &found = read.calibration.loops[i], &expected = campaign.calibration.loops[i];
    CHECK(found.kind == expected.kind);
    REQUIRE(found.scores.size() == expected.scores.size());
    for (std::size_t method = 0; method < found.scores.size(); ++method)
      CHECK((found.scores[method] == expected.scores[method] ||
             (std::isnan(found.scores[method]) && std::isnan(expected.scores[method]))));
  }
  const Finding* const threshold = find_finding(findings.rows, "compare.sse.threshold_05");
  REQUIRE(threshold != nullptr);
  CHECK(threshold->count == 20);
  CHECK(find_finding(findings_of(read).rows, threshold->name)->value == threshold->value);
}

TEST_CASE("archive: a study without calibration has no such group") {
  const TemporaryFolder folder;
  const Campaign campaign = faultless_campaign();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  CHECK_FALSE(Hdf5File::open(folder / "a.h5").root().has_group("calibration"));
  CHECK(read_archive(folder / "a.h5").calibration.loops.empty());
}

TEST_CASE("archive: calibration loops of another seed, number or kind are refused") {
  CHECK(refusal_after([](Campaign&) {}) == "accepted");
  CHECK_THAT(refusal_after([](Campaign& c) { c.calibration.seed = c.study.seed; }),
             Contains("seed of '/calibration': found 7; allowed: "));
  CHECK_THAT(refusal_after([](Campaign& c) { c.calibration.loops.pop_back(); }),
             Contains("number of loops of '/calibration': found 22; allowed: 23"));
  CHECK_THAT(refusal_after([](Campaign& c) { c.calibration.loops[0].kind = ExperimentKind::mpm; }),
             Contains("variable 'kind': found 1"));
}

}  // namespace
