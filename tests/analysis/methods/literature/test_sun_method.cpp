#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/literature/model_quality.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// The Shell fractionator with setpoints, and more options.
Study shell(const std::string& options = "") {
  return parse_study(find_study("chapter4-shell").source + "\n" + options, "test");
}

AssessedLoop loop_of(const Study& study, const BasisCase& basis, int scenario) {
  return assessed_loop(study, basis.point,
                       simulate_experiment(study, draw_experiment(study, scenario), testing::kFactory));
}

Assessment assess(const AssessmentContext& context, const AssessedLoop& loop) {
  return Assessor(assessment_method("sun"), context).assess(loop);
}

Assessment assess(const Study& study, const BasisCase& basis, const AssessedLoop& loop) {
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  return assess(context, loop);
}

constexpr int kScen1 = 1;  // time constant of y1-u1

}  // namespace

TEST_CASE("Sun: a mismatch in y1 flags the loop and y1 alone, the nominal loop is not flagged") {
  const Study study = shell();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const Assessment nominal = assess(study, basis, loop_of(study, basis, 0));
  CHECK_FALSE(nominal.flagged);
  const AssessedLoop loop = loop_of(study, basis, kScen1);
  const Assessment found = assess(study, basis, loop);
  CHECK(found.flagged);
  CHECK(found.score > nominal.score);
  CHECK(found.worst_cv() == 0);
  for (Eigen::Index cv = 0; cv < 3; ++cv) {
    const CvAssessment& said = found.cvs[static_cast<std::size_t>(cv)];
    CHECK(said.flagged == (cv == 0));
    CHECK(said.score == Approx(1.0 - found.number("imqi", cv)));
    CHECK(found.number("mqi_cv", cv) == Approx(std::pow(found.number("imqi", cv), 2)));
    CHECK(found.number("order", cv) == 20);
  }

  // The same by the pure function.
  const std::vector<NoiseModel> G_d0(3, integrated_noise(0.7));
  const ModelQuality quality = model_quality(loop.y, loop.y_set, loop.y_sim, Eigen::Vector3d(1, 6, 2), G_d0);
  CHECK(found.number("mqi") == quality.mqi);
  CHECK(found.number("imqi", 1) == quality.imqi(1));
}

TEST_CASE("Sun: the options of the study file reach the method") {
  const Study study = shell(
      "[assessment.sun]\ntolerance = 0.05\nindex = \"mqi\"\norders = [5, 12]\nsetpoint_order = 8\n"
      "criterion = \"bic\"\nown_outputs = true\ncorrect_for_parameters = true\nnoise = \"white\"\n");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessedLoop loop = loop_of(study, basis, kScen1);
  const Assessment found = assess(study, basis, loop);
  ModelQualityOptions options;
  options.arx.orders = {5, 12};
  options.arx.input_order = 8;
  options.arx.criterion = OrderCriterion::bic;
  options.arx.outputs = ArxOutputs::own;
  options.correct_for_parameters = true;
  const ModelQuality quality = model_quality(loop.y, loop.y_set, loop.y_sim, Eigen::Vector3d(1, 6, 2),
                                             std::vector<NoiseModel>(3), options);
  CHECK(found.number("mqi") == quality.mqi);
  CHECK(found.flagged == (quality.mqi < 0.05));
  CHECK(found.cvs[0].score == Approx(1.0 - std::pow(quality.imqi(0), 2)));

  CHECK_THROWS_WITH(shell("[assessment.sun]\norders = [2.5]\n"), Catch::Contains("found 2.5"));
  CHECK_THROWS_WITH(shell("[assessment.sun]\norders = [0]\n"), Catch::Contains("orders"));
  CHECK_THROWS_WITH(shell("[assessment.sun]\nnoise_filter = 1.0\n"), Catch::Contains("noise_filter"));
  CHECK_THROWS_WITH(shell("[assessment.sun]\nnoise = \"brown\"\n"), Catch::Contains("benchmark"));
}

TEST_CASE("Sun: a benchmark model needs a benchmark, and measured disturbances widen the regression") {
  const Study study = shell("[assessment.sun]\nnoise = \"benchmark\"\nmeasured_disturbances = true\n");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessedLoop loop = loop_of(study, basis, kScen1);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const Assessment found = assess(context, loop);
  CHECK(found.status == AssessmentStatus::ok);
  // The output errors of the basis case are its measurement noise, which is white.
  const ModelQuality quality =
      model_quality(loop.y, loop.y_set, loop.y_sim, Eigen::Vector3d(1, 6, 2), std::vector<NoiseModel>(3));
  CHECK(found.number("mqi") == Approx(quality.mqi).epsilon(0.2));  // up to an order that BIC takes by chance
  context.benchmark->y = Eigen::MatrixXd(context.benchmark->y.leftCols(29));
  const Assessment refused = assess(context, loop);
  CHECK(refused.status == AssessmentStatus::not_applicable);
  CHECK_THAT(refused.reason, Catch::Contains("assessment.sun.noise_order") && Catch::Contains("at most 9"));
  context.benchmark.reset();
  const Assessment unknown = assess(context, loop);
  CHECK(unknown.status == AssessmentStatus::not_applicable);
  CHECK(unknown.reason.find("benchmark") != std::string::npos);
}

TEST_CASE("Sun: nothing is said of a CV without a setpoint, and nothing at all without any") {
  const Study study = shell();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessedLoop loop = loop_of(study, basis, kScen1);
  loop.y_set.row(0).setConstant(std::nan(""));
  const Assessment found = assess(study, basis, loop);
  CHECK_FALSE(found.cvs[0].flagged.has_value());
  CHECK(std::isnan(found.cvs[0].score));
  CHECK(found.cvs[1].flagged.has_value());
  loop.y_set.setConstant(std::nan(""));
  CHECK(assess(study, basis, loop).status == AssessmentStatus::not_applicable);
}

TEST_CASE("Sun: a record too short for the orders is not assessed, and it says how long it must be") {
  const Study study = shell("[assessment.sun]\norders = [100]\n");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessedLoop loop = loop_of(study, basis, kScen1);
  CHECK(assess(study, basis, loop).status == AssessmentStatus::ok);
  const auto shortened = [](Eigen::MatrixXd& signal) { signal = Eigen::MatrixXd(signal.leftCols(600)); };
  shortened(loop.y);
  shortened(loop.y_sim);
  shortened(loop.y_set);
  const Assessment found = assess(study, basis, loop);
  CHECK(found.status == AssessmentStatus::not_applicable);
  CHECK(found.reason.find("702 samples or more") != std::string::npos);  // 100 + 1 + 6 * 100 + 1
}

}  // namespace mpm
