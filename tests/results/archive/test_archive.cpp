#include <catch2/catch.hpp>

#include "bench/record_bytes.hpp"
#include "results/archive/archive.hpp"
#include "results/summary/summary.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

TEST_CASE("archive: a campaign of a shipped study comes back, and so does its summary") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_sample();
  write_archive(folder / "a.h5", campaign);
  const Campaign read = read_archive(folder / "a.h5");
  CHECK(read.study.source == campaign.study.source);
  REQUIRE(read.records.size() == campaign.records.size());
  for (std::size_t i = 0; i < read.records.size(); ++i)
    CHECK(to_bytes(read.records[i]) == to_bytes(campaign.records[i]));
  CHECK(summary_text(read, "x") == summary_text(campaign, "x"));
  CHECK(summary_json(read) == summary_json(campaign));
}

TEST_CASE("archive: what was read is written as the same bytes again") {
  const TemporaryFolder folder;
  write_archive(folder / "a.h5", campaign_sample());
  write_archive(folder / "b.h5", read_archive(folder / "a.h5"));
  CHECK(file_content(folder / "a.h5") == file_content(folder / "b.h5"));
}

}  // namespace
