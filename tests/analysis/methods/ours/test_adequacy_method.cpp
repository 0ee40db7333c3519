#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

struct AdequacyCase {
  Study study = find_study("setpoint-methods");
  BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);

  Assessment assess(const std::vector<Mismatch>& mismatches) const {
    ExperimentDraw draw = basis_draw();
    draw.index = 3;
    draw.kind = kind_of(mismatches, {}, {});
    draw.mismatches = mismatches;
    Assessor assessor(assessment_method("adequacy"), context);
    return assessor.assess(
        assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory)));
  }
};

}  // namespace

TEST_CASE("adequacy: a right model is adequate") {
  const Assessment healthy = AdequacyCase{}.assess({});
  REQUIRE(healthy.status == AssessmentStatus::ok);
  CHECK_FALSE(healthy.flagged);
  CHECK(healthy.flagged_channels.empty());
}

TEST_CASE("adequacy: a channel whose repair brings much is named with its gain and probability") {
  const Channel channel{1, 2};
  const Assessment said = AdequacyCase{}.assess({{channel.cv, channel.mv, MismatchParameter::gain, 0.4}});
  REQUIRE(said.status == AssessmentStatus::ok);
  CHECK(said.flagged);
  REQUIRE(said.flagged_channels.size() == 1);
  CHECK(said.flagged_channels[0] == channel);
  CHECK(said.worst_cv() == channel.cv);
  CHECK(said.cvs[1].source == FaultSource::mpm);
  CHECK(said.number("gain", channel.cv, channel.mv) > 0.1);
  CHECK(said.number("p_worth", channel.cv, channel.mv) > 0.5);
}

}  // namespace mpm
