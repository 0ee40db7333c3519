#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <catch2/catch.hpp>

#include "analysis/findings/calibration.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/document/document_json.hpp"
#include "results/summary/comparison.hpp"
#include "tests/base/thorough.hpp"
#include "tests/bench/serial_campaign.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using Catch::Contains;
using mpm::testing::run_serially;
using mpm::testing::TemporaryFolder;
namespace fs = std::filesystem;

constexpr std::int64_t kExperiments = 4, kLoops = 9;

Study calibrated_wood_berry() {
  return parse_study(find_study("wood-berry").source + "\n[calibration]\nhealthy = 6\nud = 3\n",
                     "wood-berry");
}

RunOptions few() {
  RunOptions options;
  options.experiments = kExperiments;
  options.audit_share = 0.0;
  options.methods = {"botelho", "sse", "counterfactual"};
  return options;
}

void add_methods(Campaign& campaign, const ComparisonOptions& options, const CampaignHooks& hooks,
                 const std::optional<std::int64_t>& experiments = {}) {
  Comparison comparison(campaign, compared_loops(campaign, {}, experiments), options);
  comparison.run(hooks);
  comparison.add_to(campaign, "compare");
}

void check_same(const Calibration& one, const Calibration& other) {
  CHECK(one.seed == other.seed);
  REQUIRE(one.loops.size() == other.loops.size());
  for (std::size_t i = 0; i < one.loops.size(); ++i) {
    INFO("loop " << i);
    CHECK(one.loops[i].kind == other.loops[i].kind);
    REQUIRE(one.loops[i].scores.size() == other.loops[i].scores.size());
    for (std::size_t method = 0; method < one.loops[i].scores.size(); ++method)
      CHECK(std::bit_cast<std::uint64_t>(one.loops[i].scores[method]) ==
            std::bit_cast<std::uint64_t>(other.loops[i].scores[method]));
  }
}

/// Mann and Whitney's z of the scores of one group among both, with the correction for ties; 0 where all are
/// equal.
double rank_z(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> all = one;
  all.insert(all.end(), other.begin(), other.end());
  std::sort(all.begin(), all.end());
  const auto m = static_cast<double>(one.size()), n = static_cast<double>(other.size());
  double ranks = 0.0, ties = 0.0;
  for (const double score : one) {
    const auto [first, last] = std::equal_range(all.begin(), all.end(), score);
    ranks += 0.5 * static_cast<double>((first - all.begin()) + (last - all.begin()) + 1);
  }
  for (auto at = all.begin(); at != all.end();) {
    const auto end = std::upper_bound(at, all.end(), *at);
    const auto equal = static_cast<double>(end - at);
    ties += equal * (equal * equal - 1.0);
    at = end;
  }
  const double variance = m * n / 12.0 * (m + n + 1.0 - ties / ((m + n) * (m + n - 1.0)));
  return variance > 0.0 ? (ranks - 0.5 * m * (m + n + 1.0)) / std::sqrt(variance) : 0.0;
}

TEST_CASE("calibration: in each family of the suites its loops have the scores of healthy experiments") {
  // Of 20 families and 3 methods one in 17 sets of seeds would fail at this level by chance, two-sided.
  constexpr double kLevel = 1e-3;
  constexpr std::size_t kSample = 3;  // one family in so many, unless all are asked for
  const double limit = boost::math::quantile(boost::math::normal(), 1.0 - 0.5 * kLevel);
  const std::string name = GENERATE("standard", "exact");
  if (name != "standard" && !testing::is_thorough())
    return;
  const Suite suite = find_suite(
      name, {.seed = 2, .plants = {"ogunnaike-ray", "wood-berry", "shell-3x3", "tank"}, .families = {}});
  std::set<std::string> families;  // each on the first of these plants that has it
  for (const SuiteCell& cell : suite.cells) {
    const std::string& family = suite.families[cell.family].name;
    if ((suite.plants[cell.plant].name == "tank") != (family == "nonlinear"))
      continue;
    if (!families.insert(family).second || (families.size() % kSample != 1 && !testing::is_thorough()))
      continue;
    Study study = cell.study;
    study.monitoring.reset();
    study.experiments = {};
    study.experiments.healthy = study.calibration->healthy = 40;
    if (study.world)  // a world for each loop, so that they are independent as the test has them
      study.calibration->worlds = study.world->count = 40;
    RunOptions options;
    options.jobs = 2;
    options.audit_share = 0.0;
    options.methods = {"sse", "order", "excitation"};
    const Campaign campaign = run_campaign(study, options);
    for (std::size_t method = 0; method < options.methods.size(); ++method) {
      std::vector<double> experiments, calibration;
      for (const ExperimentRecord& record : campaign.records)
        if (record.status == ExperimentStatus::ok)
          experiments.push_back(calibration_score(record.assessments[method]));
      for (const CalibrationLoop& loop : campaign.calibration.loops)
        if (!std::isnan(loop.scores[method]))
          calibration.push_back(loop.scores[method]);
      INFO(family << ", " << options.methods[method]);
      if (family == "quiet" && options.methods[method] == "excitation") {
        CHECK(calibration.empty());  // nothing moves
        continue;
      }
      REQUIRE(experiments.size() >= 30);
      REQUIRE(calibration.size() >= 30);
      CHECK(std::abs(rank_z(experiments, calibration)) < limit);
    }
  }
  CHECK(families.size() == suite.families.size());
}

TEST_CASE(
    "calibration: threads, processes and methods that are added later give what the serial loop gives") {
  const Study study = calibrated_wood_berry();
  RunOptions options = few();
  const Campaign serial = run_serially(study, options);
  REQUIRE(serial.calibration.loops.size() == kLoops);
  REQUIRE(serial.calibration.loops.front().scores.size() == 3);
  CHECK(calibration_loops(study) == kLoops);
  options.jobs = 2;
  options.parallel = GENERATE(Parallel::threads, Parallel::processes);
  check_same(run_campaign(study, options).calibration, serial.calibration);

  options.methods = {"botelho"};
  Campaign later = run_campaign(study, options);
  int done = 0;
  const CampaignHooks counting{.on_done = [&](bool) { ++done; }};
  add_methods(later, {.methods = {"sse", "counterfactual"}, .jobs = 2}, counting);
  check_same(later.calibration, serial.calibration);
  CHECK(done == std::ssize(compared_loops(later, {}, {}).experiments) + kLoops);
  // Answers that it has are replaced, and stand behind the others.
  add_methods(later, {.methods = {"botelho"}}, {});
  const Campaign chosen = with_methods(later, {"botelho", "sse", "counterfactual"}, {});
  check_same(chosen.calibration, serial.calibration);
}

TEST_CASE("comparison: loops that Ipopt runs again give the same bits for any number of worker processes") {
  const Study study = changed_study(find_study("wood-berry"),  // Ipopt takes its time
                                    {{"simulation.samples", "50"},
                                     {"controller.prediction_horizon", "12"},
                                     {"controller.control_horizon", "3"},
                                     {"sensitivity.samples", "40"},
                                     {"calibration.healthy", "2"},
                                     {"calibration.ud", "1"}},
                                    "short");
  RunOptions options = few();
  options.allow_unhealthy_basis = true;
  options.solver = "ipopt";
  options.experiments = 3;
  options.store = StorePolicy::none;
  options.methods = {"sse", "botelho"};
  Campaign serial = run_serially(study, options);
  serial.info.solver = options.solver;
  const std::vector<BlindLoop> order = blind_order(serial, true);
  ShardStore one(ShardIdentity{});
  run_blind_loops(serial, order, 1, {}, one);
  for (const int jobs : {1, 3}) {
    Campaign later = with_methods(serial, {"sse"}, {});
    add_methods(later, {.methods = {"botelho"}, .jobs = jobs}, {});
    check_same(later.calibration, serial.calibration);
    const RecordBytes format(later.study, forms_of(later));
    for (std::size_t i = 0; i < serial.records.size(); ++i) {
      INFO("experiment " << i << ", " << jobs << " jobs");
      CHECK(format.differences(later.records[i], serial.records[i]) == std::vector<std::string>{});
    }
  }

  ShardStore several(ShardIdentity{});
  run_blind_loops(serial, order, 3, {}, several);
  const BlindLoops::Next first = blind_loops_in(one, order.size()).begin(),
                         second = blind_loops_in(several, order.size()).begin();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const AssessedLoop loop = first();
    CHECK(loop.y == second().y);
    CHECK(loop.samples() > 0);
  }
}

TEST_CASE("blind loops: in worlds each has a benchmark of its plant that no other loop shares") {
  const Study study = changed_study(find_study("wood-berry"),
                                    {{"simulation.samples", "160"},
                                     {"simulation.excitation", "\"each\""},
                                     {"experiments", "{mpm = 2, ud = 0, mpm_ud = 0, healthy = 2}"},
                                     {"world.count", "1"},
                                     {"world.cost_loops", "1"},
                                     {"world.repair_loops", "0"},
                                     {"world.gain_factor", "{constant = 1.2}"},
                                     {"calibration.healthy", "2"},
                                     {"calibration.ud", "0"}},
                                    "worlds");
  RunOptions options = few();
  options.allow_unhealthy_basis = true;
  options.methods = {"sse"};
  const Campaign campaign = run_campaign(study, options);
  const std::vector<BlindLoop> order = blind_order(campaign, true);
  ShardStore one(ShardIdentity{}), several(ShardIdentity{});
  run_blind_loops(campaign, order, 1, {}, one);
  run_blind_loops(campaign, order, 3, {}, several);
  const BlindLoops::Next next_loop = blind_loops_in(one, order.size()).begin(),
                         next_benchmark = blind_benchmarks_in(one, order.size()).begin(),
                         again = blind_benchmarks_in(several, order.size()).begin();
  std::vector<AssessedLoop> seen;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const AssessedLoop loop = next_loop(), benchmark = next_benchmark();
    REQUIRE((loop.samples() == 160 && benchmark.samples() == 160));
    CHECK(benchmark.y == again().y);
    // The plant is that of the world: its gains are 1.2 times those of the model, which y_sim has. Noise and
    // its feedback are why it is not exact.
    CHECK(benchmark.y.cwiseProduct(benchmark.y_sim).sum() / benchmark.y_sim.squaredNorm() ==
          Approx(1.2).margin(0.1));
    CHECK(loop.y != benchmark.y);
    for (const AssessedLoop& other : seen)
      CHECK((other.y != benchmark.y && other.d != benchmark.d));
    seen.push_back(benchmark);
  }
}

TEST_CASE("comparison: an archive may lack experiments between those that it has") {
  RunOptions options = few();
  options.methods = {"botelho"};
  Campaign whole = run_campaign(calibrated_wood_berry(), options);
  Campaign part = whole;
  part.records.erase(part.records.begin() + 1, part.records.begin() + 3);
  const ComparisonOptions comparison{.methods = {"sse"}};
  add_methods(whole, comparison, {});
  add_methods(part, comparison, {});
  whole.records.erase(whole.records.begin() + 1, whole.records.begin() + 3);
  REQUIRE(part.records.size() == whole.records.size());
  for (std::size_t i = 0; i < part.records.size(); ++i) {
    INFO("record " << i);
    CHECK(part.records[i].by("sse")->status == whole.records[i].by("sse")->status);
    CHECK(std::bit_cast<std::uint64_t>(part.records[i].by("sse")->score) ==
          std::bit_cast<std::uint64_t>(whole.records[i].by("sse")->score));
  }
}

TEST_CASE("comparison: of records that stay in the archive the same methods are missing and give the same") {
  const TemporaryFolder folder;
  const Campaign made_up = mpm::testing::made_up_campaign();
  write_archive(folder / "a.h5", made_up, findings_of(made_up));
  const Campaign read = read_archive(folder / "a.h5"), streamed = stream_archive(folder / "a.h5");
  REQUIRE(streamed.records.empty());
  const std::vector<std::string> names = method_names(read), chosen{names.back(), names.front()};
  std::vector<std::string> asked = names;
  asked.push_back("no-such-method");
  for (const std::optional<std::int64_t> experiments : {std::optional<std::int64_t>(), {5}}) {
    const ComparedLoops loops = compared_loops(read, asked, experiments),
                        same = compared_loops(streamed, asked, experiments);
    CHECK(loops.missing.back() == "no-such-method");
    CHECK(loops.missing.size() < asked.size());
    CHECK(same.missing == loops.missing);
    CHECK(same.experiments == loops.experiments);
    CHECK(same.end == loops.end);
    const auto json = [&](const Campaign& campaign) {
      const Campaign part = with_methods(campaign, chosen, experiments);
      return document_json(comparison_document(part, findings_of(part)));
    };
    CHECK((json(streamed) == json(read)));
  }
}

/// A calibrated campaign in which one loop did not run to its end.
Campaign campaign_with_a_gap() {
  RunOptions options = few();
  options.methods = {"botelho"};
  Campaign campaign = run_campaign(calibrated_wood_berry(), options);
  campaign.records[1].status = ExperimentStatus::infeasible;
  campaign.records[1].assessments = unassessed(forms_of(campaign));
  return campaign;
}

/// Every record and the calibration, bit for bit.
void check_same(const Campaign& one, const Campaign& other) {
  CHECK(method_names(one) == method_names(other));
  check_same(one.calibration, other.calibration);
  const RecordBytes bytes(one.study, forms_of(one));
  REQUIRE(records_of(one).size() == records_of(other).size());
  std::size_t count = 0;
  each_in_both(records_of(one), records_of(other), [&](const ExperimentRecord& a, const ExperimentRecord& b) {
    ++count;
    CHECK(bytes.differences(a, b) == std::vector<std::string>{});
  });
  CHECK(count == records_of(one).size());
}

TEST_CASE("comparison: answers come to records that stay in the archive as they do to records in memory") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_with_a_gap();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  Campaign expected = read_archive(folder / "a.h5");
  // One that is missing and one that is there, on the first experiments: the last one has no answer.
  ComparisonOptions options{.methods = {"sse", "botelho"}};
  add_methods(expected, options, {}, 3);
  CHECK(expected.records[2].by("sse")->answered());
  CHECK(expected.records[3].by("botelho")->status == AssessmentStatus::not_assessed);

  Campaign in_memory = stream_archive(folder / "a.h5");
  options.jobs = 3;
  Comparison comparison(in_memory, compared_loops(in_memory, {}, 3), options);
  comparison.run({});
  comparison.add_to(in_memory, "compare");
  check_same(in_memory, expected);

  // Half of the answers are in the folder of a part.
  options.part = PartNumber{1, 2, ""};
  options.archive = "a";
  options.shards = folder / "part";
  Campaign in_shards = stream_archive(folder / "a.h5");
  const ComparedLoops loops = compared_loops(in_shards, {}, 3);
  Comparison(in_shards, loops, options).run({});
  options.part.reset();
  options.parts = {folder / "part"};
  options.shards = folder / "shards";
  Comparison whole(in_shards, loops, options);
  std::int64_t done = 0;
  whole.run({.on_start = [&](std::int64_t earlier, std::int64_t) { done = earlier; }});
  CHECK(done > 0);
  whole.add_to(in_shards, "compare");
  check_same(in_shards, expected);
  write_archive(folder / "a.h5", in_shards, findings_of(in_shards));  // in the place of what it is read from
  check_same(read_archive(folder / "a.h5"), expected);
}

TEST_CASE("comparison: verdicts come to records that stay in the archive as they do to records in memory") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_with_a_gap();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  Campaign read = read_archive(folder / "a.h5"), streamed = stream_archive(folder / "a.h5");
  for (const char* const answers : {"loop,flagged,score\n0,1,3\n1,0,1\n2,1,2\n", "loop,flagged\n2,0\n"}) {
    mpm::testing::make_file(folder / "mine.csv", answers);
    for (Campaign* const each : {&read, &streamed})  // those of the second file replace the others
      add_verdicts(*each, read_verdicts(folder / "mine.csv", "mine", *each), "compare");
    check_same(streamed, read);
  }
  CHECK(method_names(read) == std::vector<std::string>{"botelho", "mine"});
}

TEST_CASE("calibration: stopped in its loops and resumed, it is what one go gives; its shards go as well") {
  const TemporaryFolder folder;
  const fs::path output = folder / "a.h5", shards = shard_folder_of(output);
  const Study study = calibrated_wood_berry();
  RunOptions options = few();
  const Campaign serial = run_serially(study, options);
  options.shard_interval = 0.0;
  std::atomic<int> left = static_cast<int>(kExperiments) + 3;
  const CampaignHooks stopping{.stop = [&] { return left <= 0; }, .on_done = [&](bool) { --left; }};
  CHECK_THROWS_WITH(run_campaign(study, options, stopping, shards), Contains("of 13 experiments"));
  CHECK(has_shards(output));
  CHECK_THROWS_WITH(run_campaign(study, options, {}, shards), Contains("--resume"));
  options.leftovers = Leftovers::resume;
  std::int64_t done = 0;
  const CampaignHooks counting{.on_start = [&](std::int64_t earlier, std::int64_t count) {
    done = earlier;
    CHECK(count == kExperiments + kLoops);
  }};
  const Campaign resumed = run_campaign(study, options, counting, shards);
  CHECK(done >= kExperiments + 3);
  check_same(resumed.calibration, serial.calibration);
  CHECK(has_shards(output));
  remove_shards(output);
  CHECK_FALSE(fs::exists(shards));
}

TEST_CASE("calibration: the seed that it names is not that of the run") {
  const Study study =
      parse_study(find_study("wood-berry").source + "\n[calibration]\nhealthy = 2\nseed = 5\n", "wood-berry");
  RunOptions options = few();
  options.seed = 5;
  CHECK_THROWS_WITH(run_campaign(study, options),
                    Contains("calibration.seed: found 5, the seed of the study"));
}

}  // namespace
