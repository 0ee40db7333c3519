#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/audit.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

std::vector<AuditSample> samples_of(const Study& study, std::int64_t experiment, double share) {
  AuditSampler sampler(study.seed, experiment, share);
  simulate_experiment(study, draw_experiment(study, experiment), qp_solver_factory("active-set"),
                      [&](const Controller& controller) { sampler.observe(controller); });
  return sampler.take();
}

}  // namespace

TEST_CASE("the audit picks its share of the steps, the same ones every time", "[audit]") {
  const Study study = find_study("wood-berry");
  const std::vector<AuditSample> all = samples_of(study, 0, 1.0);
  REQUIRE(all.size() == static_cast<std::size_t>(study.simulation.samples));
  CHECK(samples_of(study, 0, 0.0).empty());
  const std::vector<AuditSample> some = samples_of(study, 0, 0.2);
  const std::vector<AuditSample> again = samples_of(study, 0, 0.2);
  REQUIRE(some.size() == again.size());
  // Five standard deviations of a binomial count.
  const double expected = 0.2 * static_cast<double>(all.size());
  CHECK(std::abs(static_cast<double>(some.size()) - expected) < 5 * std::sqrt(0.8 * expected));
  for (std::size_t i = 0; i < some.size(); ++i) {
    CHECK(some[i].step == again[i].step);
    CHECK(some[i].moves.x == all[static_cast<std::size_t>(some[i].step)].moves.x);
    CHECK(some[i].targets.objective == all[static_cast<std::size_t>(some[i].step)].targets.objective);
  }
}

TEST_CASE("the audit sees a wrong answer, by its size, and a wrong verdict", "[audit]") {
  const Study study = find_study("wood-berry");
  AuditSample sample = samples_of(study, 1, 0.1).front();
  Auditor auditor(study, qp_solver_factory("ipopt"));
  const AuditedStep right = auditor.check(sample);
  CHECK(right.targets.same_status);
  CHECK(right.moves.same_status);
  CHECK(right.moves.x < 1e-4);  // an interior point is off by 1e-5 at a limit that touches
  CHECK(right.moves.objective < 1e-7);
  CHECK(right.ipopt_kkt_residual < 1e-7);

  AuditSample off = sample;
  off.moves.x(0) += 0.01;
  off.targets.objective += 0.5;
  const AuditedStep wrong = auditor.check(off);
  CHECK(wrong.moves.x == Approx(0.01).margin(1e-4));
  CHECK(wrong.targets.objective > 1e-3);

  off = sample;
  off.moves.status = QpStatus::infeasible;
  const AuditedStep verdict = auditor.check(off);
  CHECK_FALSE(verdict.moves.same_status);
  CHECK(std::isnan(verdict.moves.x));
  const AuditSummary summary = summarise(std::vector<AuditedStep>{right, wrong, verdict});
  CHECK(summary.steps == 3);
  CHECK(summary.disagreements == 1);
  CHECK(summary.largest_move == wrong.moves.x);
  CHECK(summary.largest_objective == wrong.targets.objective);
}

}  // namespace mpm
