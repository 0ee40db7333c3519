#include <catch2/catch.hpp>

#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/summary/summary.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

TEST_CASE("archive: a campaign of a shipped study comes back, and so does its summary") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_sample();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const Campaign read = read_archive(folder / "a.h5");
  CHECK(read.study.source == campaign.study.source);
  REQUIRE(read.records.size() == campaign.records.size());
  const RecordBytes bytes(campaign.study, forms_of(campaign));
  for (std::size_t i = 0; i < read.records.size(); ++i)
    CHECK(bytes.differences(read.records[i], campaign.records[i]).empty());
  const StudyFindings findings = findings_of(campaign), of_read = findings_of(read);
  CHECK(document_text(summary_document(read, of_read, "x")) ==
        document_text(summary_document(campaign, findings, "x")));
  CHECK(document_json(summary_document(read, of_read, "out.h5")) ==
        document_json(summary_document(campaign, findings, "out.h5")));
}

TEST_CASE("archive: what was read is written as the same bytes again") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_sample();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const Campaign read = read_archive(folder / "a.h5");
  write_archive(folder / "b.h5", read, findings_of(read));
  CHECK(file_content(folder / "a.h5") == file_content(folder / "b.h5"));
}

}  // namespace
