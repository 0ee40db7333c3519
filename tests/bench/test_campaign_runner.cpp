#include <catch2/catch.hpp>

#include "bench/campaign_runner.hpp"
#include "bench/record_bytes.hpp"
#include "scenarios/study_library.hpp"

namespace {

using namespace mpm;

CampaignOptions fourteen() {
  CampaignOptions options;
  options.experiments = 14;
  options.audit_share = 0.003;
  options.store = StorePolicy::all;
  return options;
}

void check_same(const Campaign& one, const Campaign& other, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    INFO("experiment " << i);
    CHECK(to_bytes(one.records[i]) == to_bytes(other.records[i]));
  }
}

TEST_CASE("campaign: one, two and three threads and processes give the same records and the same audit") {
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  options.parallel = Parallel::processes;
  const Campaign serial = run_campaign(study, options);
  REQUIRE(serial.audit.size() > 3);
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  options.jobs = GENERATE(1, 2, 3);
  const Campaign parallel = run_campaign(study, options);
  check_same(parallel, serial, 14);
  REQUIRE(parallel.audit.size() == serial.audit.size());
  for (std::size_t i = 0; i < serial.audit.size(); ++i) {
    CHECK(parallel.audit[i].experiment == serial.audit[i].experiment);
    CHECK(parallel.audit[i].step == serial.audit[i].step);
    CHECK(parallel.audit[i].moves.x == serial.audit[i].moves.x);
    CHECK(parallel.audit[i].targets.x == serial.audit[i].targets.x);
  }
}

TEST_CASE("campaign: a longer one goes on where a shorter one ended") {
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  const Campaign longer = run_campaign(study, options);
  options.experiments = 9;
  check_same(longer, run_campaign(study, options), 9);
}

TEST_CASE("campaign: the audit finds that both solvers agree, and does not change a result") {
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  const Campaign audited = run_campaign(study, options);
  const AuditSummary summary = summarise(audited.audit);
  CHECK(summary.disagreements == 0);
  CHECK(summary.largest_move < 1e-4);  // an interior point is off by 1e-5 at a limit that touches
  CHECK(summary.largest_objective < 1e-7);
  CHECK(audited.info.audit_seconds > 0.0);
  options.audit_share = 0.0;
  const Campaign plain = run_campaign(study, options);
  CHECK(plain.audit.empty());
  check_same(plain, audited, 14);
  options.solver = "active-set";
  check_same(run_campaign(study, options), audited, 14);  // nothing fell back to Ipopt here
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
  options.audit_share = 1.5;
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Catch::Contains("audit share"));
  options.audit_share = 0.0;
  options.solver = "ipopt";
  options.parallel = Parallel::threads;
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Catch::Contains("threads"));
  options.solver = "none";
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Catch::Contains("ipopt"));
}

}  // namespace
