#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

struct ProspectsCase {
  Study study = find_study("setpoint-methods");
  BasisCase basis = run_basis_case(study, testing::kFactory);
  RepairProspects prospects{study, basis.point, in_turn(testing::kFactory)};

  AssessedLoop loop_of(const std::vector<Mismatch>& mismatches) const {
    ExperimentDraw draw = basis_draw();
    draw.index = 3;
    draw.kind = kind_of(mismatches, {}, {});
    draw.mismatches = mismatches;
    return assessed_loop(study, basis.point, simulate_experiment(study, draw, testing::kFactory));
  }
};

const Channel kWrong{1, 2};

std::vector<Mismatch> wrong_gain() {
  return {{kWrong.cv, kWrong.mv, MismatchParameter::gain, 0.4}};
}

}  // namespace

TEST_CASE("repair prospects: the wrong channel comes first, and worsens no CV") {
  const ProspectsCase setpoints;
  const std::vector<RepairProspect> found = ranked(*setpoints.prospects.of(setpoints.loop_of(wrong_gain())));
  REQUIRE_FALSE(found.empty());
  CHECK(found.front().repair.channel == kWrong);
  CHECK(found.front().gain() > 0.1);
  CHECK(found.front().probability_above(0.1) > 0.5);
  CHECK(found.front().is_proposed());
  for (std::size_t i = 1; i < found.size(); ++i)
    CHECK_FALSE(found[i].gain() > found[i - 1].gain());
}

TEST_CASE("repair prospects: a given repair is judged as it is, and one that does harm is not proposed") {
  const ProspectsCase setpoints;
  const AssessedLoop loop = setpoints.loop_of(wrong_gain());
  const TransferFunction& model = setpoints.study.plant.G(kWrong.cv, kWrong.mv);
  const auto given = [&](double factor) {
    const std::vector<RepairProspect> all =
        *setpoints.prospects.of(loop, RepairedChannel{kWrong, model.with_gain_scaled(factor)});
    CHECK(all.front().repair.model == model.with_gain_scaled(factor));
    for (std::size_t i = 1; i < all.size(); ++i)
      CHECK_FALSE(all[i].repair.channel == kWrong);  // once
    return all.front();
  };
  const RepairProspect right = given(0.4), none = given(1.0), wrong = given(3.0);
  CHECK(right.is_proposed());
  CHECK(right.gain() > 0.1);
  CHECK(none.gain() == 0.0);  // the same loop
  CHECK_FALSE(none.is_proposed());
  CHECK(none.variance_ratio.isOnes(0.0));
  CHECK(wrong.gain() < 0.0);
  CHECK_FALSE(wrong.is_proposed());
}

TEST_CASE("repair prospects: neither the order of the loops nor that some are run twice changes a bit") {
  const ProspectsCase setpoints;
  const AssessedLoop loop = setpoints.loop_of(wrong_gain());
  const auto backwards = [](std::size_t count, const auto& body) {
    for (int round = 0; round < 2; ++round)
      for (std::size_t i = count; i > 0; --i)
        body(i - 1, testing::kFactory);
  };
  const std::vector<RepairProspect> in_order = *setpoints.prospects.of(loop),
                                    reversed =
                                        *RepairProspects(setpoints.study, setpoints.basis.point, backwards)
                                             .of(loop);
  REQUIRE(in_order.size() == reversed.size());
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    CHECK(in_order[i].gains == reversed[i].gains);
    CHECK(in_order[i].variance_ratio == reversed[i].variance_ratio);
  }
}

TEST_CASE("repair prospects: gaps change little, and with hardly a sample there are none") {
  const ProspectsCase setpoints;
  AssessedLoop loop = setpoints.loop_of(wrong_gain());
  for (Eigen::Index k = 0; k < loop.samples(); k += 37)
    loop.y.col(k).setConstant(kNaN);
  const std::vector<RepairProspect> found = ranked(*setpoints.prospects.of(loop));
  REQUIRE_FALSE(found.empty());
  CHECK(found.front().repair.channel == kWrong);
  CHECK(found.front().gain() > 0.1);
  loop.y.rightCols(loop.samples() - 2).setConstant(kNaN);
  CHECK_FALSE(setpoints.prospects.of(loop));
}

TEST_CASE("repair prospects: what ran on no plant comes last and is not proposed") {
  const RepairedChannel channel{kWrong, TransferFunction::zero()};
  const RepairProspect failed{channel, {}}, harmful{channel, {-0.2, -0.1}, Eigen::VectorXd::Ones(1)},
      good{channel, {-0.1, 0.2, 0.2}, Eigen::VectorXd::Ones(1)};
  RepairProspect worsens = good;
  worsens.variance_ratio(0) = 1.06;
  const std::vector<RepairProspect> all = ranked({failed, harmful, good});
  CHECK(all[0].gain() == Approx(0.1));
  CHECK(all[0].probability_above(0.1) == Approx(2.0 / 3.0));
  CHECK(all[1].gain() == Approx(-0.15));
  CHECK(std::isnan(all[2].gain()));
  CHECK(std::isnan(all[2].probability_above(0.1)));
  CHECK(good.is_proposed());
  CHECK_FALSE(harmful.is_proposed());
  CHECK_FALSE(failed.is_proposed());
  CHECK_FALSE(worsens.is_proposed());
}

}  // namespace mpm
