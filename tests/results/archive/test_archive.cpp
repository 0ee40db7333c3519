#include <catch2/catch.hpp>

#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
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
  CHECK(summary_text(read, of_read, "x") == summary_text(campaign, findings, "x"));
  CHECK(summary_json(read, of_read) == summary_json(campaign, findings));
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
