#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/csv_table.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/report/report.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "tests/results/made_up_campaign.hpp"

// A method that this program does not have: an archive says all about it that a reader needs.

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

MethodDescription foreign_description() {
  MethodDescription method;
  method.name = "foreign";
  method.title = "Somebody (2031)";
  method.verdict = "something <new> is wrong";
  method.requirements.benchmark = true;
  method.stated_false_alarms = 0.07;
  method.locates_cvs = method.names_channels = method.tells_sources = true;
  method.numbers = {{{.name = "novelty", .meaning = "how new", .unit = "K", .heading = "N_{new}"},
                     NumberScope::loop,
                     NumberFinding::summary},
                    {{.name = "verdict", .meaning = "in words", .words = numbered({"good", "very bad"})},
                     NumberScope::loop},
                    {"shape", NumberScope::cv, "of each CV", "1", NumberFinding::regression},
                    {"gain", NumberScope::channel, "of each channel"},
                    {"memory", NumberScope::cv_lag, "of each CV at each lag"}};
  return method;
}

/// The made-up campaign, in which the foreign method has assessed every loop, too, in any way.
Campaign with_foreign() {
  Campaign campaign = made_up_campaign();
  const auto form = std::make_shared<const AssessmentForm>(foreign_description(), campaign.study);
  campaign.methods.push_back({form, "9.9.9", "fff", "mpmbench compare --methods foreign"});
  campaign.study.methods = method_names(campaign);
  std::uint64_t which = 0;
  for (ExperimentRecord& record : campaign.records)
    record.assessments.push_back(record.status == ExperimentStatus::ok
                                     ? made_up_answer(campaign.study, form, ++which)
                                     : unasked(form));
  return campaign;
}

Campaign read_back(const TemporaryFolder& folder, const Campaign& campaign) {
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  return read_archive(folder / "a.h5");
}

TEST_CASE("foreign method: an archive brings its description and every number of it") {
  const TemporaryFolder folder;
  const Campaign campaign = with_foreign();
  const Campaign read = read_back(folder, campaign);
  REQUIRE(method_names(read) == method_names(campaign));
  const MethodDescription& found = read.methods.back().form->method();
  CHECK(found.title == "Somebody (2031)");
  CHECK(found.verdict == "something <new> is wrong");
  CHECK((found.requirements.benchmark && !found.requirements.setpoints));
  CHECK((found.locates_cvs && found.names_channels && found.tells_sources));
  REQUIRE(found.numbers.size() == 5);
  REQUIRE(found.numbers[1].words.size() == 2);
  CHECK(found.numbers[1].words[1].word == "very bad");
  CHECK(found.numbers[0].heading == "N_{new}");
  CHECK(found.numbers[0].finding == NumberFinding::summary);
  CHECK(found.numbers[2].finding == NumberFinding::regression);
  CHECK(read.methods.back().git_sha == "fff");
  const RecordBytes format(campaign.study, forms_of(campaign));
  bool answered = false;
  for (std::size_t i = 0; i < read.records.size(); ++i) {
    CHECK(format.differences(read.records[i], campaign.records[i]) == std::vector<std::string>{});
    answered = answered || read.records[i].by("foreign")->answered();
  }
  CHECK(answered);
}

TEST_CASE("foreign method: it is in findings, summary, comparison, report and tables") {
  const TemporaryFolder folder;
  const Campaign campaign = read_back(folder, with_foreign());
  const StudyFindings findings = findings_of(campaign);
  REQUIRE(findings.of("foreign") != nullptr);
  CHECK(find_finding(findings.rows, "compare.foreign.detected") != nullptr);
  std::size_t means = 0;
  for (const Finding& finding : findings.rows)
    means += finding.method == "foreign" && finding.name.ends_with("novelty_mean") ? 1 : 0;
  CHECK(means == 3);  // one of each kind
  CHECK_THAT(document_text(comparison_document(campaign, findings)), Contains("foreign"));
  CHECK_THAT(document_text(summary_document(campaign, findings, "a.h5")), Contains("foreign"));
  const nlohmann::json json = nlohmann::json::parse(document_json(comparison_document(campaign, findings)));
  CHECK(json["methods"].back()["title"] == "Somebody (2031)");
  CHECK(nlohmann::json::parse(document_json(summary_document(campaign, findings, "out.h5")))["methods"]
            .back() == "foreign");
  CHECK_THAT(report_html(campaign, findings, "a.h5", {}),
             Contains("Somebody (2031)") && Contains("something &lt;new&gt; is wrong"));
  CHECK_THAT(csv_table(campaign, "foreign"), Contains("novelty") && Contains("very_bad"));
}

TEST_CASE("foreign method: what was read is written as the same bytes again") {
  const TemporaryFolder folder;
  const Campaign read = read_back(folder, with_foreign());
  write_archive(folder / "b.h5", read, findings_of(read));
  CHECK(file_content(folder / "a.h5") == file_content(folder / "b.h5"));
}

TEST_CASE("foreign method: alone in an archive it needs nothing of the methods that this program has") {
  const TemporaryFolder folder;
  Campaign campaign = with_foreign();
  remove_methods(campaign, [](const std::string& name) { return name != "foreign"; });
  const Campaign read = read_back(folder, campaign);
  const StudyFindings findings = findings_of(read);
  CHECK(findings.chain() == nullptr);
  CHECK_THAT(document_text(summary_document(read, findings, "a.h5")),
             Contains("compare") || Contains("experiments"));
  CHECK_THAT(report_html(read, findings, "a.h5", {}), Contains("Which method is right most often?"));
}

}  // namespace
