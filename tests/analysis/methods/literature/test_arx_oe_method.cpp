#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

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

TEST_CASE("arx-oe: a changed plant is a mismatch, changed noise a disturbance, and both are both") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  Assessor method(assessment_method("arx-oe"), context);
  CHECK_FALSE(method.assess(*context.benchmark).flagged);
  for (const bool mismatch : {false, true})
    for (const bool disturbance : {false, true}) {
      AssessedLoop loop = *context.benchmark;
      const Eigen::VectorXd input = loop.u.row(0).transpose();
      if (mismatch)
        loop.y.row(2) -= 0.5 * channel_response(study.plant.G(2, 0), 4.0, input).transpose();
      if (disturbance)
        loop.y.row(2) += 0.02 * testing::settled_autoregression(400, 0.9, 9).transpose();
      const Assessment found = method.assess(loop);
      INFO("mismatch " << mismatch << ", disturbance " << disturbance);
      CHECK(found.flagged == (mismatch || disturbance));
      CHECK(found.cvs[2].source == (mismatch      ? disturbance ? FaultSource::mpm_ud : FaultSource::mpm
                                    : disturbance ? FaultSource::ud
                                                  : FaultSource::none));
    }

  AssessedLoop brief = *context.benchmark;
  for (Eigen::MatrixXd* signal : {&brief.y, &brief.u, &brief.d, &brief.y_sim})
    *signal = Eigen::MatrixXd(signal->leftCols(119));
  CHECK_THAT(method.assess(brief).reason, Catch::Contains("120 samples or more"));  // 2 (2 12 + 1 + 15 + 20)
  context.benchmark.reset();
  CHECK(Assessor(assessment_method("arx-oe"), context).assess(brief).status ==
        AssessmentStatus::not_applicable);
}

TEST_CASE("arx-oe: windows where the study asks for them, or record and benchmark are four windows long") {
  const std::vector<std::vector<std::string>> forms{{},
                                                    {"form=\"windows\"", "window=130"},
                                                    {"form=\"automatic\"", "window=100"},
                                                    {"form=\"covariances\"", "window=100"},
                                                    {"form=\"windows\"", "window=201"}};
  std::vector<Assessment> found;
  for (std::vector<std::string> form : forms) {
    for (std::string& change : form)
      change.insert(0, "assessment.arx-oe.");
    const Study study = changed_study(find_study("chapter6"), parse_study_changes(form), "chapter6");
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
    AssessedLoop loop = *context.benchmark;
    const Eigen::VectorXd input = loop.u.row(0).transpose();
    loop.y.row(2) -= 0.5 * channel_response(study.plant.G(2, 0), 4.0, input).transpose();
    Assessor method(assessment_method("arx-oe"), context);
    CHECK_FALSE(method.assess(*context.benchmark).flagged);
    found.push_back(method.assess(loop));
  }
  for (std::size_t form = 0; form < 4; ++form) {
    CHECK(found[form].worst_cv() == 2);
    CHECK(found[form].cvs[2].source == FaultSource::mpm);
    // The variance has a test of its own among covariances alone.
    CHECK(std::isnan(found[form].number("noise_variance", 2)) == (form == 1 || form == 2));
  }
  CHECK(found[0].score == found[3].score);
  CHECK_THAT(found[4].reason, Catch::Contains("402 samples or more"));
}

}  // namespace mpm
