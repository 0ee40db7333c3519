#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {

TEST_CASE(
    "channel gradients: the directions in which a response changes, by differences of one sided steps") {
  const TransferFunction channel = TransferFunction::first_order(2.0, 30.0, 10.0);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(200);
  input.tail(180).setConstant(0.5);
  const Eigen::MatrixXd gradients = channel_gradients(channel, 4.0, input);
  const auto changed = [&](const TransferFunction& plant, double step) -> Eigen::VectorXd {
    return (channel_response(plant, 4.0, input) - channel_response(channel, 4.0, input)) / step;
  };
  CHECK(gradients.col(0).isApprox(changed(channel.with_gain_scaled(1.2), 0.2), 1e-12));
  // Differences over 5 % and half a sample against much smaller ones: within the second order of the step.
  CHECK(gradients.col(1).isApprox(changed(channel.with_time_scaled(1.0001), 1e-4), 0.01));
  CHECK(gradients.col(2).isApprox(changed(channel.with_dead_time_shifted(1e-3), 1e-3), 0.3));
  CHECK(channel_gradients(TransferFunction::zero(), 4.0, input).cols() == 0);
  const TransferFunction integrator(Eigen::VectorXd::Ones(1), Eigen::Vector2d(1.0, 0.0));
  CHECK(channel_gradients(integrator, 4.0, input).col(1).isZero(0.0));
}

TEST_CASE("local approach: a small mismatch of each parameter is named, with its size") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  Assessor local(assessment_method("local"), context);
  CHECK_FALSE(local.assess(*context.benchmark).flagged);

  const TransferFunction& model = study.plant.G(1, 0);
  const std::vector<std::pair<Mismatch, TransferFunction>> cases{
      {{1, 0, MismatchParameter::gain, 0.95}, model.with_gain_scaled(0.95)},
      {{1, 0, MismatchParameter::time_constant, 1.1}, model.with_time_scaled(1.1)},
      {{1, 0, MismatchParameter::dead_time, 2.0}, model.with_dead_time_shifted(2.0)}};
  for (const auto& [mismatch, plant] : cases) {
    AssessedLoop loop = *context.benchmark;
    const Eigen::VectorXd input = loop.u.row(0).transpose();
    loop.y.row(1) += (channel_response(plant, 4.0, input) - channel_response(model, 4.0, input)).transpose();
    const Assessment found = local.assess(loop);
    INFO(to_string(mismatch.parameter) << ", score " << found.score);
    CHECK(found.flagged);
    CHECK(found.worst_cv() == Eigen::Index{1});
    REQUIRE(found.named_mismatch);
    CHECK(found.named_mismatch->channel == Channel{1, 0});
    CHECK(found.named_mismatch->parameter == mismatch.parameter);
    const double tolerance = 2.0 * (found.named_mismatch->upper - found.named_mismatch->lower);
    CHECK(std::abs(found.named_mismatch->size - mismatch.value) < tolerance);
  }
}

}  // namespace mpm
