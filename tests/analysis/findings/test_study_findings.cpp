#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include "analysis/findings/study_findings.hpp"
#include "analysis/indicators/diagnosis.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace {

using namespace mpm;
using testing::chain_form;
using testing::made_up_record;
using testing::verdict;

/// Chapter 6 with few replications of the bootstrap.
Study quick_study() {
  Study study = find_study("chapter6");
  study.aggregate.bootstrap_replications = 200;
  return study;
}

/// One with experiments of all kinds.
Study study_of_all_kinds() {
  Study study = quick_study();
  study.experiments = {.mpm = 1, .ud = 1, .mpm_ud = 1, .healthy = 1, .tuning = 1};
  return study;
}

StudyFindings of_chain(const Study& study, const std::vector<ExperimentRecord>& records) {
  return study_findings(study, {chain_form()}, records);
}

const Finding& row(const StudyFindings& findings, const std::string& name) {
  const Finding* const found = find_finding(findings.rows, name);
  INFO(name);
  REQUIRE(found != nullptr);
  return *found;
}

std::set<std::string> names_of(const StudyFindings& findings) {
  std::set<std::string> names;
  for (const Finding& finding : findings.rows)
    names.insert(finding.name);
  return names;
}

TEST_CASE("findings count what was put in") {
  const Study study = quick_study();
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 8; ++i)
    records.push_back(made_up_record(i, ExperimentKind::mpm, i % 7, i < 6 ? 0.2 : 0.05));
  records.push_back(made_up_record(8, ExperimentKind::ud, 3, 0.05));
  records.back().assessments[0].predicted_cv = 4;
  records.push_back(made_up_record(9, ExperimentKind::mpm_ud, 2, 0.3));
  const ExperimentRecord lost = made_up_record(10, ExperimentKind::ud, 1, 0.5);
  records.push_back(testing::without_verdict(lost, ExperimentStatus::infeasible));
  records.push_back(testing::without_verdict(lost, ExperimentStatus::failed));

  const StudyFindings findings = of_chain(study, records);
  CHECK(findings.experiments == 12);
  CHECK(findings.failed == 1);
  CHECK(findings.infeasible.hits == 1);
  CHECK(findings.infeasible.total == 11);
  REQUIRE(findings.chain() != nullptr);
  REQUIRE(findings.chain()->kinds.size() == 3);
  const KindFindings& mpm = findings.chain()->kinds[0];
  CHECK(mpm.located.value == 1.0);
  CHECK(mpm.source_recognised.hits == 6);
  CHECK(mpm.source_recognised.total == 8);
  CHECK(mpm.regression.fit.slope == Approx(2.0));
  CHECK(mpm.regression.fit.r_squared == Approx(1.0));
  const KindFindings& ud = findings.chain()->kinds[1];
  CHECK(ud.experiments == 3);
  CHECK(ud.failed == 1);
  CHECK(ud.infeasible.total == 2);
  CHECK(ud.flagged.total == 1);
  CHECK(ud.located.hits == 0);
  CHECK(ud.confusion.counts()(3, 4) == 1);
  CHECK(ud.source_recognised.value == 1.0);
  CHECK(findings.chain()->kinds[2].source_recognised.total == 0);  // both sources are true
  REQUIRE(findings.dominance.size() == 4);
  CHECK(findings.dominance[3].i_mpm.count == 1);
  CHECK(findings.dominance[3].above_threshold.hits == 1);

  // The same numbers, as rows.
  CHECK(row(findings, "mpm.source_recognised").value == 6.0 / 8.0);
  CHECK(row(findings, "mpm.source_recognised").hits == 6);
  CHECK(row(findings, "mpm.i_mpm_mean").value == Approx((6 * 0.2 + 2 * 0.05) / 8));
  CHECK(row(findings, "mpm.i_mpm_min").value == 0.05);
  CHECK(row(findings, "mpm.i_mpm_max").value == 0.2);
  CHECK(row(findings, "mpm.slope").value == mpm.regression.fit.slope);
  CHECK(row(findings, "mpm.y3.slope").value == mpm.regression_of_cv[2].fit.slope);
  CHECK(row(findings, "ud.failed").value == 1.0);
  CHECK(row(findings, "infeasible").count == 11);

  // And those of all kinds together.
  const KindFindings& both = findings.chain()->kinds[2];
  CHECK(row(findings, "located").hits == 8 + both.located.hits);
  CHECK(row(findings, "located").count == 9 + both.located.total);
  CHECK(row(findings, "source_recognised").hits == 7);
  CHECK(row(findings, "source_recognised").count == 9);
  CHECK(row(findings, "i_mpm_best_threshold").value == Approx((0.05 + 0.2) / 2));
  CHECK(find_finding(findings.rows, "false_alarm") == nullptr);
  CHECK(row(of_chain(study_of_all_kinds(), {}), "false_alarm").count == 0);
}

TEST_CASE("experiments that are not flagged count for nothing but the regression, unless the study says so") {
  Study study = quick_study();
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 5; ++i) {
    records.push_back(made_up_record(i, ExperimentKind::mpm, i, 0.2));
    records.back().assessments[0].flagged = i < 2;
  }
  const auto mpm = [&] { return of_chain(study, records).chain()->kinds[0]; };
  const auto i_mpm_count = [&] { return row(of_chain(study, records), "mpm.i_mpm_mean").count; };
  CHECK(mpm().located.total == 2);
  CHECK(mpm().source_recognised.total == 2);
  CHECK(i_mpm_count() == 2);
  CHECK(mpm().regression.fit.pairs == 35);
  study.diagnosis.source_population = SourcePopulation::feasible;
  CHECK(mpm().source_recognised.total == 5);
  CHECK(i_mpm_count() == 5);
  CHECK(mpm().located.total == 2);
}

TEST_CASE("findings: every row has one name, a share has hits, a number has none") {
  const Study study = study_of_all_kinds();
  const AssessmentForms forms = assessment_forms(study, shipped_methods().names());
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 6; ++i) {
    records.push_back(made_up_record(i, static_cast<ExperimentKind>(1 + i % 3), i, 0.2));
    for (std::size_t method = 1; method < forms.size(); ++method)
      records.back().assessments.push_back(verdict(forms[method], i % 2 == 0, 1.0, i));
  }
  const StudyFindings findings = study_findings(study, forms, records);
  CHECK(names_of(findings).size() == findings.rows.size());
  int shares = 0;
  for (const Finding& finding : findings.rows) {
    INFO(finding.name);
    CHECK_FALSE(finding.label.empty());
    CHECK_FALSE(finding.meaning.empty());
    CHECK(finding.is_share() == (finding.hits >= 0));
    CHECK((finding.group == FindingGroup::kind) ==
          (finding.kind && finding.group != FindingGroup::dominance &&
           finding.group != FindingGroup::faultless));
    if (finding.is_share()) {
      ++shares;
      CHECK(finding.hits <= finding.count);
      if (finding.count > 0)
        CHECK(finding.value == static_cast<double>(finding.hits) / static_cast<double>(finding.count));
    }
    if (!finding.has_interval)
      CHECK(std::isnan(finding.interval.lower));
  }
  CHECK(shares > 50);
}

TEST_CASE("findings: a study without a single experiment has every row that one with experiments has") {
  const Study study = study_of_all_kinds();
  const AssessmentForms forms = assessment_forms(study, {"botelho", "sun"});
  const StudyFindings none = study_findings(study, forms, {});
  std::vector<ExperimentRecord> records{made_up_record(0, ExperimentKind::mpm_ud, 2, 0.2)};
  records[0].assessments.push_back(verdict(forms[1], true, 1.0, 2));
  CHECK(names_of(none) == names_of(study_findings(study, forms, records)));
  for (const char* name : {"experiments", "infeasible", "mpm.located", "ud.source_recognised",
                           "mpm_ud.i_mpm_mean_at_dominance_0.7_to_1", "s0_damping.within_band",
                           "false_alarm_healthy", "false_mpm_tuning", "sun.mpm.located",
                           "compare.sun.roc_area", "compare.botelho.false_alarm_tuning"}) {
    CHECK(row(none, name).count == 0);
    CHECK((std::isnan(row(none, name).value) || row(none, name).value == 0.0));
  }
  CHECK(find_finding(none.rows, "mpm_ud.source_recognised") == nullptr);  // both sources are true
  CHECK(find_finding(none.rows, "nothing") == nullptr);
}

TEST_CASE("findings: those of the chain have no prefix, those of another method have its name") {
  const Study study = study_of_all_kinds();
  const AssessmentForms forms = assessment_forms(study, {"sse", "botelho"});
  ExperimentRecord record = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  record.assessments.insert(record.assessments.begin(), verdict(forms[0], false, 1.0, 4));
  const StudyFindings findings = study_findings(study, forms, std::vector{record});
  CHECK(findings.methods.size() == 2);
  CHECK(findings.methods[0].name() == "sse");
  CHECK(findings.of("sse") == &findings.methods[0]);
  CHECK(findings.chain() == &findings.methods[1]);
  CHECK(findings.of("sun") == nullptr);
  CHECK(row(findings, "mpm.impactful").hits == 1);
  CHECK(row(findings, "mpm.impactful").method == "botelho");
  CHECK(row(findings, "sse.mpm.flagged").hits == 0);
  CHECK(row(findings, "sse.mpm.flagged").count == 1);
  CHECK(row(findings, "sse.mpm.located").count == 0);
  CHECK(find_finding(findings.rows, "sse.mpm.source_recognised") == nullptr);  // it tells no sources
  CHECK(find_finding(findings.rows, "sse.mpm.slope") == nullptr);              // it estimates no Ivar_basis
  CHECK(findings.pairs.size() == 2);
  for (const Finding& finding : findings.rows)
    if (finding.method == "sse") {
      INFO(finding.name);
      CHECK((finding.name.starts_with("sse.") || finding.name.starts_with("compare.sse.")));
      CHECK(finding.meaning.find("Ivar") == std::string::npos);  // a number of the chain
    }
}

TEST_CASE("findings: a study without the chain has those of its methods, and none of the chain") {
  const Study study = study_of_all_kinds();
  const AssessmentForms forms = assessment_forms(study, {"sun"});
  ExperimentRecord record = made_up_record(0, ExperimentKind::mpm, 2, 0.2);
  record.assessments = {verdict(forms[0], true, 1.0, 2)};
  const StudyFindings findings = study_findings(study, forms, std::vector{record});
  CHECK(findings.chain() == nullptr);
  CHECK(findings.dominance.empty());
  CHECK_FALSE(findings.s0_changes);
  CHECK(findings.pairs.empty());
  CHECK(row(findings, "sun.mpm.located").hits == 1);
  CHECK(row(findings, "compare.sun.detected").hits == 1);
  CHECK(row(findings, "experiments").value == 1.0);
  for (const Finding& finding : findings.rows)
    CHECK(finding.method != "botelho");
}

TEST_CASE("findings: an experiment that a method was not asked for does not count for it") {
  const Study study = quick_study();
  const AssessmentForms forms = assessment_forms(study, {"botelho", "sun"});
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 5; ++i) {
    records.push_back(made_up_record(i, ExperimentKind::mpm, i, 0.2));
    AssessmentRecord said = verdict(forms[1], true, 1.0, i);
    if (i >= 2) {
      said = {};
      said.form = forms[1];
    }
    records.back().assessments.push_back(said);
  }
  const StudyFindings findings = study_findings(study, forms, records);
  CHECK(row(findings, "mpm.located").count == 5);
  CHECK(row(findings, "sun.mpm.located").count == 2);
  CHECK(row(findings, "sun.mpm.flagged").count == 2);
  CHECK(row(findings, "compare.sun.answered").count == 2);
  CHECK(row(findings, "compare.botelho.answered").count == 5);
  CHECK(findings.pairs[0].loops == 2);
}

TEST_CASE("findings: what others have reported stands beside the number of this name") {
  Study study = quick_study();
  study.reported = {{"mpm.located", 0.985}, {"compare.botelho.detected", 0.5}, {"nothing", 1.0}};
  const StudyFindings findings = of_chain(study, {});
  CHECK(row(findings, "mpm.located").reported == 0.985);
  CHECK(row(findings, "compare.botelho.detected").reported == 0.5);
  int reported = 0;
  for (const Finding& finding : findings.rows)
    reported += finding.has_reported() ? 1 : 0;
  CHECK(reported == 2);
}

TEST_CASE("findings: forms have their words") {
  CHECK(to_string(FindingForm::share) == "share");
  CHECK(to_string(FindingForm::number) == "number");
}

TEST_CASE("summarise: t interval of the mean") {
  const SampleSummary summary = summarise({1.0, 2.0, 3.0, std::nan("")}, 0.95);
  CHECK(summary.count == 3);
  CHECK(summary.mean == Approx(2.0));
  // t(0.975, 2) = 4.302653 from tables; standard error 1/sqrt(3).
  CHECK(summary.mean_interval.upper == Approx(2.0 + 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(summarise({}, 0.95).count == 0);
  CHECK(std::isnan(summarise({1.0}, 0.95).mean_interval.lower));
}

TEST_CASE("farthest_from_one: linear and logarithmic distance, ties and NaN") {
  const Eigen::Vector3d indices(1.8, 0.4, 1.0);
  CHECK(farthest_from_one(indices, LocationDistance::linear) == 0);
  CHECK(farthest_from_one(indices, LocationDistance::logarithmic) == 1);
  CHECK(farthest_from_one(Eigen::Vector3d(1.0, 1.0, 1.0), LocationDistance::linear) == 0);
  CHECK(farthest_from_one(Eigen::Vector3d(std::nan(""), 1.1, 1.2), LocationDistance::linear) == 2);
  CHECK(farthest_from_one(Eigen::Vector2d::Constant(std::nan("")), LocationDistance::linear) == -1);
}

}  // namespace
