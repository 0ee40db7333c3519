#include <cmath>
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/plant_model_ratio.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "tests/analysis/exact_interval.hpp"
#include "tests/analysis/signals.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// Loops of a study made of its basis case.
struct RatioLoops {
  explicit RatioLoops(const std::string& name, const std::string& option = "")
      : study(option.empty() ? find_study(name) : parse_study(find_study(name).source + option, name)) {}

  Study study;
  BasisCase basis = run_basis_case(study, testing::kFactory);
  AssessmentContext context = assessment_context(study, basis, testing::kFactory);

  /// The basis case with what another plant adds to a CV.
  AssessedLoop with(Eigen::Index cv, Eigen::Index mv, const TransferFunction& plant) const {
    AssessedLoop loop = *context.benchmark;
    const Eigen::VectorXd u = loop.u.row(mv).transpose();
    const double Ts = study.controller.sample_time;
    loop.y.row(cv) +=
        (channel_response(plant, Ts, u) - channel_response(study.plant.G(cv, mv), Ts, u)).transpose();
    return loop;
  }
};

/// Of `loops` records with the moves of the basis case and autoregressions of their own as simulation errors,
/// how many are flagged.
int flagged_by_chance(const RatioLoops& made, double a, int loops) {
  Assessor pmr(assessment_method("pmr"), made.context);
  AssessedLoop loop = *made.context.benchmark;
  int flagged = 0;
  for (int i = 0; i < loops; ++i) {
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      loop.y.row(cv) =
          loop.y_sim.row(cv) +
          0.02 * testing::settled_autoregression(loop.samples(), a, 7000 + 10 * i + cv).transpose();
    flagged += pmr.assess(loop).flagged ? 1 : 0;
  }
  return flagged;
}

}  // namespace

TEST_CASE("plant-model ratio: the transfer functions of the filters over that of the held model") {
  const double K = 2.0, T = 30.0, Ts = 4.0, a = std::exp(-Ts / T), root = std::sqrt(1.0 - a * a);
  const TransferFunction channel = TransferFunction::first_order(K, T, 2.0 * Ts);
  const Eigen::Vector3d b(0.3, -0.2, 0.1);
  const Eigen::Vector3d w(0.001, 0.03, 0.5);
  const Eigen::VectorXcd P = plant_model_ratio(channel, Ts, b, w);
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const std::complex<double> back = std::polar(1.0, -w(i) * Ts);  // q^-1
    const std::complex<double> pole = 1.0 - a * back, pass = (back - a) / pole;
    const std::complex<double> model = K * (1.0 - a) * back / pole * back * back;
    const std::complex<double> added = root * back * back / pole * (b(0) + b(1) * pass + b(2) * pass * pass);
    CHECK(std::abs(P(i) - (1.0 + added / model)) < 1e-9);  // what impulse responses leave after 30 T: e^-30
  }
  // Without dead time the first filter has the shape of the model: a gain is flat, without phase.
  const Eigen::Vector3d gain(0.5 * K * (1.0 - a) / root, 0.0, 0.0);
  const RatioSignature read = ratio_signature(TransferFunction::first_order(K, T), Ts, gain);
  CHECK(read.magnitude == Approx(1.5));
  CHECK(read.bend == Approx(1.0));
  CHECK(read.delay == Approx(0.0).margin(1e-9));
  CHECK_THROWS_WITH(plant_model_ratio(TransferFunction::zero(), Ts, b, w),
                    Catch::Contains("one that settles"));
  CHECK_THROWS_WITH(plant_model_ratio(channel, Ts, w.head(2), w), Catch::Contains("found 2; allowed: 3"));
}

TEST_CASE("plant-model ratio: each parameter has its signature, and is named with its size") {
  const RatioLoops made("setpoint-methods");
  Assessor pmr(assessment_method("pmr"), made.context);
  CHECK_FALSE(pmr.assess(*made.context.benchmark).flagged);
  const TransferFunction& model = made.study.plant.G(1, 0);
  const std::vector<std::pair<Mismatch, TransferFunction>> cases{
      {{1, 0, MismatchParameter::gain, 0.7}, model.with_gain_scaled(0.7)},
      {{1, 0, MismatchParameter::time_constant, 1.5}, model.with_time_scaled(1.5)},
      {{1, 0, MismatchParameter::dead_time, 4.0}, model.with_dead_time_shifted(4.0)}};
  for (const auto& [mismatch, plant] : cases) {
    INFO(to_string(mismatch.parameter));
    const Assessment found = pmr.assess(made.with(1, 0, plant));
    REQUIRE(found.named_mismatch);
    CHECK(found.worst_cv() == Eigen::Index{1});
    CHECK(found.cvs[1].source == FaultSource::mpm);
    CHECK(found.flagged_channels == std::vector<Channel>{{1, 0}});
    CHECK(found.named_mismatch->parameter == mismatch.parameter);
    // Two stages leave what the MVs do in answer to noise out of the record: a few percent of a size.
    CHECK(found.named_mismatch->size == Approx(mismatch.value).epsilon(0.05));
    const bool gain = mismatch.parameter == MismatchParameter::gain;
    const bool bent = mismatch.parameter == MismatchParameter::time_constant;
    CHECK(found.number("magnitude", 1, 0) == Approx(gain ? 0.7 : 1.0).margin(0.1));
    CHECK((found.number("bend", 1, 0) < 0.9) == bent);
    // A slower plant lags as well; a gain does not.
    CHECK((found.number("delay", 1, 0) > 1.0) == !gain);
  }
}

TEST_CASE("plant-model ratio: a disturbance is none, and without moves from outside it does not apply") {
  const RatioLoops made("setpoint-methods");
  Assessor pmr(assessment_method("pmr"), made.context);
  AssessedLoop loop = *made.context.benchmark;
  loop.y.row(1) += 0.2 * testing::settled_autoregression(loop.samples(), 0.97, 6).transpose();
  CHECK_FALSE(pmr.assess(loop).flagged);
  loop.y_set.setZero();
  CHECK(pmr.assess(loop).reason == "no signal from outside moves the loop");

  const RatioLoops range("chapter6", "\n[assessment.pmr]\ninstruments = \"setpoints\"\n");
  CHECK(Assessor(assessment_method("pmr"), range.context).assess(*range.context.benchmark).reason ==
        "no setpoint of the controller moves");
  AssessedLoop brief = *made.context.benchmark;
  for (Eigen::MatrixXd* signal : {&brief.y, &brief.u, &brief.d, &brief.y_sim, &brief.y_set})
    *signal = Eigen::MatrixXd(signal->leftCols(50));
  CHECK(pmr.assess(brief).status == AssessmentStatus::not_applicable);
}

TEST_CASE("plant-model ratio: no more false alarms than stated, white and coloured") {
  const RatioLoops made("setpoint-methods");
  for (const double a : {0.0, 0.9}) {
    const int flagged = flagged_by_chance(made, a, 200);
    INFO("autoregression " << a << ", flagged " << flagged);
    CHECK(testing::clopper_pearson_interval(flagged, 200, 0.999).lower <= 0.01);
  }
}

TEST_CASE("plant-model ratio: false alarms of 1000 records, for the documentation", "[.measure]") {
  const RatioLoops made("setpoint-methods");
  for (const double a : {0.0, 0.9, 0.98}) {
    const int flagged = flagged_by_chance(made, a, 1000);
    const Interval exact = testing::clopper_pearson_interval(flagged, 1000);
    WARN("autoregression " << a << ": " << flagged << " of 1000, " << exact.lower << " to " << exact.upper);
  }
}

}  // namespace mpm
