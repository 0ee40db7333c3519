#include <algorithm>
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/study_files/study_file.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/archive_record_reader.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/method_json.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/document/document_text.hpp"
#include "results/files/archive_error.hpp"
#include "results/summary/summary.hpp"
#include "scenarios/loop/draw.hpp"
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

/// The basis case in the shape of a record, which RecordBytes takes apart bit by bit.
std::string basis_bytes(const Study& study, const BasisCase& basis) {
  const AssessmentForms forms = assessment_forms(study, {"botelho"});
  Assessment chain;
  chain.numbers = chain_numbers(basis.diagnosis);
  ExperimentRecord record;
  record.assessments = {kept(forms.front(), chain)};
  record.loop = {basis.trajectory, basis.nominal.y_sim};
  return RecordBytes(study, forms).to_bytes(record);
}

void check_same_limits(const std::vector<ActiveConstraint>& a, const std::vector<ActiveConstraint>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].cv == b[i].cv);
    CHECK(a[i].kind == b[i].kind);
  }
}

void check_same(const Study& study, const BasisCase& a, const BasisCase& b) {
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
  CHECK(basis_bytes(study, a) == basis_bytes(study, b));
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
    CHECK(same_bits(a[i].ipopt_kkt_residual, b[i].ipopt_kkt_residual));
  }
}

void check_same(const std::vector<CampaignMethod>& a, const std::vector<CampaignMethod>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(method_description_json(a[i].form->method()) == method_description_json(b[i].form->method()));
    CHECK(a[i].mpmbench_version == b[i].mpmbench_version);
    CHECK(a[i].git_sha == b[i].git_sha);
    CHECK(a[i].command == b[i].command);
  }
}

void check_same(const Campaign& a, const Campaign& b) {
  CHECK(a.study.source == b.study.source);
  CHECK(a.study.seed == b.study.seed);
  CHECK(a.study.methods == b.study.methods);
  check_same(a.info, b.info);
  check_same(b.study, a.basis, b.basis);
  check_same(a.audit, b.audit);
  check_same(a.methods, b.methods);
  REQUIRE(a.records.size() == b.records.size());
  const RecordBytes bytes(b.study, forms_of(b));
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    INFO("experiment " << i);
    CHECK(bytes.differences(a.records[i], b.records[i]) == std::vector<std::string>{});
  }
}

Campaign there_and_back(const Campaign& campaign) {
  const TemporaryFolder folder;
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
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
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
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
  CHECK_THAT(refusal(tuning), Contains("'kind': found none in experiment 5; allowed: a kind that the study"));

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

TEST_CASE("archive: what is read has the findings of what was written") {
  const Campaign campaign = made_up_campaign();
  const std::vector<Finding> expected = findings_of(campaign).rows;
  const std::vector<Finding> found = findings_of(there_and_back(campaign)).rows;
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

TEST_CASE("archive: one of methods without the chain and of one method comes back") {
  Campaign campaign = made_up_campaign();
  const auto without = [&](const std::function<bool(const std::string&)>& unwanted) {
    remove_methods(campaign, unwanted);
    check_same(there_and_back(campaign), campaign);
  };
  without([](const std::string& name) { return name == "botelho"; });
  without([](const std::string& name) { return name != "sse"; });
  REQUIRE(campaign.methods.size() == 1);
}

TEST_CASE("archive: the resolved study is a root attribute, and makes the same study") {
  const TemporaryFolder folder;
  Campaign campaign = made_up_campaign();
  campaign.study.seed = 77;
  remove_methods(campaign, [](const std::string& name) { return name == "sun"; });
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const std::string text = Hdf5File::open(folder / "a.h5").root().attribute<std::string>("study_resolved");
  CHECK(text != campaign.study.source);
  Study study = parse_study(text, "resolved");
  study.source = campaign.study.source;
  CHECK((study == campaign.study));
}

TEST_CASE("archive: records with gaps in their indices keep their indices and loops") {
  Campaign campaign = made_up_campaign();
  campaign.records.erase(campaign.records.begin() + 2, campaign.records.begin() + 9);
  check_same(there_and_back(campaign), campaign);
}

TEST_CASE("archive: records that are read in blocks of any size are those that are read at once") {
  const TemporaryFolder folder;
  Campaign campaign = made_up_campaign();
  campaign.records.erase(campaign.records.begin() + 2, campaign.records.begin() + 9);
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const AssessmentForms forms = forms_of(campaign);
  const ArchiveRecordReader reader(Hdf5File::open(folder / "a.h5").root(), campaign.study, forms,
                                   record_tables(campaign.study, forms), "a.h5");
  const RecordBytes bytes(campaign.study, forms_of(campaign));
  const std::size_t size = campaign.records.size();
  REQUIRE(reader.size() == size);
  for (const std::size_t block : {std::size_t{1}, std::size_t{3}, size}) {
    for (std::size_t first = 0; first < size; first += block) {
      INFO("from " << first << " in blocks of " << block);
      const std::size_t count = std::min(block, size - first);
      const std::vector<ExperimentRecord> records = reader.read(first, count);
      REQUIRE(records.size() == count);
      for (std::size_t i = 0; i < count; ++i)
        CHECK(bytes.differences(records[i], campaign.records[first + i]) == std::vector<std::string>{});
    }
  }
}

TEST_CASE("archive: a campaign whose records stay in the file has the same summary, and says what is wrong") {
  const TemporaryFolder folder;
  const auto streamed = [&](const Campaign& campaign) {
    write_archive(folder / "a.h5", campaign, findings_of(campaign));
    return stream_archive(folder / "a.h5");
  };
  for (const Campaign& campaign :
       {made_up_campaign(), rich_campaign(), empty_campaign(), scenario_campaign()}) {
    const Campaign read = streamed(campaign);
    CHECK(read.streamed.has_value() != campaign.study.names_scenarios());
    const RecordRange records = records_of(read);
    REQUIRE(records.size() == campaign.records.size());
    // One alone, and one of a range that can only be gone through.
    const RecordRange passing(records.size(), [&records] { return records.one_by_one(); });
    const RecordBytes bytes(campaign.study, forms_of(campaign));
    for (std::size_t i = 0; i < records.size(); ++i)
      for (const ExperimentRecord& record : {records.at(i), passing.at(i)})
        CHECK(bytes.differences(record, campaign.records[i]) == std::vector<std::string>{});
    CHECK(document_text(summary_document(read, findings_of(read), "a.h5")) ==
          document_text(summary_document(campaign, findings_of(campaign), "a.h5")));
  }
  Campaign healthy = made_up_campaign();
  healthy.records[5].draw = basis_draw();
  healthy.records[5].draw.index = 5;
  CHECK_THROWS_WITH(findings_of(streamed(healthy)), Catch::Contains("'kind': found none in experiment 5"));
}

TEST_CASE("archive: bytes that are no UTF-8, and NUL, become U+FFFD; the file can be read") {
  Campaign campaign = made_up_campaign();
  campaign.records[0].message = std::string("a\xFF") + '\0' + "b";
  const std::string replacement = "\xEF\xBF\xBD";
  CHECK(there_and_back(campaign).records[0].message == "a" + replacement + replacement + "b");
}

}  // namespace
