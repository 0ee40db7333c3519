#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/methods/literature/model_quality.hpp"
#include "base/error.hpp"
#include "tests/analysis/identification/identification_samples.hpp"

using mpm::integrated_noise;
using mpm::model_quality;
using mpm::ModelQuality;
using mpm::ModelQualityOptions;
using mpm::ModelQualityStatus;
using mpm::NoiseModel;
using mpm::testing::white_inputs;
using mpm::testing::white_noise;

namespace {

/// The record of a loop with a plant b q^-1 and its model b0 q^-1.
struct Record {
  Eigen::MatrixXd y, r, y_sim;
};

/// u = K (r - y): y(k) = b u(k-1) + e(k) is an ARX model of first order in y and r.
Record proportional_loop(double b, double b0, double K, Eigen::Index N, std::uint64_t number) {
  Record record{Eigen::MatrixXd(1, N), white_inputs(1, N, number), Eigen::MatrixXd(1, N)};
  const Eigen::VectorXd e = white_noise(N, number + 1);
  double u = 0.0;
  for (Eigen::Index k = 0; k < N; ++k) {
    record.y(0, k) = b * u + e(k);
    record.y_sim(0, k) = b0 * u;
    u = K * (record.r(0, k) - record.y(0, k));
  }
  return record;
}

/// u(k) = u(k-1) + (r - y)/b: y(k) = r(k-1) + e(k) - e(k-1).
Record integral_loop(Eigen::Index N, std::uint64_t number) {
  Record record{Eigen::MatrixXd(1, N), white_inputs(1, N, number), Eigen::MatrixXd(1, N)};
  const Eigen::VectorXd e = white_noise(N, number + 1);
  double u = 0.0;
  for (Eigen::Index k = 0; k < N; ++k) {
    record.y(0, k) = u + e(k);
    record.y_sim(0, k) = u;
    u += record.r(0, k) - record.y(0, k);
  }
  return record;
}

/// Three CVs with a perfect model, a biased gain and a coloured disturbance.
Record three_cvs(Eigen::Index N, std::uint64_t number) {
  Record record{Eigen::MatrixXd(3, N), white_inputs(3, N, number), Eigen::MatrixXd(3, N)};
  const Eigen::MatrixXd e = white_inputs(3, N, number + 1);
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  double d = 0.0;
  for (Eigen::Index k = 0; k < N; ++k) {
    d = 0.95 * d + e(2, k);
    record.y.col(k) << u(0) + e(0, k), 1.6 * u(1) + 0.3 * u(0) + e(1, k), u(2) + d;
    record.y_sim.col(k) << u(0), u(1) + 0.3 * u(0), u(2);
    u = 0.5 * (record.r.col(k) - record.y.col(k));
  }
  return record;
}

ModelQualityOptions of_order(Eigen::Index order) {
  ModelQualityOptions options;
  options.arx.orders = {order};
  return options;
}

ModelQuality quality(const Record& record, Eigen::Index order, const NoiseModel& G_d0 = {}) {
  return model_quality(record.y, record.r, record.y_sim, Eigen::VectorXd::Ones(record.y.rows()),
                       std::vector<NoiseModel>(static_cast<std::size_t>(record.y.rows()), G_d0),
                       of_order(order));
}

}  // namespace

TEST_CASE("model quality: a perfect model with white residuals has the index 1") {
  const Record record = proportional_loop(1.0, 1.0, 0.4, 20000, 340);
  const ModelQuality result = quality(record, 1);
  CHECK(result.status == ModelQualityStatus::ok);
  // e^d is e up to a projection on 3 of 20000 directions, each of which takes away a chi^2(1) of e'e: below 1
  // by less than 30/20000, the 1e-6 quantile of chi^2(3).
  CHECK(result.mqi <= 1.0);
  CHECK(result.mqi > 1.0 - 30.0 / 20000.0);
  CHECK(result.imqi(0) == Approx(std::sqrt(result.mqi)));
}

TEST_CASE("model quality: a gain that is wrong gives the index in closed form") {
  // e^p = -(b - b0) u(k-1) - e(k), independent: MQI = s^2/(s^2 + (b - b0)^2 var u), with a = b K,
  // var y = (a^2 R + s^2)/(1 - a^2) and var u = K^2 (R + var y), R = s^2 = 1.
  const double b0 = 1.0, K = 0.4;
  double before = 2.0;
  for (const double b : {1.0, 1.5, 2.0, 2.3}) {
    const ModelQuality result = quality(proportional_loop(b, b0, K, 40000, 342), 1);
    const double a = b * K;
    const double var_u = K * K * (1.0 + (a * a + 1.0) / (1.0 - a * a));
    const double expected = 1.0 / (1.0 + (b - b0) * (b - b0) * var_u);
    CHECK(result.mqi ==
          Approx(expected).epsilon(0.06));  // 5 standard errors sqrt(2/N) of a ratio, coloured u
    CHECK(result.mqi < before);
    before = result.mqi;
  }
}

TEST_CASE("model quality: an offset-free controller puts a perfect model above 1 by (M + 2)/(M + 1)") {
  // The innovations of y = r(k-1) + e(k) - e(k-1) need an infinite past; from M past values of a moving
  // average with its zero on the unit circle the error has the variance (M + 2)/(M + 1).
  const Record record = integral_loop(40000, 344);
  for (const Eigen::Index M : {1, 3, 9}) {
    ModelQualityOptions options = of_order(M);
    options.arx.input_order = M + 1;
    const ModelQuality result =
        model_quality(record.y, record.r, record.y_sim, Eigen::VectorXd::Ones(1), {NoiseModel{}}, options);
    const double expected = static_cast<double>(M + 2) / static_cast<double>(M + 1);
    CHECK(result.mqi == Approx(expected).epsilon(0.02));  // sampling of a ratio of two nearly equal errors
  }
}

TEST_CASE("model quality: white residuals under integrated noise have the index (1 + c)/2") {
  const Record record = proportional_loop(1.0, 1.0, 0.4, 40000, 346);
  for (const double c : {0.0, 0.382, 0.8})
    CHECK(quality(record, 1, integrated_noise(c)).mqi == Approx((1.0 + c) / 2.0).epsilon(0.03));
}

TEST_CASE("model quality: references that are left out of the model put the index above 1") {
  const Record record = proportional_loop(1.0, 1.0, 0.4, 5000, 348);
  const ModelQuality blind = model_quality(record.y, Eigen::MatrixXd(0, 5000), record.y_sim,
                                           Eigen::VectorXd::Ones(1), {NoiseModel{}}, of_order(1));
  CHECK(blind.mqi == Approx(1.0 + 0.4 * 0.4).epsilon(0.05));  // what K r adds to the innovations
}

TEST_CASE("model quality: the sums are those of (2.4) and (4.3), sample by sample") {
  const Record record = three_cvs(300, 350);
  const std::vector<NoiseModel> G_d0{
      {}, integrated_noise(0.5), {Eigen::VectorXd::Ones(1), Eigen::Vector2d(1.0, -0.95)}};
  const Eigen::Vector3d Q(1.0, 6.0, 2.0);
  const ModelQuality result = model_quality(record.y, record.r, record.y_sim, Q, G_d0, of_order(4));
  const mpm::HighOrderArx arx = identify_high_order_arx(record.y, record.r, of_order(4).arx);
  Eigen::MatrixXd e_p(3, 300);
  double filtered = 0.0;
  for (Eigen::Index k = 0; k < 300; ++k) {
    const Eigen::Vector3d v = record.y.col(k) - record.y_sim.col(k);
    const Eigen::Vector3d v_before =
        k > 0 ? Eigen::Vector3d(record.y.col(k - 1) - record.y_sim.col(k - 1)) : Eigen::Vector3d::Zero();
    filtered = 0.5 * filtered + v(1) - v_before(1);
    e_p.col(k) << -v(0), -filtered, -(v(2) - 0.95 * v_before(2));
  }
  double numerator = 0.0, denominator = 0.0;
  Eigen::Vector3d d_sum = Eigen::Vector3d::Zero(), p_sum = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 4; k < 300; ++k) {
    const Eigen::Vector3d e_d = arx.e_d.col(k - 4);
    numerator += e_d.transpose() * Q.asDiagonal() * e_d;
    denominator += e_p.col(k).transpose() * Q.asDiagonal() * e_p.col(k);
    d_sum += e_d.cwiseAbs2();
    p_sum += e_p.col(k).cwiseAbs2();
  }
  CHECK(result.first_sample == 4);
  CHECK(result.mqi == Approx(numerator / denominator).epsilon(1e-12));
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK(result.imqi(i) == Approx(std::sqrt(d_sum(i)) / std::sqrt(p_sum(i))).epsilon(1e-12));
}

TEST_CASE("model quality: MQI is a mean of the squares of iMQI, and no unit matters") {
  const Record record = three_cvs(400, 352);
  const Eigen::Vector3d Q(0.5, 3.0, 2.0);
  const std::vector<NoiseModel> G_d0(3);
  const ModelQuality result = model_quality(record.y, record.r, record.y_sim, Q, G_d0, of_order(3));
  CHECK(result.mqi > result.imqi.cwiseAbs2().minCoeff());
  CHECK(result.mqi < result.imqi.cwiseAbs2().maxCoeff());
  CHECK(result.imqi(0) > 0.9);
  CHECK(result.imqi(2) < 0.6);

  const Eigen::Vector3d unit(1000.0, 1.0, 0.01);
  const auto scaled = [&unit](const Eigen::MatrixXd& signal) {
    return Eigen::MatrixXd(unit.asDiagonal() * signal);
  };
  const ModelQuality other = model_quality(scaled(record.y), scaled(record.r), scaled(record.y_sim),
                                           7.0 * Q.cwiseQuotient(unit.cwiseAbs2()), G_d0, of_order(3));
  CHECK((other.imqi - result.imqi).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(other.mqi == Approx(result.mqi).epsilon(1e-10));

  // A constant in output and model moves neither error.
  const Eigen::MatrixXd level = Eigen::Vector3d(5.0, -3.0, 1.0).replicate(1, 400);
  const ModelQuality moved =
      model_quality(record.y + level, record.r + level, record.y_sim + level, Q, G_d0, of_order(3));
  CHECK((moved.imqi - result.imqi).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("model quality: the correction for the coefficients takes their share out of the index") {
  const Record record = proportional_loop(1.0, 1.0, 0.4, 200, 354);
  ModelQualityOptions options = of_order(30);
  const auto mqi = [&] {
    return model_quality(record.y, record.r, record.y_sim, Eigen::VectorXd::Ones(1), {NoiseModel{}}, options)
        .mqi;
  };
  const double raw = mqi();
  CHECK(raw < 1.0 - 0.5 * 61.0 / 170.0);
  options.correct_for_parameters = true;
  CHECK(mqi() == Approx(raw * 170.0 / (170.0 - 61.0)));
}

TEST_CASE("model quality: without errors or without weights there is no index") {
  Record record = three_cvs(300, 356);
  record.y.row(1) = record.y_sim.row(1);
  const ModelQuality exact = quality(record, 2);
  CHECK(exact.status == ModelQualityStatus::error_free);
  CHECK(std::isnan(exact.imqi(1)));
  CHECK(std::isfinite(exact.imqi(0)));
  const ModelQuality weightless = model_quality(record.y, record.r, record.y_sim, Eigen::Vector3d::Zero(),
                                                std::vector<NoiseModel>(3), of_order(2));
  CHECK(std::isnan(weightless.mqi));
}

TEST_CASE("model quality: shapes that do not agree are refused") {
  const Record record = three_cvs(100, 358);
  const std::vector<NoiseModel> G_d0(3);
  const Eigen::Vector3d Q = Eigen::Vector3d::Ones();
  const auto call = [&](const Eigen::MatrixXd& y_sim, const Eigen::VectorXd& weight, std::size_t models) {
    return model_quality(record.y, record.r, y_sim, weight, std::vector<NoiseModel>(models), of_order(2));
  };
  CHECK_THROWS_WITH(call(record.y_sim.leftCols(99), Q, 3), Catch::Contains("3 x 99; allowed: 3 x 100"));
  CHECK_THROWS_WITH(call(record.y_sim, Q.head(2), 3), Catch::Contains("weights of the CVs: found 2"));
  CHECK_THROWS_WITH(call(record.y_sim, -Q, 3), Catch::Contains("one below 0"));
  CHECK_THROWS_WITH(call(record.y_sim, Q, 2), Catch::Contains("noise models: found 2"));
}
