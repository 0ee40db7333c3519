#include <catch2/catch.hpp>

#include "bench/campaign_runner.hpp"
#include "bench/record_bytes.hpp"
#include "scenarios/study_library.hpp"

namespace {

using namespace mpm;

TEST_CASE("campaign: one, two and three jobs give the same records, and so does a longer campaign") {
  CampaignOptions options;
  options.solver = "active-set";
  options.experiments = 9;
  options.store = StorePolicy::all;
  const Campaign serial = run_campaign(find_study("wood-berry"), options);
  for (const int jobs : {2, 3}) {
    options.jobs = jobs;
    options.experiments = jobs == 2 ? 9 : 14;
    const Campaign parallel = run_campaign(find_study("wood-berry"), options);
    for (std::size_t i = 0; i < serial.records.size(); ++i)
      CHECK(to_bytes(parallel.records[i]) == to_bytes(serial.records[i]));
  }
}

TEST_CASE("campaign: Ipopt in worker processes is reproducible too") {
  CampaignOptions options;
  options.solver = "ipopt";
  options.experiments = 2;
  Study study = find_study("wood-berry");
  options.jobs = 1;
  const Campaign serial = run_campaign(study, options);
  options.jobs = 2;
  const Campaign parallel = run_campaign(study, options);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(to_bytes(parallel.records[i]) == to_bytes(serial.records[i]));
}

TEST_CASE("campaign: an unhealthy basis case stops it, unless it is allowed") {
  Study study = find_study("chapter6");
  for (DisturbanceStep& step : study.simulation.steps)
    step.level *= 0.02;
  CampaignOptions options;
  options.solver = "active-set";
  options.experiments = 1;
  CHECK_THROWS_AS(run_campaign(study, options), UnhealthyBasis);
  options.allow_unhealthy_basis = true;
  CHECK(run_campaign(study, options).records.size() == 1);
}

TEST_CASE("campaign: options that make no campaign are refused") {
  CampaignOptions options;
  options.experiments = 0;
  CHECK_THROWS_AS(run_campaign(find_study("wood-berry"), options), InputError);
  options.experiments = 1;
  options.jobs = 0;
  CHECK_THROWS_AS(run_campaign(find_study("wood-berry"), options), InputError);
  options.jobs = 1;
  options.solver = "none";
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Catch::Contains("ipopt"));
}

}  // namespace
