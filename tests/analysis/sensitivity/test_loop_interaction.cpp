#include <cmath>
#include <complex>
#include <numbers>

#include <catch2/catch.hpp>

#include "analysis/sensitivity/loop_interaction.hpp"
#include "analysis/sensitivity/relative_gain.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"

using mpm::active_frequency_response;
using mpm::ConstraintKind;
using mpm::find_study;
using mpm::loop_interaction;
using mpm::LoopInteraction;
using mpm::NominalSensitivity;
using mpm::relative_gains;
using mpm::rpn_weight;
using mpm::Study;

namespace {

using Complex = std::complex<double>;

/// Each CV follows its own setpoint as 1 - a^l.
NominalSensitivity first_order_loops(Eigen::Index cvs, double a, Eigen::Index samples) {
  NominalSensitivity sensitivity;
  sensitivity.cv_count = cvs;
  for (Eigen::Index cv = 0; cv < cvs; ++cv) {
    sensitivity.active.push_back({cv, ConstraintKind::setpoint});
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(cvs, samples);
    for (Eigen::Index l = 0; l < samples; ++l)
      step(cv, l) = 1.0 - std::pow(a, static_cast<double>(l + 1));
    sensitivity.step_response.push_back(step);
  }
  return sensitivity;
}

}  // namespace

TEST_CASE("relative gains: a 2x2 process by hand, rows and columns sum to 1") {
  Eigen::Matrix2cd G;
  G << 87.8, -86.4, 108.2, -109.6;
  const Eigen::MatrixXcd lambda = relative_gains(G);
  const double first = 1.0 / (1.0 - 86.4 * 108.2 / (87.8 * 109.6));
  CHECK(lambda(0, 0).real() == Approx(first));
  CHECK(lambda(0, 1).real() == Approx(1.0 - first));
  CHECK(lambda(1, 0).real() == Approx(1.0 - first));
  CHECK(lambda(1, 1).real() == Approx(first));
  CHECK(lambda.imag().isZero(1e-12));

  const Eigen::MatrixXcd complex = Eigen::MatrixXcd::Random(4, 4);
  CHECK((relative_gains(complex).rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-10);
  CHECK((relative_gains(complex).colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-10);
}

TEST_CASE("relative gains: the same in other units, and 1 without interaction both ways") {
  const Eigen::MatrixXcd G = Eigen::MatrixXcd::Random(3, 3);
  const Eigen::Vector3cd rows(1e8, 1.0, -2.0);
  const Eigen::Vector3cd cols(1e-9, 3.0, 1e5);
  const Eigen::MatrixXcd scaled = rows.asDiagonal() * G * cols.asDiagonal();
  CHECK(relative_gains(scaled).isApprox(relative_gains(G), 1e-9));
  Eigen::Matrix3cd triangular = G;
  triangular.triangularView<Eigen::StrictlyLower>().setZero();
  CHECK(relative_gains(triangular).isApprox(Eigen::Matrix3cd::Identity(), 1e-9));
}

TEST_CASE("relative gains: none of a singular process") {
  Eigen::Matrix2cd G;
  G << 1.0, 2.0, 1e-9, 2e-9;
  CHECK(relative_gains(G).array().isNaN().all());
  G << 1.0, 2.0, 0.0, 0.0;
  CHECK(relative_gains(G).array().isNaN().all());
  CHECK_THROWS_AS(relative_gains(Eigen::MatrixXcd::Ones(2, 3)), mpm::InputError);
  CHECK_THROWS_AS(relative_gains(Eigen::MatrixXcd(0, 0)), mpm::InputError);
}

TEST_CASE("RPN weight: 1/2 at the corner of a first-order loop") {
  const double tau = 7.0;
  for (const double w : {0.01, 1.0 / tau, 2.0}) {
    const Complex T0 = 1.0 / Complex(1.0, w * tau);
    // S0 T0 = jw tau/(1 + jw tau)^2
    CHECK(rpn_weight(Eigen::MatrixXcd::Constant(1, 1, T0)) == Approx(w * tau / (1.0 + w * w * tau * tau)));
  }
  // Loops that do not meet: the largest of them.
  Eigen::Matrix2cd two = Eigen::Matrix2cd::Zero();
  two(0, 0) = Complex(0.5, -0.5);
  two(1, 1) = 0.9;
  CHECK(rpn_weight(two) == Approx(0.5));
  CHECK(rpn_weight(Eigen::MatrixXcd::Identity(3, 3)) == 0.0);
}

TEST_CASE("T0 at a frequency: the z transform of a first-order loop; static gain at 0") {
  const double a = 0.8;
  const double sample_time = 4.0;
  const NominalSensitivity sensitivity = first_order_loops(2, a, 200);  // a^200 is 4e-20
  for (const double w : {0.001, 0.05, std::numbers::pi / 4.0}) {
    const Complex z = std::polar(1.0, w * sample_time);
    const Eigen::MatrixXcd T0 = active_frequency_response(sensitivity, w, sample_time);
    CHECK(std::abs(T0(0, 0) - (1.0 - a) / (z - a)) < 1e-12);
    CHECK(T0(0, 1) == 0.0);
  }
  CHECK(active_frequency_response(sensitivity, 0.0, sample_time).isApprox(Eigen::Matrix2cd::Identity()));
  CHECK_THROWS_WITH(active_frequency_response(sensitivity, -1.0, 1.0), Catch::Contains("found -1"));
  CHECK_THROWS_AS(active_frequency_response(sensitivity, 1.0, 0.0), mpm::InputError);
}

TEST_CASE("interaction: RPN and its maximum of first-order loops, relative gains of the column") {
  const Study study = find_study("chapter4-column");  // Ts 8 min; all channels have one time constant
  const double a = 0.95;
  const LoopInteraction found = loop_interaction(study, {}, first_order_loops(2, a, 1000));
  REQUIRE(found.frequency.size() == 200);
  CHECK(found.frequency(199) == Approx(std::numbers::pi / 8.0));
  for (Eigen::Index i = 0; i < 200; ++i) {
    const Complex z = std::polar(1.0, found.frequency(i) * 8.0);
    CHECK(found.rpn(i) == Approx(std::abs((1.0 - a) * (z - 1.0) / ((z - a) * (z - a)))).margin(1e-12));
  }
  // |z - 1|/|z - a|^2 with c = cos(w Ts): sqrt(2 - 2c)/(1 + a^2 - 2ac) is largest where
  // 1 + a^2 - 2ac = 2a(2 - 2c), c = (4a - 1 - a^2)/(2a).
  const double c = (4.0 * a - 1.0 - a * a) / (2.0 * a);
  CHECK(found.rpn_frequency == Approx(std::acos(c) / 8.0).epsilon(1e-3));
  CHECK(found.rpn_maximum >= found.rpn.maxCoeff());
  CHECK(found.peaks.size() == 1);
  CHECK(found.cvs == std::vector<Eigen::Index>{0, 1});
  CHECK(found.mvs == std::vector<Eigen::Index>{0, 1});
  const double lambda = 1.0 / (1.0 - 86.4 * 108.2 / (87.8 * 109.6));
  CHECK(found.relative_gain.front()(0, 0) == Approx(lambda));
  CHECK(found.relative_gain.back()(1, 1) == Approx(lambda));
  CHECK(found.relative_gain_at_maximum(0, 1) == Approx(lambda - 1.0));
}

TEST_CASE(
    "interaction: a direction that needs one sample peaks at the Nyquist frequency, a slow one before") {
  const Study study = find_study("chapter4-column");
  NominalSensitivity sensitivity = first_order_loops(2, 0.95, 1000);
  sensitivity.step_response[1].row(1).setOnes();  // T0 = 1/z
  const LoopInteraction found = loop_interaction(study, {}, sensitivity);
  REQUIRE(found.peaks.size() == 2);
  CHECK(found.peaks[0].rpn == Approx(0.5 / std::sqrt(0.95)));  // by the formula above
  CHECK(found.peaks[1].frequency == Approx(std::numbers::pi / 8.0));
  CHECK(found.rpn_maximum == Approx(2.0));
  CHECK(found.rpn_frequency == found.peaks[1].frequency);
}

TEST_CASE("interaction: no relative gains without as many MVs as active CVs, nothing without any") {
  const Study study = find_study("chapter4-column");
  NominalSensitivity sensitivity = first_order_loops(2, 0.9, 100);
  const LoopInteraction fixed = loop_interaction(study, {{}, {}, {}, {1}}, sensitivity);
  CHECK(fixed.mvs.empty());
  CHECK(fixed.relative_gain.empty());
  CHECK(fixed.rpn_maximum > 0.4);
  sensitivity.active.pop_back();
  sensitivity.step_response.pop_back();
  CHECK(loop_interaction(study, {{}, {}, {}, {0}}, sensitivity).mvs == std::vector<Eigen::Index>{1});
  Study no_inverse = study;
  no_inverse.plant.G(1, 0) = no_inverse.plant.G(1, 1) =
      TransferFunction::zero();  // nothing moves the second CV
  const LoopInteraction singular = loop_interaction(no_inverse, {}, first_order_loops(2, 0.9, 100));
  CHECK(singular.mvs.empty());
  CHECK(singular.relative_gain.empty());
  CHECK(singular.relative_gain_at_maximum.size() == 0);
  const LoopInteraction none = loop_interaction(study, {}, NominalSensitivity{2, {}, {}});
  CHECK(none.frequency.size() == 0);
  CHECK(std::isnan(none.rpn_frequency));
  CHECK_THROWS_AS(loop_interaction(study, {}, sensitivity, 1), mpm::InputError);
}

TEST_CASE("interaction: a T0 that is not finite, or overflows, has none, and is no error") {
  const Study study = find_study("chapter4-column");
  for (const double value : {std::nan(""), HUGE_VAL, -1e308}) {
    NominalSensitivity sensitivity = first_order_loops(2, 0.9, 100);
    sensitivity.step_response[1](0, 7) = value;
    const LoopInteraction none = loop_interaction(study, {}, sensitivity);
    CHECK(none.cvs.size() == 2);
    CHECK(none.frequency.size() == 0);
    CHECK(std::isnan(none.rpn_maximum));
  }
}
