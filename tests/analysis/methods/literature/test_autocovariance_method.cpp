#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/loop_autocovariance.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kImpulse = 120;

Eigen::MatrixXd unit_impulse(double size) {
  Eigen::MatrixXd impulse = Eigen::MatrixXd::Zero(1, kImpulse);
  impulse(0, 0) = size;
  return impulse;
}

/// u = u_0 - kappa e, y = y_0 + e, e = beta q^-1 u + v: e(k) = rho e(k-1) + beta u_0(k-1) + v(k) with
/// rho = -beta kappa, v white.
struct FirstOrderLoop {
  double kappa = 0.8, beta = -0.7, sigma = 0.5;
  LinearLoop loop{1.0,
                  {unit_impulse(-kappa)},
                  {unit_impulse(1.0)},
                  {unit_impulse(-kappa * sigma)},
                  {unit_impulse(sigma)}};
  ChannelDifference changed{0, 0, delayed_beta()};

  double rho() const { return -beta * kappa; }
  Eigen::VectorXd delayed_beta() const {
    Eigen::VectorXd D = Eigen::VectorXd::Zero(kImpulse);
    D(1) = beta;
    return D;
  }
};

/// The study without limits of the MVs, which its setpoint steps reach.
Study unlimited_setpoint_study() {
  std::string text = find_study("setpoint-methods").source;
  const std::string limits = "hard = [-3, 3]";
  for (std::size_t at = text.find(limits); at != std::string::npos; at = text.find(limits))
    text.replace(at, limits.size(), "hard = [-inf, inf]");
  return parse_study(text, "unlimited.toml");
}

/// A loop of setpoint-methods with this plant, and noise of its own where `number` is above 0.
struct SetpointLoops {
  Study study = unlimited_setpoint_study();
  BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);

  AssessedLoop with(const TransferMatrix& plant, int number, const Eigen::MatrixXd& y_d = {},
                    double a = 0.0) const {
    const Eigen::Index N = study.simulation.samples;
    LoopSignals signals{.d = measured_disturbances(study),
                        .noise = Eigen::MatrixXd::Zero(3, N),
                        .y_d = y_d.size() > 0 ? y_d : Eigen::MatrixXd::Zero(3, N),
                        .y_set = setpoints(study)};
    for (Eigen::Index cv = 0; cv < 3; ++cv)
      signals.noise.row(cv) =
          0.02 *
          testing::settled_autoregression(N, a, static_cast<std::uint64_t>(100 * number + cv)).transpose();
    return assessed_loop(study, basis.point, run_closed_loop(study, plant, signals, testing::kFactory));
  }
};

/// Of `loops` healthy loops with autoregressions of their own as noise, each against a benchmark of its own,
/// how many are flagged.
int flagged_by_chance(SetpointLoops& made, double a, int loops) {
  int flagged = 0;
  for (int i = 0; i < loops; ++i) {
    made.context.benchmark = made.with(made.study.plant.G, 20 + 2 * i, {}, a);
    Assessor method(assessment_method("autocovariance"), made.context);
    flagged += method.assess(made.with(made.study.plant.G, 21 + 2 * i, {}, a)).flagged ? 1 : 0;
  }
  return flagged;
}

}  // namespace

TEST_CASE("autocovariance: a loop of first order has those of a first-order autoregression") {
  const FirstOrderLoop first;
  const Eigen::Index N = 500;
  const OutsideMoves still{Eigen::MatrixXd::Zero(1, N), Eigen::MatrixXd::Zero(1, N), 0, N};
  const std::vector<Eigen::Index> lags{0, 1, 2, 5};
  const Eigen::VectorXd c = theoretical_autocovariance(first.loop, still, lags, &first.changed);
  const Eigen::VectorXd healthy = theoretical_autocovariance(first.loop, still, lags, nullptr);
  const double variance = first.sigma * first.sigma / (1.0 - first.rho() * first.rho());
  for (std::size_t a = 0; a < lags.size(); ++a) {
    const auto tau = static_cast<double>(lags[a]);
    const double share = (static_cast<double>(N) - tau) / static_cast<double>(N);
    CHECK(c(static_cast<Eigen::Index>(a)) == Approx(share * variance * std::pow(first.rho(), tau)));
    CHECK(healthy(static_cast<Eigen::Index>(a)) == Approx(a == 0 ? 0.25 : 0.0).margin(1e-15));
  }
  // White noise: 2 sigma^4 / N at lag 0, sigma^4 / N beyond, independent of each other.
  const Eigen::MatrixXd covariance = autocovariance_covariance(first.loop, still, lags, nullptr, 1.0);
  const Eigen::Vector4d expected(2.0, 1.0, 1.0, 1.0);
  CHECK(
      covariance.isApprox(Eigen::MatrixXd(expected.asDiagonal()) * (0.0625 / static_cast<double>(N)), 1e-12));
}

TEST_CASE("autocovariance: mean and covariance are those of many simulated records") {
  const FirstOrderLoop first;
  const Eigen::Index N = 400;
  OutsideMoves moves{Eigen::MatrixXd::Zero(1, N), Eigen::MatrixXd::Zero(1, N), 0, N};
  for (Eigen::Index k = 0; k < N; ++k)
    moves.u0(0, k) = (k / 50) % 2 == 0 ? 0.6 : -0.4;
  const std::vector<Eigen::Index> lags{0, 1, 4};
  const int records = 3000;
  Eigen::MatrixXd c(3, records);
  for (int i = 0; i < records; ++i) {
    // From the loop's own difference equation, settled before the record.
    const Eigen::VectorXd v =
        first.sigma * testing::white_noise(N + 50, 5000 + static_cast<std::uint64_t>(i));
    double e = 0.0;
    Eigen::MatrixXd z(1, N);
    for (Eigen::Index k = -50; k < N; ++k) {
      e = first.rho() * e + (k > 0 ? first.beta * moves.u0(0, k - 1) : 0.0) + v(k + 50);
      if (k >= 0)
        z(0, k) = e;
    }
    c.col(i) = loop_autocovariance(z, lags);
  }
  const Eigen::VectorXd mean = c.rowwise().mean();
  const Eigen::MatrixXd deviations = c.colwise() - mean;
  const Eigen::MatrixXd sampled = deviations * deviations.transpose() / (records - 1.0);
  const Eigen::MatrixXd theory = autocovariance_covariance(first.loop, moves, lags, &first.changed, 1.0);
  const Eigen::VectorXd expected = theoretical_autocovariance(first.loop, moves, lags, &first.changed);
  for (Eigen::Index i = 0; i < 3; ++i) {
    // Five deviations of a mean of 3000 records.
    CHECK(std::abs(mean(i) - expected(i)) < 5.0 * std::sqrt(theory(i, i) / records));
    for (Eigen::Index j = 0; j < 3; ++j)  // of a covariance: about sqrt(2/3000) = 2.6 %, and 1 % of the ends
      CHECK(std::abs(sampled(i, j) - theory(i, j)) < 0.13 * std::sqrt(theory(i, i) * theory(j, j)));
  }
}

TEST_CASE("autocovariance: the linear loop is the controller, and what is wrong in a loop is named") {
  const SetpointLoops made;
  Assessor method(assessment_method("autocovariance"), made.context);
  CHECK_FALSE(method.assess(made.with(made.study.plant.G, 3)).flagged);

  // u_0 + Q e of a changed plant is the MV of the simulated loop: the theory holds without noise.
  TransferMatrix plant = made.study.plant.G;
  plant(1, 0) = plant(1, 0).with_gain_scaled(0.7);
  const AssessedLoop loop = made.with(plant, 4);
  const LinearLoop linear = linear_loop(made.context, *made.context.benchmark, 900);
  const OutsideMoves moves = outside_moves(made.context, loop);
  const Eigen::MatrixXd e = loop.y - loop.y_sim;
  Eigen::MatrixXd u = moves.u0;
  for (std::size_t l = 0; l < 3; ++l)
    for (Eigen::Index k = 0; k < u.cols(); ++k)
      for (Eigen::Index lag = 0; lag <= k; ++lag)
        u.col(k) += linear.q[l].col(lag) * e(static_cast<Eigen::Index>(l), k - lag);
  CHECK((u - loop.u).cwiseAbs().maxCoeff() < 1e-6 * loop.u.cwiseAbs().maxCoeff());

  const Assessment found = method.assess(loop);
  CHECK(found.flagged);
  INFO("misfit " << found.number("misfit"));
  REQUIRE(found.named_mismatch);
  CHECK(found.named_mismatch->channel == Channel{1, 0});
  CHECK(found.named_mismatch->parameter == MismatchParameter::gain);
  CHECK(found.named_mismatch->lower <= 0.7);
  CHECK(found.named_mismatch->upper >= 0.7);
  CHECK(found.number("misfit") < 1.0);

  Eigen::MatrixXd y_d = Eigen::MatrixXd::Zero(3, loop.samples());
  y_d.row(2) = 0.1 * testing::settled_autoregression(loop.samples(), 0.95, 9).transpose();
  const Assessment disturbed = method.assess(made.with(made.study.plant.G, 5, y_d));
  CHECK(disturbed.flagged);
  CHECK(disturbed.cvs[2].source == FaultSource::ud);
  CHECK_FALSE(disturbed.named_mismatch);
}

TEST_CASE("autocovariance: it says where it does not apply") {
  const Study range = find_study("chapter6");
  const BasisCase basis = run_basis_case(range, testing::kFactory);
  const AssessmentContext context = assessment_context(range, basis, testing::kFactory);
  CHECK(Assessor(assessment_method("autocovariance"), context).assess(*context.benchmark).reason ==
        "the controller holds CVs in ranges, and the loop is not linear");

  const SetpointLoops made;
  Assessor method(assessment_method("autocovariance"), made.context);
  const Study limited = find_study("setpoint-methods");
  const BasisCase at_limits = run_basis_case(limited, testing::kFactory);
  const AssessmentContext of_limited = assessment_context(limited, at_limits, testing::kFactory);
  CHECK(Assessor(assessment_method("autocovariance"), of_limited).assess(*of_limited.benchmark).reason ==
        "u1 reaches a hard limit, and the loop is not linear");
  const AssessedLoop brief = window_of(*made.context.benchmark, 0, 120);
  CHECK_THAT(method.assess(brief).reason, Catch::Contains("128 samples or more"));  // 4 times the largest lag
}

TEST_CASE("autocovariance: healthy loops are not flagged more often than asked for by far") {
  SetpointLoops made;
  for (const double a : {0.0, 0.9}) {
    const int flagged = flagged_by_chance(made, a, 20);
    INFO("autoregression " << a << ", flagged " << flagged);
    CHECK(testing::clopper_pearson_interval(flagged, 20, 0.999).lower <= 0.01);
  }
}

TEST_CASE("autocovariance: false alarms of 1000 loops, for the documentation", "[.measure]") {
  SetpointLoops made;
  for (const double a : {0.0, 0.9}) {
    const int flagged = flagged_by_chance(made, a, 1000);
    const Interval exact = testing::clopper_pearson_interval(flagged, 1000);
    WARN("autoregression " << a << ": " << flagged << " of 1000, " << exact.lower << " to " << exact.upper);
  }
}

}  // namespace mpm
