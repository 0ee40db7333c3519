#include <algorithm>
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/findings/study_aggregate.hpp"
#include "bench/record_bytes.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

/// The basis case in the shape of a record, which to_bytes() takes apart bit by bit.
std::string basis_bytes(const BasisCase& basis) {
  ExperimentRecord record;
  record.diagnosis = basis.diagnosis;
  for (const AcfComparison& acf : basis.acf)
    record.diagnosis.cvs.push_back({false, ExperimentKind::none, {}, acf, 0.0});
  record.loop = {basis.trajectory, basis.nominal.y_sim};
  return to_bytes(record);
}

void check_same_limits(const std::vector<ActiveReference>& a, const std::vector<ActiveReference>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].cv == b[i].cv);
    CHECK(a[i].kind == b[i].kind);
  }
}

void check_same(const BasisCase& a, const BasisCase& b) {
  CHECK(same_bits(a.point.u, b.point.u));
  CHECK(same_bits(a.point.y, b.point.y));
  CHECK(a.point.fixed_mvs == b.point.fixed_mvs);
  check_same_limits(a.point.active, b.point.active);
  check_same_limits(a.sensitivity.active, b.sensitivity.active);
  CHECK(a.sensitivity.cv_count == b.sensitivity.cv_count);
  REQUIRE(a.sensitivity.step_response.size() == b.sensitivity.step_response.size());
  for (std::size_t i = 0; i < a.sensitivity.step_response.size(); ++i)
    CHECK(same_bits(a.sensitivity.step_response[i], b.sensitivity.step_response[i]));
  REQUIRE(a.sensitivity_direct.has_value() == b.sensitivity_direct.has_value());
  if (a.sensitivity_direct) {
    check_same_limits(a.sensitivity_direct->active, b.sensitivity_direct->active);
    CHECK(same_bits(a.sensitivity_direct->step_response[0], b.sensitivity_direct->step_response[0]));
  }
  REQUIRE(a.sensitivity_fixed.has_value() == b.sensitivity_fixed.has_value());
  if (a.sensitivity_fixed) {
    check_same_limits(a.sensitivity_fixed->active, b.sensitivity_fixed->active);
    REQUIRE(a.sensitivity_fixed->step_response.size() == b.sensitivity_fixed->step_response.size());
    for (std::size_t i = 0; i < a.sensitivity_fixed->step_response.size(); ++i)
      CHECK(same_bits(a.sensitivity_fixed->step_response[i], b.sensitivity_fixed->step_response[i]));
  }
  CHECK(basis_bytes(a) == basis_bytes(b));
  CHECK(same_bits(a.nominal.y0, b.nominal.y0));
  CHECK(same_bits(a.nominal.y0_diag, b.nominal.y0_diag));
  CHECK(a.healthy == b.healthy);
  CHECK(a.explanation == b.explanation);
}

void check_same(const CampaignInfo& a, const CampaignInfo& b) {
  CHECK(a.mpmbench_version == b.mpmbench_version);
  CHECK(a.git_sha == b.git_sha);
  CHECK(a.created == b.created);
  CHECK(a.command == b.command);
  CHECK(a.solver == b.solver);
  CHECK(same_bits(a.seconds, b.seconds));
  CHECK(a.jobs == b.jobs);
  CHECK(same_bits(a.audit_share, b.audit_share));
  CHECK(same_bits(a.audit_seconds, b.audit_seconds));
}

void check_same(const AuditDifference& a, const AuditDifference& b) {
  CHECK(a.same_status == b.same_status);
  CHECK(same_bits(a.x, b.x));
  CHECK(same_bits(a.objective, b.objective));
}

void check_same(const std::vector<AuditedStep>& a, const std::vector<AuditedStep>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].experiment == b[i].experiment);
    CHECK(a[i].step == b[i].step);
    check_same(a[i].targets, b[i].targets);
    check_same(a[i].moves, b[i].moves);
    CHECK(same_bits(a[i].reference_kkt_residual, b[i].reference_kkt_residual));
  }
}

void check_same(const Comparison& a, const Comparison& b) {
  CHECK(a.methods == b.methods);
  CHECK(a.reasons == b.reasons);
  REQUIRE(a.loops.size() == b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    CHECK(a.loops[i].experiment == b.loops[i].experiment);
    REQUIRE(a.loops[i].verdicts.size() == b.loops[i].verdicts.size());
    for (std::size_t m = 0; m < a.loops[i].verdicts.size(); ++m) {
      INFO("loop " << i << ", method " << m);
      const MethodVerdict &of_a = a.loops[i].verdicts[m], &of_b = b.loops[i].verdicts[m];
      CHECK(of_a.status == of_b.status);
      CHECK(of_a.flagged == of_b.flagged);
      CHECK(same_bits(of_a.score, of_b.score));
      CHECK(of_a.located_cv == of_b.located_cv);
      CHECK(of_a.source == of_b.source);
      CHECK(of_a.flagged_channels == of_b.flagged_channels);
      CHECK(same_bits(of_a.seconds, of_b.seconds));
    }
  }
}

void check_same(const ComparisonInfo& a, const ComparisonInfo& b) {
  CHECK(a.mpmbench_version == b.mpmbench_version);
  CHECK(a.git_sha == b.git_sha);
  CHECK(a.command == b.command);
}

void check_same(const Campaign& a, const Campaign& b) {
  CHECK(a.study.source == b.study.source);
  CHECK(a.study.seed == b.study.seed);
  check_same(a.info, b.info);
  check_same(a.basis, b.basis);
  check_same(a.audit, b.audit);
  check_same(a.comparison_info, b.comparison_info);
  REQUIRE(a.comparison.has_value() == b.comparison.has_value());
  if (a.comparison)
    check_same(*a.comparison, *b.comparison);
  REQUIRE(a.records.size() == b.records.size());
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    INFO("experiment " << i);
    CHECK(to_bytes(a.records[i]) == to_bytes(b.records[i]));
  }
}

Campaign there_and_back(const Campaign& campaign) {
  const TemporaryFolder folder;
  write_archive(folder / "a.h5", campaign);
  return read_archive(folder / "a.h5");
}

TEST_CASE("archive: whatever numbers and texts a campaign has, they come back bit for bit") {
  const Campaign campaign = made_up_campaign();
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: a campaign without experiments, active limits and disturbances comes back") {
  const Campaign campaign = empty_campaign();
  REQUIRE(campaign.study.md_count() == 0);
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: named scenarios come back with every CV; their faults come from the study") {
  const Campaign campaign = scenario_campaign();
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: healthy experiments and every change of the tuning come back bit for bit") {
  const Campaign campaign = faultless_campaign();
  check_same(there_and_back(campaign), campaign);
}

/// What the reader says of an archive of this campaign.
std::string refusal(const Campaign& campaign) {
  const TemporaryFolder folder;
  write_archive(folder / "a.h5", campaign);
  try {
    read_archive(folder / "a.h5");
    return "accepted";
  } catch (const ArchiveError& error) {
    return error.what();
  }
}

TEST_CASE("archive: a healthy experiment or a changed weight that the study cannot have is refused") {
  using Catch::Contains;
  Campaign healthy = made_up_campaign();
  healthy.records[5].draw = basis_draw();
  healthy.records[5].draw.index = 5;
  CHECK_THAT(refusal(healthy),
             Contains("'kind': found none in experiment 5; allowed: a kind that the study"));
  Campaign tuning = made_up_campaign();
  tuning.records[5].draw = healthy.records[5].draw;
  tuning.records[5].draw.kind = ExperimentKind::tuning;
  CHECK_THAT(refusal(tuning), Contains("'kind': found 4; allowed: 0 to 3"));

  Campaign campaign = faultless_campaign();
  const auto changed = std::find_if(campaign.records.begin(), campaign.records.end(),
                                    [](const ExperimentRecord& record) { return record.draw.tuning; });
  REQUIRE(changed != campaign.records.end());
  const TuningChange drawn = *changed->draw.tuning;
  const std::string where = fmt::format("in experiment {}", changed->draw.index);
  for (const Eigen::Index index : {-1, 2}) {
    changed->draw.tuning->index = index;
    CHECK_THAT(refusal(campaign), Contains("'tuning_index'") && Contains(where));
  }
  changed->draw.tuning = drawn;
  changed->draw.tuning->parameter = static_cast<TuningParameter>(-1);
  CHECK_THAT(refusal(campaign), Contains("'tuning_index'") && Contains(where));
  changed->draw.tuning = drawn;
  for (const double factor : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
    changed->draw.tuning->factor = factor;
    CHECK_THAT(refusal(campaign), Contains("'tuning_factor'") && Contains(where));
  }
}

TEST_CASE("archive: what contradicts the scenarios of its study is refused") {
  using Catch::Contains;
  Campaign kind = scenario_campaign();
  kind.records[1].draw.kind = ExperimentKind::ud;
  CHECK_THAT(refusal(kind),
             Contains("'kind': found another value in experiment 1; allowed: mpm, as in the study"));
  Campaign truth = scenario_campaign();
  truth.records[2].draw.affected_cvs = {{0}};
  CHECK_THAT(refusal(truth),
             Contains("'true_cv': found another value in experiment 2; allowed: 1, as in the study"));
}

TEST_CASE("archive: a basis case whose loop broke comes back without a diagnosis") {
  Campaign campaign = made_up_campaign();
  campaign.basis.trajectory.status = ControlStatus::infeasible;
  campaign.basis.nominal = {};
  campaign.basis.diagnosis = {};
  campaign.basis.healthy = false;
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: the aggregate of what is read equals the aggregate of what was written") {
  const Campaign campaign = made_up_campaign();
  const Campaign read = there_and_back(campaign);
  const std::vector<AggregateValue> expected = named_values(aggregate(campaign.study, campaign.records));
  const std::vector<AggregateValue> found = named_values(aggregate(read.study, read.records));
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    INFO(expected[i].name);
    CHECK(found[i].name == expected[i].name);
    CHECK(found[i].count == expected[i].count);
    CHECK(same_bits(found[i].value, expected[i].value));
    CHECK(same_bits(found[i].interval.lower, expected[i].interval.lower));
    CHECK(same_bits(found[i].interval.upper, expected[i].interval.upper));
  }
}

TEST_CASE("archive: a comparison of some experiments, of one method and of none comes back") {
  Campaign campaign = made_up_campaign();
  campaign.comparison->loops.erase(campaign.comparison->loops.begin() + 3,
                                   campaign.comparison->loops.begin() + 9);
  check_same(there_and_back(campaign), campaign);
  campaign.comparison->methods.resize(1);
  campaign.comparison->reasons.resize(1);
  for (ComparedLoop& loop : campaign.comparison->loops)
    loop.verdicts.resize(1);
  check_same(there_and_back(campaign), campaign);
  campaign.comparison->loops.clear();
  check_same(there_and_back(campaign), campaign);
  campaign.comparison = {};
  campaign.comparison_info = {};
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: a second comparison takes the place of the first, which leaves no trace") {
  Campaign campaign = made_up_campaign();
  Campaign twice = there_and_back(campaign);
  campaign.comparison->loops.resize(5);
  campaign.comparison_info.command = "mpmbench compare again";
  twice.comparison = campaign.comparison;
  twice.comparison_info = campaign.comparison_info;
  const TemporaryFolder folder;
  write_archive(folder / "once.h5", campaign);
  write_archive(folder / "twice.h5", twice);
  CHECK(file_content(folder / "once.h5") == file_content(folder / "twice.h5"));
}

TEST_CASE("archive: records with gaps in their indices keep their indices and loops") {
  Campaign campaign = made_up_campaign();
  campaign.records.erase(campaign.records.begin() + 2, campaign.records.begin() + 9);
  campaign.comparison = made_up_comparison(campaign.study, campaign.records);
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: bytes that are no UTF-8, and NUL, become U+FFFD; the file can be read") {
  Campaign campaign = made_up_campaign();
  campaign.records[0].message = std::string("a\xFF") + '\0' + "b";
  const std::string replacement = "\xEF\xBF\xBD";
  CHECK(there_and_back(campaign).records[0].message == "a" + replacement + replacement + "b");
}

}  // namespace
