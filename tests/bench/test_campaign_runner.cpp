#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/shards/shard_folder.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/world.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/analysis/experiment/brittle_tank.hpp"
#include "tests/bench/serial_campaign.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using Catch::Contains;
using mpm::testing::run_serially;
using mpm::testing::TemporaryFolder;
namespace fs = std::filesystem;

RunOptions fourteen() {
  RunOptions options;
  options.experiments = 14;
  options.audit_share = 0.003;
  options.store = StorePolicy::all;
  return options;
}

void check_same(const Campaign& one, const Campaign& other, std::size_t count) {
  REQUIRE(one.records.size() >= count);
  REQUIRE(other.records.size() >= count);
  REQUIRE(method_names(one) == method_names(other));
  const RecordBytes format(one.study, forms_of(one));
  for (std::size_t i = 0; i < count; ++i) {
    INFO("experiment " << i);
    CHECK(format.differences(one.records[i], other.records[i]) == std::vector<std::string>{});
  }
}

void check_same_audit(const Campaign& one, const Campaign& other) {
  REQUIRE(one.audit.size() == other.audit.size());
  for (std::size_t i = 0; i < one.audit.size(); ++i) {
    CHECK(one.audit[i].experiment == other.audit[i].experiment);
    CHECK(one.audit[i].step == other.audit[i].step);
    CHECK(one.audit[i].moves.x == other.audit[i].moves.x);
    CHECK(one.audit[i].targets.x == other.audit[i].targets.x);
  }
}

TEST_CASE("campaign: one, two and three threads and processes give what the serial loop gives") {
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  const Campaign serial = run_serially(study, options);
  REQUIRE(serial.records.size() == 14);
  REQUIRE(serial.audit.size() > 3);
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  options.jobs = GENERATE(1, 2, 3);
  const Campaign parallel = run_campaign(study, options);
  CHECK(parallel.basis.trajectory.y == serial.basis.trajectory.y);
  CHECK(parallel.basis.sensitivity.static_gain() == serial.basis.sensitivity.static_gain());
  check_same(parallel, serial, 14);
  check_same_audit(parallel, serial);
}

TEST_CASE("campaign: loops in worlds with excitations of their own are those of the serial loop") {
  Study study = find_study("wood-berry");
  study.simulation.excitation = SignalSequence::each;
  study.world = WorldRanges{.count = 3,
                            .gain_factor = Distribution::uniform(0.95, 1.05),
                            .background = {.cv_size = Distribution::uniform(0.2, 0.5)},
                            .cost_loops = 2};
  RunOptions options = fourteen();
  options.jobs = 2;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  const Campaign campaign = run_campaign(study, options);
  check_same(campaign, run_serially(study, options), 14);

  // An archive has the worlds, so that its loops are run again in theirs.
  study.source +=
      "\n[world]\ncount = 3\ngain_factor = {uniform = [0.95, 1.05]}\ncost_loops = 2\n"
      "background.cv_size = {uniform = [0.2, 0.5]}\n";
  const Study of_file = parse_study(study.source, "wood-berry");
  options.experiments = 6;
  options.store = StorePolicy::none;
  Campaign written = run_campaign(of_file, options);
  const TemporaryFolder folder;
  write_archive(folder / "a.h5", written, findings_of(written));
  const Campaign read = read_archive(folder / "a.h5");
  ExperimentRunner again(read.study, read.basis, method_names(read), qp_solver_factory("active-set"));
  for (const ExperimentRecord& record : read.records) {
    CHECK(record.draw.world == world_of(of_file, record.draw.index));
    const ExperimentRecord same = again.run(record.draw.index, StorePolicy::none);
    CHECK(same.ivar_basis == record.ivar_basis);
    if (same.repair.gain.size() > 0)
      CHECK((same.repair.gain == record.repair.gain && same.repair.error == record.repair.error));
    else
      CHECK_FALSE(record.repair.best());
    CHECK(again.assess(record).front().score == record.assessments.front().score);
  }
}

TEST_CASE("campaign: loops on a nonlinear plant are those of the serial loop in threads and processes") {
  const Study study = find_study("chapter5-tank");
  RunOptions options;
  options.experiments = 6;
  options.store = StorePolicy::all;
  options.jobs = 3;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  check_same(run_campaign(study, options), run_serially(study, options), 6);
}

TEST_CASE("campaign: another seed is that of the options, and gives other experiments") {
  const Study study = find_study("wood-berry");
  RunOptions options;
  options.experiments = 2;
  options.seed = 7;
  const Campaign campaign = run_campaign(study, options);
  CHECK(campaign.study.seed == 7);
  check_same(campaign, run_serially(study, options), 2);
  options.seed = {};
  const Campaign other = run_serially(study, options);
  CHECK(campaign.records[0].draw.mismatches != other.records[0].draw.mismatches);
  CHECK(campaign.records[0].solver.iterations != other.records[0].solver.iterations);
}

TEST_CASE("campaign: the methods of the options take the place of the study's, and change no other answer") {
  const Study study = find_study("wood-berry");
  RunOptions options;
  options.experiments = 6;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  const Campaign chain = run_campaign(study, options);
  CHECK(method_names(chain) == std::vector<std::string>{"botelho"});
  options.methods = {"all"};
  options.jobs = 2;
  const Campaign all = run_campaign(study, options);
  CHECK(method_names(all) == shipped_methods().names());
  CHECK(all.study.methods == shipped_methods().names());
  check_same(all, run_serially(study, options), 6);
  const RecordBytes format(chain.study, forms_of(chain));
  for (std::size_t i = 0; i < 6; ++i) {
    ExperimentRecord alone = all.records[i];
    alone.assessments = {*alone.by("botelho")};
    CHECK(format.differences(alone, chain.records[i]) == std::vector<std::string>{});
  }
  options.methods = {"sse", "some"};
  CHECK_THROWS_WITH(run_campaign(study, options),
                    Contains("--methods: found 'some' (nearest: 'sse'); allowed: each once: botelho"));
}

TEST_CASE("campaign: an experiment whose plant fails costs itself only") {
  Study study = find_study("chapter2-tank");
  study.scenarios = {{"none", "", {}, {}, {}},
                     {"broken", "", {}, {}, std::vector<Eigen::Index>{0}, {{"cd2", 2.0}}},
                     {"none again", "", {}, {}, {}}};
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>& changes) {
    return std::make_shared<const testing::BrittleTank>(true, changes.empty());
  };
  RunOptions options;
  options.experiments = 3;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  const Campaign campaign = run_campaign(study, options);
  REQUIRE(campaign.records.size() == 3);
  CHECK(campaign.records[0].status == ExperimentStatus::ok);
  CHECK(campaign.records[1].status == ExperimentStatus::failed);
  CHECK_THAT(campaign.records[1].message, Contains("could not be integrated"));
  CHECK(campaign.records[2].status == ExperimentStatus::ok);
}

TEST_CASE("campaign: a longer one goes on where a shorter one ended") {
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  const Campaign longer = run_campaign(study, options);
  options.experiments = 9;
  check_same(longer, run_campaign(study, options), 9);
}

TEST_CASE("campaign: the audit finds that both solvers agree, and does not change a result") {
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
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
  RunOptions options;
  options.solver = "ipopt";
  options.experiments = 2;
  // Small problems: Ipopt takes its time, and in which process it works has nothing to do with their size.
  const Study study = changed_study(find_study("wood-berry"),
                                    {{"simulation.samples", "150"},
                                     {"controller.prediction_horizon", "20"},
                                     {"controller.control_horizon", "4"},
                                     {"sensitivity.samples", "60"}},
                                    "short");
  options.allow_unhealthy_basis = true;
  options.jobs = 2;
  check_same(run_campaign(study, options), run_serially(study, options), 2);
}

TEST_CASE("campaign: an unhealthy basis case stops it, unless it is allowed") {
  Study study = find_study("chapter6");
  for (SignalStep& step : study.simulation.steps)
    step.level *= 0.02;
  RunOptions options;
  options.solver = "active-set";
  options.experiments = 1;
  CHECK_THROWS_AS(run_campaign(study, options), UnhealthyBasis);
  options.allow_unhealthy_basis = true;
  CHECK(run_campaign(study, options).records.size() == 1);
}

/// Stops a campaign after some experiments, in the way of a signal.
Campaign interrupted(const Study& study, const RunOptions& options, const fs::path& shards, int experiments) {
  std::atomic<int> left = experiments;
  const CampaignHooks hooks{.stop = [&] { return left <= 0; }, .on_done = [&](bool) { --left; }};
  return run_campaign(study, options, hooks, shards);
}

TEST_CASE("campaign: stopped and resumed until it is done, it is what the serial loop gives") {
  const TemporaryFolder folder;
  const fs::path shards = folder / "s";
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  const Campaign serial = run_serially(study, options);
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  options.jobs = 2;
  CHECK_THROWS_WITH(interrupted(study, options, shards, 3), Contains("of 14 experiments"));
  CHECK_THROWS_WITH(run_campaign(study, options, {}, shards), Contains("--resume"));
  options.leftovers = Leftovers::resume;
  CHECK_THROWS_AS(interrupted(study, options, shards, 3), Interrupted);
  std::int64_t done = -1;
  const CampaignHooks hooks{.on_start = [&](std::int64_t earlier, std::int64_t count) {
    done = earlier;
    CHECK(count == 14);
  }};
  const Campaign resumed = run_campaign(study, options, hooks, shards);
  CHECK(done >= 6);
  CHECK(done < 14);
  check_same(resumed, serial, 14);
  check_same_audit(resumed, serial);
}

/// Whether another process may use the folder of shards.
bool is_free_for_others(const fs::path& shards) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      const ShardFolder folder(shards);
      ::_exit(0);
    } catch (const InputError&) {
      ::_exit(1);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_CASE("campaign: its shards are locked until its archive is written") {
  const TemporaryFolder folder;
  const fs::path shards = folder / "s";
  RunOptions options = fourteen();
  options.experiments = 2;
  bool was_free = true;
  const CampaignHooks hooks{.on_end = [&](Campaign& campaign) {
    CHECK(campaign.records.size() == 2);
    was_free = is_free_for_others(shards);
  }};
  run_campaign(find_study("wood-berry"), options, hooks, shards);
  CHECK_FALSE(was_free);
  CHECK(is_free_for_others(shards));
}

/// The processes that this one has forked.
std::vector<pid_t> children() {
  std::ifstream file("/proc/thread-self/children");
  return {std::istream_iterator<pid_t>(file), {}};
}

TEST_CASE("campaign: the audit of a worker that crashed is said and done again, and found no disagreement") {
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  options.jobs = 1;
  options.parallel = Parallel::threads;
  const Campaign serial = run_serially(study, options);
  std::vector<std::string> warnings;
  std::size_t kills = GENERATE(1U, 1000U);  // once, and whenever an outcome comes
  const auto crash_one = [&](bool) {
    if (kills-- > 0)
      for (const pid_t worker : children())
        ::kill(worker, SIGSEGV);
  };
  const CampaignHooks hooks{.on_done = crash_one,
                            .on_warning = [&](const std::string& text) { warnings.push_back(text); }};
  const Campaign campaign = run_campaign(study, options, hooks);
  REQUIRE_FALSE(warnings.empty());
  CHECK_THAT(warnings.front(),
             Contains("was lost: worker process ended by signal 11") && Contains("audited again"));
  CHECK(summarise(campaign.audit).disagreements == 0);
  check_same(campaign, serial, 14);
  if (warnings.size() == 1)
    check_same_audit(campaign, serial);
}

TEST_CASE("campaign: what a worker did that somebody killed is done again") {
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  options.jobs = 1;
  options.parallel = Parallel::threads;
  const Campaign serial = run_serially(study, options);
  int kills = 1;
  std::vector<std::string> warnings;
  const auto kill_one = [&](bool) {
    if (kills-- > 0)
      for (const pid_t worker : children())
        ::kill(worker, SIGKILL);
  };
  const CampaignHooks hooks{.on_done = kill_one,
                            .on_warning = [&](const std::string& text) { warnings.push_back(text); }};
  check_same(run_campaign(study, options, hooks), serial, 14);
  REQUIRE_FALSE(warnings.empty());
  CHECK_THAT(warnings.front(), Contains("ended by signal 9") && Contains("tried once more"));
}

TEST_CASE("campaign: a stop does not wait for the basis case, and keeps what is in shards") {
  const TemporaryFolder folder;
  const fs::path shards = folder / "s";
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  options.leftovers = Leftovers::resume;
  int asked = 0;
  bool started = false;
  const auto stop_early = [&] {
    asked = 0;
    const CampaignHooks hooks{.stop = [&] { return ++asked == 5; },  // nobody after the basis case sees it
                              .on_start = [&](std::int64_t, std::int64_t) { started = true; }};
    return run_campaign(study, options, hooks, shards);
  };
  CHECK_THROWS_WITH(stop_early(), Contains("0 of 14 experiments"));
  CHECK(asked == 5);
  CHECK_FALSE(fs::exists(shards));

  CHECK_THROWS_AS(interrupted(study, options, shards, 3), Interrupted);
  CHECK_THROWS_WITH(stop_early(), !Contains("stopped when 0 of") && Contains("of 14 experiments"));
  CHECK_FALSE(started);
  CHECK(run_campaign(study, options, {}, shards).records.size() == 14);
}

TEST_CASE(
    "campaign: shards of another seed, solver, audit, store policy, study or other methods are refused") {
  const TemporaryFolder folder;
  const fs::path shards = folder / "s";
  const Study study = find_study("wood-berry");
  RunOptions options = fourteen();
  options.leftovers = Leftovers::resume;
  CHECK_THROWS_AS(interrupted(study, options, shards, 2), Interrupted);
  const auto refusal = [&](const Study& other_study, const RunOptions& other) -> std::string {
    try {
      run_campaign(other_study, other, {}, shards);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  Study other_study = study;
  other_study.source += "\n# a comment\n";
  CHECK_THAT(refusal(other_study, options), Contains("another study"));
  RunOptions other = options;
  other.seed = study.seed + 1;
  CHECK_THAT(refusal(study, other), Contains("another seed"));
  other = options;
  other.solver = "active-set";
  CHECK_THAT(refusal(study, other), Contains("another solver"));
  other = options;
  other.audit_share = 0.5;
  CHECK_THAT(refusal(study, other), Contains("another audit"));
  other = options;
  other.store = StorePolicy::none;
  CHECK_THAT(refusal(study, other), Contains("another store"));
  other = options;
  other.methods = {"botelho", "sse"};
  CHECK_THAT(refusal(study, other), Contains("another methods: found botelho; allowed: botelho, sse"));
  CHECK(run_campaign(study, options, {}, shards).records.size() == 14);
}

TEST_CASE("campaign: an exception on the way of an outcome ends threads and processes, and is passed on") {
  RunOptions options = fourteen();
  options.jobs = 2;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  const CampaignHooks hooks{.on_done = [](bool) { throw ArchiveError("disk full"); }};
  CHECK_THROWS_WITH(run_campaign(find_study("wood-berry"), options, hooks), "disk full");
}

TEST_CASE("campaign: options that make no campaign are refused") {
  RunOptions options;
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
