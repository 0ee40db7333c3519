#include <cmath>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/basis/s0_perturbation_structure.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/s0_perturbation_curves.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/sensitivity/s0_perturbation.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace {

using namespace mpm;

/// A record that wanders, as closed-loop data do.
Eigen::RowVectorXd wandering(std::int64_t index) {
  RandomStream stream(5, static_cast<std::uint64_t>(index), StreamId::measurement_noise);
  Eigen::RowVectorXd record(400);
  double value = 0.0;
  for (Eigen::Index k = 0; k < record.size(); ++k)
    record(k) = value = 0.95 * value + stream.normal();
  return record;
}

/// A T0 with y2 as the only active CV, whose diagonal element is of second order.
NominalSensitivity second_order_sensitivity(double tau, double xi) {
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(7, 150);
  response.row(1) = second_order_response({tau, xi}, 4.0, 150);
  return {7, {{1, ConstraintKind::lower_limit}}, {response}};
}

Study study_with(const std::vector<double>& multipliers) {
  Study study = find_study("chapter6");
  study.s0_perturbation.multipliers = multipliers;
  return study;
}

TEST_CASE("S0 modified: a multiplier of 1 gives Ivar_diag of the true S0, bit for bit") {
  const Study study = study_with({0.5, 1.0, 2.0});
  const NominalSensitivity t0 =
      nominal_sensitivity(study, operating_point(study, testing::kFactory), testing::kFactory);
  const S0Perturbation perturbation(study, t0);
  for (const Eigen::Index cv : {0, 1, 6}) {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(7, 400), y_sim = y;
    y.row(cv) = wandering(2 * cv);
    y_sim.row(cv) = y.row(cv) + 0.3 * wandering(2 * cv + 1);
    const Eigen::MatrixXd y0_diag = nominal_outputs(t0, y, y_sim).y0_diag;
    const double expected = variance_index(y.row(cv).transpose(), y0_diag.row(cv).transpose());
    const PerturbedIvar found =
        perturbation.ivar_diag(cv, Eigen::RowVectorXd(y.row(cv)), Eigen::RowVectorXd(y_sim.row(cv)));
    REQUIRE(found.time_constant.size() == 3);
    CHECK(found.time_constant(1) == expected);
    CHECK(found.damping(1) == expected);
    CHECK(found.time_constant(0) != expected);
    CHECK(found.damping(2) != expected);
  }
}

TEST_CASE("S0 modified: where T0 is of second order, the modified one is that of the multiplied parameters") {
  const Study study = study_with({0.4, 1.7});
  const S0Perturbation perturbation(study, second_order_sensitivity(30.0, 0.8));
  const Eigen::RowVectorXd y = wandering(1), y_sim = y + wandering(2);
  const PerturbedIvar found = perturbation.ivar_diag(1, y, y_sim);
  const auto expected = [&](double tau, double xi) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(7, 400), all_sim = all;
    all.row(1) = y;
    all_sim.row(1) = y_sim;
    return variance_index(
        y.transpose(),
        nominal_outputs(second_order_sensitivity(tau, xi), all, all_sim).y0_diag.row(1).transpose());
  };
  // The fit finds tau and xi to 1e-6.
  CHECK(found.time_constant(0) == Approx(expected(0.4 * 30.0, 0.8)).epsilon(1e-4));
  CHECK(found.time_constant(1) == Approx(expected(1.7 * 30.0, 0.8)).epsilon(1e-4));
  CHECK(found.damping(0) == Approx(expected(30.0, 0.4 * 0.8)).epsilon(1e-4));
  CHECK(found.damping(1) == Approx(expected(30.0, 1.7 * 0.8)).epsilon(1e-4));
}

TEST_CASE("S0 modified: an S0 that never acts leaves y_sim, one that acts at once leaves y") {
  const Study study = study_with({1e-3, 1e4});
  const S0Perturbation perturbation(study, second_order_sensitivity(30.0, 0.8));
  // A slow error, so that the sample by which even the fastest loop is late does not show.
  const Eigen::RowVectorXd y = wandering(1);
  const Eigen::RowVectorXd y_sim = y + Eigen::RowVectorXd::LinSpaced(400, 0.0, 3.0);
  const PerturbedIvar found = perturbation.ivar_diag(1, y, y_sim);
  CHECK(found.time_constant(0) == Approx(1.0).epsilon(1e-2));
  CHECK(found.time_constant(1) == Approx(variance_index(y.transpose(), y_sim.transpose())).epsilon(1e-2));
}

TEST_CASE("S0 modified: nothing for other CVs, CVs that are not asked for, and without multipliers") {
  const Eigen::RowVectorXd y = wandering(1);
  const NominalSensitivity t0 = second_order_sensitivity(30.0, 0.8);
  Study study = study_with({0.5, 1.0});
  CHECK(S0Perturbation(study, t0).ivar_diag(1, y, y).damping.size() == 2);
  CHECK(S0Perturbation(study, t0).ivar_diag(0, y, y).damping.size() == 0);
  CHECK_THROWS_AS(S0Perturbation(study, t0).ivar_diag(1, y, y.head(9)), InputError);
  study.s0_perturbation.cvs = {0};
  CHECK(S0Perturbation(study, t0).ivar_diag(1, y, y).damping.size() == 0);
  CHECK(S0Perturbation(study_with({}), t0).ivar_diag(1, y, y).time_constant.size() == 0);
}

TEST_CASE("S0 modified: the runner looks at the affected CV of experiments on active CVs") {
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"botelho"}, testing::kFactory);
  int active = 0, inside = 0;
  for (std::int64_t index = 0; index < 20 && (active == 0 || inside == 0); ++index) {
    const Eigen::Index cv = draw_experiment(study, index).true_cv();
    int& seen = cv == 0 || cv == 1 || cv == 6 ? active : inside;
    if (seen > 0)
      continue;
    const ExperimentRecord record = runner.run(index, StorePolicy::none);
    if (record.status != ExperimentStatus::ok)
      continue;
    ++seen;
    const auto multipliers = static_cast<Eigen::Index>(study.s0_perturbation.multipliers.size());
    const double ivar_diag = record.by("botelho")->number("ivar_diag", cv);
    CHECK(record.perturbed.damping.size() == (&seen == &active ? multipliers : 0));
    for (Eigen::Index m = 0; m < record.perturbed.damping.size(); ++m)
      if (study.s0_perturbation.multipliers[static_cast<std::size_t>(m)] == 1.0) {
        CHECK(record.perturbed.damping(m) == ivar_diag);
        CHECK(record.perturbed.time_constant(m) == ivar_diag);
      }
  }
  CHECK(active == 1);
  CHECK(inside == 1);
}

TEST_CASE("S0 curves: quartiles of the ratios, and changes within the tolerance only") {
  const Study study = study_with({0.5, 0.8, 1.0, 1.25});  // tolerance 0.75 to 1.25, band 0.8 to 1.2
  std::vector<ExperimentRecord> records;
  for (std::int64_t i = 0; i < 5; ++i) {
    records.push_back(testing::made_up_record(i, ExperimentKind::ud, 1, 0.0));
    const double truth = records.back().chain().number("ivar_diag", 1);
    const double step = 0.1 * static_cast<double>(i);
    records.back().perturbed.time_constant = truth * Eigen::Vector4d(9.0, 1.0 - step, 1.0, 1.05);
    records.back().perturbed.damping = truth * Eigen::Vector4d(1.0, 1.0, 1.0, 1.0);
  }
  records.push_back(testing::made_up_record(5, ExperimentKind::ud, 3, 0.0));  // not looked at
  records.push_back(testing::without_verdict(records.front(), ExperimentStatus::infeasible));
  records.push_back(records.front());
  records.back().perturbed.time_constant.setConstant(mpm::kInfinity);

  const std::vector<S0Curve> curves = s0_curve_collector(study).of(records);
  REQUIRE(curves.size() == 1);
  CHECK(curves[0].cv == 1);
  CHECK(curves[0].experiments == 6);
  const RatioSpread& spread = curves[0].time_constant[1];
  CHECK(spread.least == Approx(0.6));
  CHECK(spread.lower_quartile == Approx(0.7));
  CHECK(spread.median == Approx(0.8));
  CHECK(spread.upper_quartile == Approx(0.9));
  CHECK(spread.largest == Approx(1.0));
  CHECK(curves[0].time_constant_change.largest == Approx(0.4));  // not the 8 of a multiplier of 0.5
  CHECK(curves[0].time_constant_change.within_band.total == 5);
  CHECK(curves[0].damping_change.largest == Approx(0.0).margin(1e-15));
  CHECK(curves[0].damping_change.within_band.hits == 6);
  CHECK(s0_change_collector(study).of(records).time_constant.largest ==
        curves[0].time_constant_change.largest);
  CHECK(s0_curve_collector(study_with({})).of(records).empty());
  for (ExperimentRecord& record : records)
    record.assessments.clear();
  CHECK(s0_curve_collector(study).of(records).empty());  // Ivar_diag is a number of the chain
  CHECK(std::isnan(s0_change_collector(study).of({}).damping.largest));
}

TEST_CASE("fixed MVs: the static gain of T0 is that of the nominal model with the other MVs alone") {
  const Study study = find_study("chapter6");
  REQUIRE(study.s0_perturbation.fixed_mvs == std::vector<Eigen::Index>{0});
  const OperatingPoint point = with_fixed_mvs(study, operating_point(study, testing::kFactory));
  CHECK(point.fixed_mvs == std::vector<Eigen::Index>{0});
  const NominalSensitivity t0 = nominal_sensitivity(study, point, testing::kFactory);
  const Eigen::MatrixXd K = study.plant.G.static_gain().middleCols(1, 2);
  const Eigen::MatrixXd expected = K * K.topRows(2).inverse();
  const Eigen::MatrixXd gain = t0.static_gain();
  // The limits act through a finite soft weight, and the responses have settled to about 1e-2.
  CHECK((gain.leftCols(2) - expected).cwiseAbs().maxCoeff() < 2e-2);
  CHECK(gain.col(6).isZero(0.0));  // y7 is inside its range now
}

TEST_CASE("fixed MVs: multipliers of tau and xi between the two structures, 1 when nothing differs") {
  Study study = find_study("chapter6");
  BasisCase basis;
  basis.point = operating_point(study, testing::kFactory);
  basis.sensitivity = nominal_sensitivity(study, basis.point, testing::kFactory);
  CHECK(structure_fits(study, basis).empty());
  basis.sensitivity_fixed = basis.sensitivity;
  for (const StructureFit& fit : structure_fits(study, basis)) {
    CHECK(fit.time_constant_multiplier == 1.0);
    CHECK(fit.damping_multiplier == 1.0);
  }
  basis.sensitivity_fixed = nominal_sensitivity(study, with_fixed_mvs(study, basis.point), testing::kFactory);
  const std::vector<StructureFit> fits = structure_fits(study, basis);
  REQUIRE(fits.size() == 2);
  CHECK(fits[0].cv == 0);
  CHECK(fits[1].cv == 1);
  for (const StructureFit& fit : fits) {
    CHECK(fit.fixed.status == FitStatus::ok);
    CHECK(fit.time_constant_multiplier == fit.fixed.model.time_constant / fit.available.model.time_constant);
  }
}

TEST_CASE("a CV that is at no limit cannot be the one whose S0 is modified") {
  Study study = find_study("chapter6");
  study.s0_perturbation.cvs = {2};
  CHECK_THROWS_WITH(run_basis_case(study, testing::kFactory),
                    "s0_perturbation.cvs: found 'y3', which is at no setpoint and no soft limit; allowed: "
                    "CVs at a setpoint or an active "
                    "soft limit");
}

}  // namespace
