#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/repair.hpp"
#include "analysis/findings/repair_findings.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

struct RepairCase {
  Study study = find_study("chapter6");
  BasisCase basis = run_basis_case(study, testing::kFactory);

  RepairedLoop repaired(const ExperimentDraw& draw, const Channel& channel) const {
    const Trajectory loop = simulate_experiment(study, draw, testing::kFactory);
    REQUIRE(loop.status == ControlStatus::ok);
    const AssessedLoop assessed = assessed_loop(study, basis.point, recorded(study, draw.index, loop));
    return repaired_loop(study, basis.point, draw, assessed,
                         identified_channel(study, basis.point, assessed, channel), testing::kFactory);
  }
};

ExperimentDraw mismatch_of(double gain) {
  ExperimentDraw draw = basis_draw();
  draw.index = 3;
  draw.kind = ExperimentKind::mpm;
  draw.mismatches = {{4, 0, MismatchParameter::gain, gain}};
  return draw;
}

}  // namespace

TEST_CASE("repair: the right channel gives the variances of the controller that knows the plant") {
  const RepairCase chapter6;
  const RepairedLoop loop = chapter6.repaired(mismatch_of(0.5), {4, 0});
  REQUIRE(loop.compares());
  CHECK(loop.repair.gain_factor.value == Approx(0.5).epsilon(0.02));
  CHECK(loop.loss_now() > 1.1);
  CHECK(loop.loss_repaired() == Approx(1.0).epsilon(0.01));
  // The record alone promises what comes.
  REQUIRE(loop.predicted.size() == loop.repaired.size());
  CHECK((loop.predicted.array() / loop.repaired.array() - 1.0).abs().maxCoeff() < 0.05);
}

TEST_CASE(
    "repair: of a plant that is its model now and perfect are the same loop, and the fit keeps the model") {
  const RepairCase chapter6;
  ExperimentDraw healthy = basis_draw();
  healthy.index = 3;
  const RepairedLoop loop = chapter6.repaired(healthy, {4, 0});
  CHECK(loop.now == loop.perfect);
  CHECK(loop.repair.gain_factor.lower < 1.0);
  CHECK(loop.repair.gain_factor.upper > 1.0);
}

TEST_CASE("repair: the size that a method names goes into the model, and what has none is identified again") {
  const RepairCase chapter6;
  MethodDescription method;
  method.name = "namer";
  method.names_channels = method.names_mismatches = true;
  const auto form = std::make_shared<const AssessmentForm>(method, chapter6.study);
  const Trajectory loop = simulate_experiment(chapter6.study, mismatch_of(0.5), testing::kFactory);
  const AssessedLoop assessed =
      assessed_loop(chapter6.study, chapter6.basis.point, recorded(chapter6.study, 3, loop));
  const TransferFunction& model = chapter6.study.plant.G(4, 0);
  const auto repair_by = [&](const NamedMismatch& named) {
    Assessment said;
    said.flagged = true;
    said.flagged_channels = {named.channel};
    said.named_mismatch = named;
    return *channel_repair(chapter6.study, chapter6.basis.point, assessed, kept(form, said));
  };
  const ChannelRepair gain =
      repair_by({{4, 0}, MismatchParameter::gain, 0.7, 0.6, 0.8});  // not what a fit finds
  CHECK(gain.model == model.with_gain_scaled(0.7));
  CHECK((gain.gain_factor.value == 0.7 && gain.gain_factor.lower == 0.6 && gain.gain_factor.upper == 0.8));
  CHECK(
      (gain.time_factor.lower == 1.0 && gain.time_factor.upper == 1.0 && gain.dead_time_shift.value == 0.0));
  CHECK(repair_by({{4, 0}, MismatchParameter::time_constant, 1.5, 1.2, 1.7}).model ==
        model.with_time_scaled(1.5));
  // A size that is rounded to a dead time below 0 takes away all of it.
  CHECK(repair_by({{4, 0}, MismatchParameter::dead_time, -1.001 * model.dead_time(), -1.0, 0.0})
            .model.dead_time() == 0.0);
  CHECK(repair_by({{4, 0}, MismatchParameter::second_order, 3.0, 2.0, 4.0}).model.order() ==
        model.order() + 1);

  const ChannelRepair fitted = repair_by({{4, 0}, MismatchParameter::gain});
  CHECK_FALSE(fitted.named);
  CHECK(fitted.gain_factor.value == Approx(0.5).epsilon(0.02));
  CHECK((fitted.parameter == MismatchParameter::gain && fitted.time_factor.value == 1.0));
}

TEST_CASE("repair findings: by what was repaired, with what changes noticeably") {
  const auto target = [](const ExperimentDraw& draw, const Channel& channel) {
    return target_of(draw, channel);
  };
  CHECK(target(mismatch_of(0.5), {4, 0}) == RepairTarget::mismatched);
  CHECK(target(mismatch_of(0.5), {4, 1}) == RepairTarget::another);
  CHECK(target(basis_draw(), {4, 0}) == RepairTarget::no_mismatch);
  const std::vector<RepairOutcome> outcomes{{0, RepairTarget::mismatched, 2.0, 1.0},
                                            {1, RepairTarget::mismatched, 1.0, 1.04},
                                            {2, RepairTarget::mismatched, 1.0, 1.1},
                                            {3, RepairTarget::no_mismatch, 1.0, 1.0}};
  const std::vector<RepairFindings> findings = repair_findings(outcomes, 0.95);
  REQUIRE(findings.size() == 3);
  CHECK((findings[0].better.hits == 1 && findings[0].worse.hits == 1 && findings[0].better.total == 3));
  CHECK(findings[0].loss_now.value == 1.0);
  CHECK(findings[0].loss_repaired.value == 1.04);
  CHECK(findings[1].better.total == 0);
  CHECK(findings[2].loss_now.count == 1);
}

TEST_CASE("repair: the channel is that of the mismatch a method names, or the first that it flags") {
  MethodDescription method;
  method.name = "namer";
  method.names_channels = method.names_mismatches = true;
  const auto form = std::make_shared<const AssessmentForm>(method, find_study("chapter6"));
  Assessment said;
  said.flagged_channels = {{2, 1}, {3, 0}};
  CHECK_FALSE(channel_to_repair(kept(form, said)));  // it is not flagged
  said.flagged = true;
  CHECK(*channel_to_repair(kept(form, said)) == Channel{2, 1});
  said.named_mismatch = {{3, 0}, MismatchParameter::gain, 0.5, 0.4, 0.6};
  CHECK(*channel_to_repair(kept(form, said)) == Channel{3, 0});
}

}  // namespace mpm
