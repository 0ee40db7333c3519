#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/designed_output.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// The linear tank of 3.3.2 for 260 samples, in which the setpoints of h1 to h4 move.
Study short_tank() {
  Study study = find_study("chapter3-tank");
  study.simulation.samples = 260;
  std::erase_if(study.simulation.setpoint_steps, [](const auto& step) { return step.sample >= 260; });
  return study;
}

AssessedLoop loop_of(const Study& study, const BasisCase& basis, const std::string& scenario) {
  for (std::size_t i = 0; i < study.scenarios.size(); ++i)
    if (study.scenarios[i].name == scenario)
      return assessed_loop(study, basis.point,
                           simulate_experiment(study, draw_experiment(study, static_cast<std::int64_t>(i)),
                                               testing::kFactory));
  throw InputError("scenario", scenario, "one of the study");
}

Assessment assess(const AssessmentContext& context, const AssessedLoop& loop) {
  return Assessor(assessment_method("badwe2010"), context).assess(loop);
}

}  // namespace

TEST_CASE("badwe2010: a CV is judged by Ivar against its designed output, the loop by its worst CV") {
  const Study study = short_tank();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop loop = loop_of(study, basis, "MPM1");
  const Assessment assessment = assess(context, loop);
  REQUIRE(assessment.status == AssessmentStatus::ok);

  const DesignedOutput designed = designed_output(loop.y, loop.y_sim, loop.y_set);
  double worst = 0.0;
  bool any = false;
  for (Eigen::Index cv = 0; cv < 4; ++cv) {
    const Eigen::RowVectorXd error = loop.y.row(cv) - loop.y_set.row(cv);
    const Eigen::RowVectorXd designed_error = designed.y0.row(cv) - loop.y_set.row(cv);
    const double ivar = error.squaredNorm() / designed_error.squaredNorm();
    const CvAssessment& verdict = assessment.cvs[static_cast<std::size_t>(cv)];
    CHECK(assessment.number("ivar", cv) == Approx(ivar));
    CHECK(verdict.score == Approx(std::abs(ivar - 1.0)));
    CHECK(verdict.flagged == (ivar < 0.8 || ivar > 1.2));
    worst = std::max(worst, verdict.score);
    any = any || *verdict.flagged;
    double sqr = 0.0;
    for (Eigen::Index k = 0; k < loop.samples(); ++k)
      sqr += std::sqrt(std::pow(basis.trajectory.y(cv, k) - designed.y0(cv, k), 2));
    CHECK(assessment.number("sqr", cv) == Approx(sqr));
  }
  CHECK(assessment.score == worst);
  CHECK(assessment.flagged == any);
  // Only h1 has a mismatch, and nothing else makes the others differ from their models.
  CHECK(assessment.number("fit_dgk", 0) > 95.0);
  CHECK(std::isnan(assessment.number("fit_dgk", 1)));
  // The designed output is nearer to the loop without mismatch than the output is.
  CHECK(assessment.number("sqr", 0) < 0.1 * (basis.trajectory.y.row(0) - loop.y.row(0)).cwiseAbs().sum());
}

TEST_CASE("badwe2010: a CV without a setpoint gets no verdict, and a loop without any is not for it") {
  const Study study = short_tank();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  AssessedLoop loop = loop_of(study, basis, "MPM1");
  loop.y_set.row(2).setConstant(kNaN);
  const Assessment mixed = assess(context, loop);
  REQUIRE(mixed.status == AssessmentStatus::ok);
  CHECK_FALSE(mixed.cvs[2].flagged);
  CHECK(std::isnan(mixed.number("ivar", 2)));
  CHECK(mixed.cvs[3].flagged);

  loop.y_set.setConstant(kNaN);
  const Assessment ranges = assess(context, loop);
  CHECK(ranges.status == AssessmentStatus::not_applicable);
  CHECK_THAT(ranges.reason, Catch::Contains("every CV in a range"));

  loop.y_set.setZero();
  CHECK(assess(context, loop).status == AssessmentStatus::not_applicable);
}

TEST_CASE("badwe2010: the options of the study are those of the models") {
  Study study = short_tank();
  const auto set = [&study](const std::string& options) {
    const StudyChange change{"assessment.badwe2010", options};
    study.assessment = changed_study(find_study("chapter3-tank"), {change}, "the test").assessment;
  };
  set("{smallest_order = 2, largest_order = 2, max_iterations = 1, criterion = 'bic'}");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop loop = loop_of(study, basis, "MPM2");
  const Assessment assessment = assess(context, loop);
  CHECK(assessment.number("order_sd", 0) == 2.0);
  CHECK(assessment.number("order_dgk", 0) == 2.0);
  DesignedOutputOptions options;
  options.orders = {2};
  options.max_iterations = 1;
  options.criterion = DesignedOrderCriterion::bic;
  CHECK(assessment.number("fit_sd", 0) ==
        designed_output(loop.y, loop.y_sim, loop.y_set, options).sensitivity[0].fit);

  set("{largest_order = 40}");  // 4 x 81 coefficients
  const Assessment none = assess(context, loop);
  CHECK(none.status == AssessmentStatus::not_applicable);
  CHECK_THAT(none.reason, Catch::Contains("order 40 have 324 coefficients for 260 samples"));
}

}  // namespace mpm
