#include <catch2/catch.hpp>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/study_files/study_file.hpp"
#include "bench/campaign/campaign_runner.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/execution/thread_solvers.hpp"
#include "results/archive/record_bytes.hpp"
#include "scenarios/loop/historian.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/bench/serial_campaign.hpp"

// Ipopt may run in one thread of a process only, so that threads leave to processes what needs it.

namespace {

using namespace mpm;
using mpm::testing::run_serially;

/// The loops of its second scenario need no Ipopt, but some of those that the method `adequacy` simulates do.
constexpr const char* kStudy = R"(
[study]
name = "left-to-ipopt"
title = "Of the loops that the method adequacy simulates, some have problems that need Ipopt"
seed = 2018148893667950986

[plant]
catalogue = "quadruple-tank-flows"
simulated = "nonlinear"
integrator = "runge-kutta"
relative_tolerance = 1e-08

[controller]
sample_time = 10.0
prediction_horizon = 48
control_horizon = 12
weight_convention = "direct"

[controller.mv]
v1 = {cost = -350.0, move_suppression = 50.0, target_weight = 10.0, hard = [-3.1, 6.8]}
v2 = {cost = -350.0, move_suppression = 50.0, target_weight = 10.0, hard = [-3.05, 6.85]}
x1 = {cost = 60.0, move_suppression = 50.0, target_weight = 10.0, hard = [-0.38, 0.52]}
x2 = {cost = 60.0, move_suppression = 50.0, target_weight = 10.0, hard = [-0.29, 0.61]}

[controller.cv]
h1 = {slack_weight = 125000.0, soft = [-1.0, 1.0], hard = [-12.593, 7.407]}
h2 = {slack_weight = 125000.0, soft = [-1.0, 1.0], hard = [-13.423, 6.577]}
h3 = {slack_weight = 125000.0, soft = [-1.0, 1.0], hard = [-4.73, 15.27]}
h4 = {slack_weight = 125000.0, soft = [-1.0, 1.0], hard = [-5.145, 14.855]}

[simulation]
samples = 116
noise_standard_deviation = 0.02

[[simulation.step]]
md = "F1"
sample = 2
level = 0.5

[[simulation.step]]
md = "F2"
sample = 8
level = 0.5

[[simulation.step]]
md = "F1"
sample = 14
level = 0.0

[[simulation.step]]
md = "F2"
sample = 20
level = 0.0

[[simulation.step]]
md = "F1"
sample = 26
level = -0.5

[[simulation.step]]
md = "F2"
sample = 31
level = -0.5

[disturbance]
v_standard_deviation = 0.1

[sensitivity]
step_direction = "into-range"

[diagnosis]
windows = [0.125, 0.7519056106758906]
self_check_band = [0.7, 1.9]

[assessment]
model_error = 0.029787940582522456
washout = 314.3437010751814
adequacy = {probability = 0.6262440776906489, deviation = 0.44145520566988383, draws = 3, channels = 3}

[[scenario]]
name = "M1"
affected = ["h2"]

[[scenario.parameter]]
name = "cd2"
value = 6.47

[[scenario]]
name = "M6"
affected = ["h1", "h3"]

[[scenario.parameter]]
name = "exp3"
value = 0.1

[record]
quantisation = 2.636133176428026
compression = 0.3556902590467854

[record.missing]
fill = "hold"
share = 0.09480973047068837

[aggregate]
bootstrap_replications = 104
confidence = 0.05586474762772797
)";

void check_same_answers(const Campaign& one, const Campaign& other) {
  REQUIRE(one.records.size() == 2);
  REQUIRE(other.records.size() == 2);
  const RecordBytes format(one.study, forms_of(one));
  for (std::size_t i = 0; i < one.records.size(); ++i)
    CHECK(format.differences(one.records[i], other.records[i]).empty());
}

RunOptions options_of(std::vector<std::string> methods, Parallel parallel) {
  RunOptions options;
  options.methods = std::move(methods);
  options.parallel = parallel;
  options.allow_unhealthy_basis = true;
  options.store = StorePolicy::all;
  return options;
}

TEST_CASE("left to Ipopt: the loops of a method, in threads as in processes") {
  const Study study = parse_study(kStudy, "left-to-ipopt");
  const RunOptions options = options_of({"adequacy"}, GENERATE(Parallel::threads, Parallel::processes));
  const Campaign serial = run_serially(study, options);
  check_same_answers(serial, run_campaign(study, options));
  for (const ExperimentRecord& record : serial.records)
    CHECK(record.solver.fallbacks == 0);
  RunOptions alone = options;
  alone.solver = "active-set";
  const Campaign without = run_serially(study, alone);
  CHECK(RecordBytes(serial.study, forms_of(serial)).differences(serial.records[1], without.records[1]) ==
        std::vector<std::string>{"methods/adequacy/gain"});
}

TEST_CASE("left to Ipopt: the loops of a method that is asked about those of a campaign") {
  const Study study = parse_study(kStudy, "left-to-ipopt");
  Campaign campaign = run_campaign(study, options_of({"sse"}, Parallel::by_solver));
  ComparisonOptions options;
  options.methods = {"adequacy"};
  Comparison comparison(campaign, compared_loops(campaign, {}, {}), options);
  comparison.run({});
  comparison.add_to(campaign, "compare");
  const Campaign serial = run_serially(study, options_of({"adequacy"}, Parallel::by_solver));
  for (std::size_t i = 0; i < serial.records.size(); ++i) {
    const Eigen::MatrixXd asked = campaign.records[i].assessments.back().values("gain"),
                          whole = serial.records[i].assessments.front().values("gain");
    CHECK((asked.array() == whole.array() || (asked.array().isNaN() && whole.array().isNaN())).all());
  }
}

TEST_CASE("left to Ipopt: what repairs bring, with the loops in threads") {
  const Study study = parse_study(kStudy, "left-to-ipopt");
  RunOptions options = options_of({"sse"}, Parallel::threads);
  options.jobs = 2;
  const Campaign campaign = run_serially(study, options);
  const ExperimentRecord& record = campaign.records[1];
  const AssessedLoop loop =
      assessed_loop(campaign.study, campaign.basis.point,
                    recorded(campaign.study, record.draw.index, record.loop->trajectory));
  const auto found = [&](const ForEachWithSolver& for_each) {
    return RepairProspects(campaign.study, campaign.basis.point, for_each).of(loop).value();
  };
  const auto serial = found(in_turn(qp_solver_factory("auto"))), threads = found(in_threads(study, options)),
             without = found(in_turn(qp_solver_factory("active-set")));
  REQUIRE(serial.size() == threads.size());
  bool needs_ipopt = false;
  for (std::size_t i = 0; i < serial.size(); ++i) {
    CHECK(serial[i].gains == threads[i].gains);
    needs_ipopt = needs_ipopt || serial[i].gains != without[i].gains;
  }
  CHECK(needs_ipopt);
}

}  // namespace
