#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// The basis case of a study, with `amplitude` times the response of a changed channel in place of its own.
struct ChangedChannel {
  Study study = find_study("chapter6");
  BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);

  AssessedLoop with(Eigen::Index cv, Eigen::Index mv, const TransferFunction& plant) const {
    AssessedLoop loop = *context.benchmark;
    const Eigen::VectorXd input = loop.u.row(mv).transpose();
    loop.y.row(cv) +=
        (channel_response(plant, 4.0, input) - channel_response(study.plant.G(cv, mv), 4.0, input))
            .transpose();
    return loop;
  }
};

}  // namespace

TEST_CASE("lasso: the basis case is not flagged; a gain, with and without a slow disturbance, is named") {
  const ChangedChannel changed;
  Assessor lasso(assessment_method("lasso"), changed.context);
  const Assessment healthy = lasso.assess(*changed.context.benchmark);
  CHECK_FALSE(healthy.flagged);
  CHECK(healthy.score <= 1.0);
  CHECK_FALSE(healthy.named_mismatch);

  AssessedLoop loop = changed.with(3, 2, changed.study.plant.G(3, 2).with_gain_scaled(0.7));
  for (const double disturbance : {0.0, 0.01}) {
    loop.y.row(3) += disturbance * testing::settled_autoregression(400, 0.97, 5).transpose();
    const Assessment found = lasso.assess(loop);
    CHECK(found.flagged);
    CHECK(found.worst_cv() == Eigen::Index{3});
    CHECK(found.cvs[3].source == FaultSource::mpm);
    CHECK(found.flagged_channels == std::vector<Channel>{{3, 2}});
    REQUIRE(found.named_mismatch);
    CHECK(found.named_mismatch->channel == Channel{3, 2});
    CHECK(found.named_mismatch->parameter == MismatchParameter::gain);
    CHECK(found.named_mismatch->lower < 0.7);
    CHECK(found.named_mismatch->upper > 0.7);
    // A disturbance that wanders hides the static gain of the filters, not that of the response.
    CHECK(found.number("gain_factor", 3, 2) == Approx(0.7).margin(disturbance > 0.0 ? 0.3 : 0.03));
  }
  AssessedLoop disturbed = *changed.context.benchmark;
  disturbed.y.row(1) += 0.1 * testing::settled_autoregression(400, 0.97, 6).transpose();
  CHECK_FALSE(lasso.assess(disturbed).flagged);
}

TEST_CASE("lasso: with the penalty of the paper more channels are named, the wrong one among them") {
  ChangedChannel changed;
  changed.study =
      changed_study(changed.study, {{"assessment.lasso.penalty", "\"cross-validation\""}}, "paper");
  Assessor lasso(assessment_method("lasso"), changed.context);
  const AssessedLoop loop = changed.with(3, 2, changed.study.plant.G(3, 2).with_gain_scaled(0.7));
  const Assessment found = lasso.assess(loop);
  CHECK(found.flagged);
  CHECK(found.worst_cv() == Eigen::Index{3});
  const std::vector<Channel>& named = found.flagged_channels;
  CHECK(std::find(named.begin(), named.end(), Channel{3, 2}) != named.end());
  REQUIRE(found.named_mismatch);
  CHECK(found.named_mismatch->channel == Channel{3, 2});
}

TEST_CASE("lasso: it needs MVs that move and a record of some length") {
  const ChangedChannel changed;
  Assessor lasso(assessment_method("lasso"), changed.context);
  AssessedLoop loop = *changed.context.benchmark;
  loop.u.setZero();
  CHECK(lasso.assess(loop).status == AssessmentStatus::not_applicable);
  loop = *changed.context.benchmark;
  for (Eigen::MatrixXd* signal : {&loop.y, &loop.u, &loop.d, &loop.y_sim})
    *signal = Eigen::MatrixXd(signal->leftCols(59));
  CHECK_THAT(lasso.assess(loop).reason, Catch::Contains("60 samples or more"));  // 2 12 + 1 + 15 + 20
}

}  // namespace mpm
