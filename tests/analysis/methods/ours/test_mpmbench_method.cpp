#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

struct MpmbenchCase {
  Study study = find_study("chapter6");
  BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);

  AssessedLoop loop_of(const ExperimentDraw& draw) const {
    return assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory));
  }
};

ExperimentDraw draw_with(const std::vector<Mismatch>& mismatches,
                         const std::vector<Disturbance>& disturbances) {
  ExperimentDraw draw = basis_draw();
  draw.index = 5;
  draw.kind = kind_of(mismatches, {}, disturbances);
  draw.mismatches = mismatches;
  draw.disturbances = disturbances;
  return draw;
}

}  // namespace

TEST_CASE("mpmbench: a mismatch is named by channel, parameter and size, a disturbance by its CV alone") {
  const MpmbenchCase chapter6;
  Assessor assessor(assessment_method("mpmbench"), chapter6.context);

  const Assessment mpm =
      assessor.assess(chapter6.loop_of(draw_with({{4, 0, MismatchParameter::gain, 0.5}}, {})));
  REQUIRE(mpm.status == AssessmentStatus::ok);
  CHECK(mpm.flagged);
  CHECK(mpm.worst_cv() == 4);
  CHECK(mpm.cvs[4].source == FaultSource::mpm);
  REQUIRE(mpm.named_mismatch);
  CHECK(mpm.named_mismatch->channel == Channel{4, 0});
  CHECK(mpm.named_mismatch->parameter == MismatchParameter::gain);
  CHECK(mpm.named_mismatch->size == Approx(0.5).epsilon(0.05));

  const Assessment ud = assessor.assess(chapter6.loop_of(draw_with({}, {{0, 1.2, 60.0}})));
  CHECK(ud.flagged);
  CHECK(ud.worst_cv() == 0);
  CHECK(ud.cvs[0].source == FaultSource::ud);
  CHECK_FALSE(ud.named_mismatch);
  CHECK(ud.flagged_channels.empty());
}

TEST_CASE("mpmbench: where the likelihood sees both faults, the order test says whether one is enough") {
  const MpmbenchCase chapter6;
  Assessor together(assessment_method("mpmbench"), chapter6.context);
  Assessor alone(assessment_method("likelihood"), chapter6.context);
  const Mismatch mismatch{4, 0, MismatchParameter::gain, 0.5};
  const Disturbance filtered_noise{4, 1.2, 60.0};
  Disturbance oscillation = filtered_noise;
  oscillation.signal = Sine{.amplitude = 0.4, .period = 200.0};
  ExperimentDraw later = draw_with({mismatch}, {});
  later.onset = {.sample = 200};

  const auto source = [&](Assessor& assessor, const ExperimentDraw& draw) {
    const Assessment said = assessor.assess(chapter6.loop_of(draw));
    CHECK(said.flagged);
    CHECK(said.worst_cv() == 4);
    return said.cvs[4].source;
  };
  for (const auto& [draw, truth] :
       {std::pair{draw_with({mismatch}, {filtered_noise}), FaultSource::mpm_ud},
        std::pair{draw_with({}, {oscillation}), FaultSource::ud}, std::pair{later, FaultSource::mpm}}) {
    CHECK(source(alone, draw) == FaultSource::mpm_ud);
    CHECK(source(together, draw) == truth);
  }
}

TEST_CASE("mpmbench: where errors of the model are learnt, one fault of another form is not two") {
  Study study = find_study("wood-berry");
  study.assessment.model = AssessmentModel::benchmark;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"mpmbench"});
  Disturbance oscillation{0, 1.0, 5.0};
  oscillation.signal = Sine{.amplitude = 0.5, .period = 90.0};
  for (const auto& [draw, truth] :
       {std::pair{draw_with({}, {oscillation}), ToldSource::ud},
        std::pair{draw_with({{1, 0, MismatchParameter::gain, 2.0}, {1, 1, MismatchParameter::gain, 1.5}}, {}),
                  ToldSource::mpm}}) {
    const AssessmentRecord said =
        panel
            .assess(assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)),
                    nullptr)
            .front();
    CHECK(said.flagged);
    CHECK(said.told() == truth);
  }
}

TEST_CASE(
    "mpmbench: it states probabilities of every loop, and the likeliest source is the one that it names",
    "[probabilities]") {
  const MpmbenchCase chapter6;
  Assessor together(assessment_method("mpmbench"), chapter6.context);
  Assessor alone(assessment_method("likelihood"), chapter6.context);
  const Mismatch mismatch{4, 0, MismatchParameter::gain, 0.5};
  Disturbance oscillation{4, 1.2, 60.0};
  oscillation.signal = Sine{.amplitude = 0.4, .period = 200.0};
  const auto stated = [](const Assessment& said) {
    SourceProbabilities p;
    for (std::size_t i = 0; i < p.size(); ++i)
      p[i] = said.number(source_probability_numbers()[i].name);
    return p;
  };
  for (const auto& [draw, named] : {std::pair{draw_with({}, {}), FaultSource::none},
                                    std::pair{draw_with({mismatch}, {}), FaultSource::mpm},
                                    std::pair{draw_with({}, {oscillation}), FaultSource::ud}}) {
    const AssessedLoop loop = chapter6.loop_of(draw);
    const SourceProbabilities p = stated(together.assess(loop)), of_likelihood = stated(alone.assess(loop));
    CHECK(std::accumulate(p.begin(), p.end(), 0.0) == Approx(1.0));
    CHECK(std::max_element(p.begin(), p.end()) - p.begin() == static_cast<std::ptrdiff_t>(named));
    // The same numbers as those of the likelihood, which took the oscillation for both faults.
    SourceProbabilities sorted = p, sorted_of_likelihood = of_likelihood;
    std::sort(sorted.begin(), sorted.end());
    std::sort(sorted_of_likelihood.begin(), sorted_of_likelihood.end());
    CHECK(sorted == sorted_of_likelihood);
    CHECK((p == of_likelihood) == (named != FaultSource::ud));
  }
  CHECK(states_probabilities(assessment_method("mpmbench")));
  Assessor without(shipped_methods().method("mpmbench:without-likelihood"), chapter6.context);
  CHECK(std::isnan(without.assess(chapter6.loop_of(draw_with({mismatch}, {}))).number("p_mpm")));
}

TEST_CASE("mpmbench: what costs nothing is not flagged, and no source is named") {
  const MpmbenchCase chapter6;
  Assessor assessor(assessment_method("mpmbench"), chapter6.context);
  for (const ExperimentDraw& draw :
       {draw_with({}, {}), draw_with({{1, 0, MismatchParameter::dead_time, 0.3}}, {})}) {
    const Assessment said = assessor.assess(chapter6.loop_of(draw));
    CHECK(said.status == AssessmentStatus::ok);
    CHECK_FALSE(said.flagged);
    for (const CvAssessment& cv : said.cvs)
      CHECK(cv.source == FaultSource::none);
  }
}

TEST_CASE("mpmbench: gaps of the record change neither the verdict nor what is named") {
  const MpmbenchCase chapter6;
  Assessor assessor(assessment_method("mpmbench"), chapter6.context);
  AssessedLoop loop = chapter6.loop_of(draw_with({{4, 0, MismatchParameter::gain, 0.5}}, {}));
  const Assessment whole = assessor.assess(loop);
  for (Eigen::Index k = 0; k < loop.samples(); k += 37)
    loop.y(4, k) = std::nan("");
  const Assessment with_gaps = assessor.assess(loop);
  REQUIRE(with_gaps.status == AssessmentStatus::ok);
  CHECK(with_gaps.flagged);
  CHECK(with_gaps.score == Approx(whole.score).epsilon(0.02));
  REQUIRE(with_gaps.named_mismatch);
  CHECK(with_gaps.named_mismatch->channel == Channel{4, 0});
}

}  // namespace mpm
