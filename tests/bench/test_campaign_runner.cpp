#include <atomic>
#include <filesystem>

#include <catch2/catch.hpp>

#include "bench/campaign_runner.hpp"
#include "bench/record_bytes.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/study_library.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using Catch::Contains;
using mpm::testing::TemporaryFolder;

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

TEST_CASE("campaign: loops on a nonlinear plant are the same in threads and processes") {
  const Study study = find_study("chapter5-tank");
  CampaignOptions options;
  options.experiments = 6;
  options.store = StorePolicy::all;
  options.jobs = 1;
  const Campaign serial = run_campaign(study, options);
  options.jobs = 3;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  check_same(run_campaign(study, options), serial, 6);
}

TEST_CASE("campaign: an experiment whose plant cannot rest where its loop begins costs itself only") {
  Study study = find_study("wood-berry");
  const TransferFunction integrator(Eigen::VectorXd::Constant(1, -1.0), Eigen::Vector2d(1.0, 0.0));
  study.scenarios = {{"none", "", {}, {}, {}},
                     {"integrates", "", {{0, 1, MismatchParameter::channel, 0.0, integrator}}, {}, {}},
                     {"none again", "", {}, {}, {}}};
  CampaignOptions options;
  options.experiments = 3;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  const Campaign campaign = run_campaign(study, options);
  REQUIRE(campaign.records.size() == 3);
  CHECK(campaign.records[0].status == ExperimentStatus::ok);
  CHECK(campaign.records[1].status == ExperimentStatus::failed);
  CHECK_THAT(campaign.records[1].message, Contains("no steady state to begin at"));
  CHECK(campaign.records[2].status == ExperimentStatus::ok);
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
  for (SignalStep& step : study.simulation.steps)
    step.level *= 0.02;
  CampaignOptions options;
  options.solver = "active-set";
  options.experiments = 1;
  CHECK_THROWS_AS(run_campaign(study, options), UnhealthyBasis);
  options.allow_unhealthy_basis = true;
  CHECK(run_campaign(study, options).records.size() == 1);
}

/// Stops a campaign after some experiments, in the way of a signal.
Campaign interrupted(const Study& study, CampaignOptions options, int experiments) {
  std::atomic<int> left = experiments;
  options.on_done = [&](const ExperimentRecord&) { --left; };
  options.stop = [&] { return left <= 0; };
  return run_campaign(study, options);
}

TEST_CASE("campaign: stopped and resumed until it is done, it is the campaign of one go") {
  const TemporaryFolder folder;
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  const Campaign whole = run_campaign(study, options);
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  options.jobs = 2;
  options.shards = ShardOptions{folder / "s", Leftovers::refuse};
  CHECK_THROWS_WITH(interrupted(study, options, 3), Contains("of 14 experiments"));
  CHECK_THROWS_WITH(run_campaign(study, options), Contains("--resume"));
  options.shards->leftovers = Leftovers::resume;
  CHECK_THROWS_AS(interrupted(study, options, 3), Interrupted);
  std::int64_t done = -1;
  options.on_start = [&](std::int64_t count) { done = count; };
  const Campaign resumed = run_campaign(study, options);
  CHECK(done >= 6);
  CHECK(done < 14);
  check_same(resumed, whole, 14);
  REQUIRE(resumed.audit.size() == whole.audit.size());
  for (std::size_t i = 0; i < whole.audit.size(); ++i) {
    CHECK(resumed.audit[i].experiment == whole.audit[i].experiment);
    CHECK(resumed.audit[i].step == whole.audit[i].step);
    CHECK(resumed.audit[i].moves.x == whole.audit[i].moves.x);
  }
}

TEST_CASE("campaign: a stop does not wait for the basis case, and keeps what is in shards") {
  const TemporaryFolder folder;
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  options.shards = ShardOptions{folder / "s", Leftovers::resume};
  int asked = 0;
  bool started = false;
  const auto stop_early = [&] {
    CampaignOptions stopped = options;
    asked = 0;
    stopped.stop = [&] { return ++asked == 5; };  // once only: nobody after the basis case would see it
    stopped.on_start = [&](std::int64_t) { started = true; };
    return run_campaign(study, stopped);
  };
  CHECK_THROWS_WITH(stop_early(), Contains("0 of 14 experiments"));
  CHECK(asked == 5);
  CHECK_FALSE(std::filesystem::exists(folder / "s"));

  CHECK_THROWS_AS(interrupted(study, options, 3), Interrupted);
  CHECK_THROWS_WITH(stop_early(), !Contains("stopped when 0 of") && Contains("of 14 experiments"));
  CHECK_FALSE(started);
  CHECK(run_campaign(study, options).records.size() == 14);
}

TEST_CASE("campaign: shards of another seed, solver, audit, store policy or study are refused") {
  const TemporaryFolder folder;
  const Study study = find_study("wood-berry");
  CampaignOptions options = fourteen();
  options.shards = ShardOptions{folder / "s", Leftovers::resume};
  CHECK_THROWS_AS(interrupted(study, options, 2), Interrupted);
  const auto refusal = [&](const Study& other_study, const CampaignOptions& other) -> std::string {
    try {
      run_campaign(other_study, other);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  Study other_study = study;
  other_study.seed += 1;
  CHECK_THAT(refusal(other_study, options), Contains("another seed"));
  other_study = study;
  other_study.source += "\n# a comment\n";
  CHECK_THAT(refusal(other_study, options), Contains("another study"));
  CampaignOptions other = options;
  other.solver = "active-set";
  CHECK_THAT(refusal(study, other), Contains("another solver"));
  other = options;
  other.audit_share = 0.5;
  CHECK_THAT(refusal(study, other), Contains("another audit"));
  other = options;
  other.store = StorePolicy::none;
  CHECK_THAT(refusal(study, other), Contains("another store"));
  CHECK(run_campaign(study, options).records.size() == 14);
}

TEST_CASE("campaign: an exception on the way of an outcome ends threads and processes, and is passed on") {
  CampaignOptions options = fourteen();
  options.jobs = 2;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  options.on_done = [](const ExperimentRecord&) { throw ArchiveError("disk full"); };
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), "disk full");
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
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Contains("audit share"));
  options.audit_share = 0.0;
  options.solver = "ipopt";
  options.parallel = Parallel::threads;
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Contains("threads"));
  options.solver = "none";
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options), Contains("ipopt"));
}

}  // namespace
