#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/noise_model.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {

TEST_CASE("innovation variance: that of the innovations of an autoregression, whatever its mean") {
  const Eigen::VectorXd v = 3.0 * testing::settled_autoregression(4000, 0.8, 3).array() + 50.0;
  // 9, give or take three deviations of 9 sqrt(2/4000).
  CHECK(innovation_variance(v, 12) == Approx(9.0).margin(0.6));
  CHECK(innovation_variance(Eigen::VectorXd::Constant(100, 2.0), 3) == 0.0);
}

TEST_CASE("mqi-channels: a submodel that is worse than none is named, one that is merely wrong is not") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  Assessor method(assessment_method("mqi-channels"), context);
  CHECK_FALSE(method.assess(*context.benchmark).flagged);
  const Study lenient = changed_study(study, {{"assessment.mqi-channels.tolerance", "0.01"}}, "the test");
  const AssessmentContext of_lenient = assessment_context(lenient, basis, testing::kFactory);
  const TransferFunction& model = study.plant.G(4, 2);
  for (const double gain : {-1.0, 0.2, 0.8}) {
    AssessedLoop loop = *context.benchmark;
    const Eigen::VectorXd input = loop.u.row(2).transpose();
    loop.y.row(4) += (gain - 1.0) * channel_response(model, 4.0, input).transpose();
    const Assessment found = method.assess(loop);
    INFO("gain " << gain << ", score " << found.score);
    // With the gain g the error is (g - 1) G0 u with the submodel and g G0 u without it.
    CHECK(found.flagged == (gain < 0.5));
    if (found.flagged)
      CHECK(found.flagged_channels == std::vector<Channel>{{4, 2}});
    CHECK_FALSE(Assessor(assessment_method("mqi-channels"), of_lenient).assess(loop).flagged);
  }
}

}  // namespace mpm
