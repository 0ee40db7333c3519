#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/models/catalogue.hpp"

namespace mpm {
namespace {

/// Eq. 6.18 again, property by property (the source has it channel by channel).
Eigen::MatrixXd shell_gains() {
  return (Eigen::MatrixXd(7, 5) <<  //
              4.05,
          1.77, 5.88, 1.20, 1.44, 5.39, 5.72, 6.90, 1.52, 1.83,  //
          3.66, 1.65, 5.53, 1.16, 1.27,                          //
          5.92, 2.54, 8.10, 1.73, 1.79,                          //
          4.13, 2.38, 6.23, 1.31, 1.26,                          //
          4.06, 4.18, 6.53, 1.19, 1.17,                          //
          4.38, 4.42, 7.20, 1.14, 1.26)
      .finished();
}

Eigen::MatrixXd shell_dead_times() {
  return (Eigen::MatrixXd(7, 5) <<  //
              27,
          28, 27, 27, 27, 18, 14, 15, 15, 15,  //
          2, 20, 2, 0, 0,                      //
          11, 12, 2, 0, 0,                     //
          5, 7, 2, 0, 0,                       //
          8, 4, 1, 0, 0,                       //
          20, 22, 0, 0, 0)
      .finished();
}

Eigen::MatrixXd shell_time_constants() {
  return (Eigen::MatrixXd(7, 5) <<  //
              50,
          60, 50, 45, 40, 50, 60, 40, 25, 20,  //
          9, 30, 40, 11, 6,                    //
          12, 27, 20, 5, 19,                   //
          8, 19, 10, 2, 22,                    //
          13, 33, 9, 19, 24,                   //
          33, 44, 19, 27, 32)
      .finished();
}

}  // namespace

TEST_CASE("every plant of the catalogue is consistent and carries its name", "[catalogue]") {
  REQUIRE_FALSE(benchmark_plant_names().empty());
  for (const std::string& name : benchmark_plant_names()) {
    const PlantModel plant = benchmark_plant(name);
    CHECK_NOTHROW(plant.validate());
    CHECK(plant.name == name);
    CHECK_FALSE(plant.title.empty());
  }
}

TEST_CASE("an unknown plant is refused with the known ones", "[catalogue]") {
  CHECK_THROWS_AS(benchmark_plant("shell"), InputError);
  CHECK_THROWS_WITH(benchmark_plant("shell"), Catch::Contains("'shell'") && Catch::Contains("shell-7x3"));
}

TEST_CASE("shell-7x3 has the variables of table 6.1", "[catalogue]") {
  const PlantModel plant = benchmark_plant("shell-7x3");
  CHECK(plant.time_unit == "min");
  REQUIRE(plant.cvs.size() == 7);
  REQUIRE(plant.mvs.size() == 3);
  REQUIRE(plant.mds.size() == 2);
  CHECK(plant.cvs[6].name == "y7");
  CHECK(plant.cvs[6].description == "Bottoms Reflux Temperature");
  CHECK(plant.mvs[1].description == "Side Draw");
  CHECK(plant.mds[1].description == "Upper Reflux Duty");
}

TEST_CASE("shell-7x3 has the frequency response of eq. 6.18", "[catalogue]") {
  const TransferMatrix G = benchmark_plant("shell-7x3").G;
  CHECK(G.static_gain() == shell_gains());
  for (const double omega : {0.003, 0.02, 0.11}) {
    const std::complex<double> s(0, omega);
    const Eigen::MatrixXcd response = G.frequency_response(s);
    for (Eigen::Index i = 0; i < 7; ++i) {
      for (Eigen::Index j = 0; j < 5; ++j) {
        INFO("y" << i + 1 << ", input " << j + 1 << ", omega " << omega);
        const double gain = shell_gains()(i, j);
        const double lag = omega * shell_time_constants()(i, j);
        const double magnitude = gain / std::sqrt(1 + lag * lag);
        const double phase = -omega * shell_dead_times()(i, j) - std::atan(lag);
        // Rounding of a few operations on numbers up to 8.
        CHECK(std::abs(response(i, j) - std::polar(magnitude, phase)) < 1e-13);
      }
    }
  }
}

TEST_CASE("shell-7x3 steps as first-order lags with dead time", "[catalogue]") {
  const double Ts = 4;  // table 6.2
  const std::vector<Eigen::MatrixXd> steps = step_response(benchmark_plant("shell-7x3").G, Ts, 60);
  for (Eigen::Index j = 0; j < 5; ++j) {
    for (Eigen::Index i = 0; i < 7; ++i) {
      for (Eigen::Index k = 1; k <= 60; ++k) {
        const double since = std::max(0.0, Ts * static_cast<double>(k) - shell_dead_times()(i, j));
        const double expected = -shell_gains()(i, j) * std::expm1(-since / shell_time_constants()(i, j));
        // Sixty steps with a rounding of about 1e-15 each.
        CHECK(std::abs(steps[static_cast<std::size_t>(j)](i, k - 1) - expected) < 1e-12);
      }
    }
  }
}

TEST_CASE("shell-3x3 is the part of shell-7x3 that eq. 2.25 prints", "[catalogue]") {
  const TransferMatrix G = benchmark_plant("shell-3x3").G;
  const std::array<Eigen::Index, 3> cv{0, 1, 6};
  REQUIRE(G.rows() == 3);
  REQUIRE(G.cols() == 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      INFO("y" << i + 1 << ", u" << j + 1);
      const Eigen::Index row = cv[static_cast<std::size_t>(i)];
      CHECK(G(i, j).static_gain() == shell_gains()(row, j));
      CHECK(G(i, j).denominator()(0) == shell_time_constants()(row, j));
      const bool differs = i == 2 && j == 2;  // 19 min in (2.25) and (4.18), none in (6.18)
      CHECK(G(i, j).dead_time() == (differs ? 19 : shell_dead_times()(row, j)));
    }
  }
}

TEST_CASE("the distillation column has the gains, the time constant and the RGA of 4.3.1", "[catalogue]") {
  const PlantModel plant = benchmark_plant("distillation-column");
  const Eigen::MatrixXd gain = plant.G.static_gain();
  CHECK(gain == (Eigen::Matrix2d() << 87.8, -86.4, 108.2, -109.6).finished());
  for (Eigen::Index i = 0; i < 2; ++i)
    for (Eigen::Index j = 0; j < 2; ++j)
      CHECK(std::abs(plant.G(i, j)(std::complex<double>(0, 1.0 / 75)) / gain(i, j) -
                     1.0 / std::complex<double>(1, 1)) < 1e-14);
  // The diagonal of the relative gain array, "approximately equal to 35".
  const double relative_gain = gain(0, 0) * gain(1, 1) / gain.determinant();
  CHECK(std::abs(relative_gain - 35) < 0.5);
}

TEST_CASE("the SISO plant has the gain and the inverse response of table 5.1", "[catalogue]") {
  const TransferMatrix G = benchmark_plant("siso").G;
  CHECK(G.static_gain()(0, 0) == 3.04);
  const std::complex<double> s(0.02, 0.3);
  CHECK(std::abs(G(0, 0)(s) - (-100.0 * s + 3.04) / (305.0 * s * s + 40.0 * s + 1.0)) < 1e-14);
  const Eigen::MatrixXd step = step_response(G, 10, 40)[0];  // 10 s, table 5.1
  CHECK(step(0, 0) < -1);                                    // the zero at +0.03 / s
  CHECK(std::abs(step(0, 39) - 3.04) < 1e-3);
}

TEST_CASE("Ogunnaike and Ray's column has the printed gains, and its second-order channel the printed poles",
          "[catalogue]") {
  const TransferMatrix G = benchmark_plant("ogunnaike-ray").G;
  const Eigen::MatrixXd gains = (Eigen::MatrixXd(3, 5) << 0.66, -0.61, -0.0049, 0.14, -0.0011,  //
                                 1.11, -2.36, -0.01, 0.53, -0.0032,                             //
                                 -34.68, 46.2, 0.87, -11.54, 0.32)
                                    .finished();
  CHECK(G.static_gain() == gains);
  const std::complex<double> s(0.01, 0.2);
  const std::complex<double> printed =
      0.87 * (11.61 * s + 1.0) * std::exp(-s) / (3.89 * s + 1.0) / (18.8 * s + 1.0);
  CHECK(std::abs(G(2, 2)(s) - printed) < 1e-14);
  CHECK(G(2, 1).dead_time() == 9.4);
}

TEST_CASE("the evaporator is the linearisation of the book's equations", "[catalogue]") {
  // Newell and Lee's equations at their operating point, differentiated numerically.
  using State = Eigen::Vector3d;  // X2, P2, L2
  const auto rates = [](const State& x, const Eigen::VectorXd& in) -> State {
    const double X2 = x(0), P2 = x(1), F2 = in(0), P100 = in(1), F200 = in(2), F1 = in(3), X1 = in(4),
                 T1 = in(5);
    const double T2 = 0.5616 * P2 + 0.3126 * X2 + 48.43, T3 = 0.507 * P2 + 55.0, T100 = 0.1538 * P100 + 90.0;
    const double Q100 = 0.16 * (F1 + 50.0) * (T100 - T2);
    const double F4 = (Q100 - F1 * 0.07 * (T2 - T1)) / 38.5;
    const double F5 = 6.84 * (T3 - 25.0) / (1.0 + 6.84 / (2.0 * 0.07 * F200)) / 38.5;
    return {(F1 * X1 - F2 * X2) / 20.0, (F4 - F5) / 4.0, (F1 - F4 - F2) / 20.0};
  };
  const State x0(25.0, 50.5, 1.0);
  const Eigen::VectorXd in0 = (Eigen::VectorXd(6) << 2.0, 194.67906, 208.05238, 10.0, 5.0, 40.0).finished();
  CHECK(rates(x0, in0).norm() < 1e-6);
  constexpr double h = 1e-4;
  Eigen::Matrix3d A;
  Eigen::MatrixXd B(3, 6);
  for (Eigen::Index i = 0; i < 3; ++i)
    A.col(i) = (rates(x0 + h * State::Unit(i), in0) - rates(x0 - h * State::Unit(i), in0)) / (2.0 * h);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(6, i);
    B.col(i) = (rates(x0, in0 + step) - rates(x0, in0 - step)) / (2.0 * h);
  }
  const PlantModel plant = benchmark_plant("evaporator");
  const std::complex<double> s(0.02, 0.15);
  const Eigen::MatrixXcd states =
      (s * Eigen::Matrix3cd::Identity() - A.cast<std::complex<double>>()).inverse() *
      B.cast<std::complex<double>>();
  const Eigen::MatrixXcd G = plant.G.frequency_response(s);
  // The printed numbers have seven digits.
  CHECK((G.row(0) - states.row(2)).norm() < 1e-6 * states.row(2).norm());
  CHECK((G.row(1) - states.row(0)).norm() < 1e-6 * states.row(0).norm());
  CHECK((G.row(2) - states.row(1)).norm() < 1e-6 * states.row(1).norm());
  CHECK(plant.G.is_integrating(0));
  CHECK_FALSE(plant.G.is_integrating(1));
}

TEST_CASE("the levels of the column balance its flows", "[catalogue]") {
  const PlantModel plant = benchmark_plant("column-levels");
  const Eigen::MatrixXd gain = plant.G.steady_gain();
  // Whatever is fed leaves as distillate or bottoms: the sum of both levels knows no reflux and no boilup.
  CHECK((gain.row(2) + gain.row(3))
            .isApprox(Eigen::RowVectorXd((Eigen::RowVectorXd(5) << 0, 0, -1, -1, 1).finished())));
  CHECK(gain(2, 0) == -1);
  CHECK(gain(2, 1) == 1);
  // By distillation_column(), in hundredths.
  CHECK((100.0 * gain.topLeftCorner(2, 2)).isApprox(benchmark_plant("distillation-column").G.static_gain()));
}

TEST_CASE("the made-up unit has channels along its diagonal only, each by its formula", "[catalogue]") {
  const PlantModel plant = benchmark_plant("banded-20x8");
  REQUIRE(plant.cvs.size() == 20);
  REQUIRE(plant.mvs.size() == 8);
  int channels = 0;
  for (Eigen::Index i = 0; i < 20; ++i)
    for (Eigen::Index j = 0; j < 8; ++j)
      channels += plant.G(i, j).is_zero() ? 0 : 1;
  CHECK(channels == 78);  // counted by hand from |1 + 7 (i - 1)/19 - j| < 2.2
  CHECK(plant.G(0, 7).is_zero());
  // i = j = 1: delta = 0, 3 i + 2 j = 5, 2 i + 5 j = 7, i + 3 j = 4.
  CHECK(plant.G(0, 0) == TransferFunction::first_order(2.0, 29.0, 1.0));
  // i = 20, j = 7: delta = 1, i + j = 27 is a multiple of 3, 3 i + 2 j = 74, 2 i + 5 j = 75, i + 3 j = 41.
  CHECK(plant.G(19, 6) == TransferFunction::first_order(-3.0 * std::exp(-0.8), 17.0, 4.0));
}

TEST_CASE("the coker interacts as figure 7.7 has it with MV2 and MV4 free", "[catalogue]") {
  const PlantModel plant = benchmark_plant("coker-12x7");
  REQUIRE(plant.cvs.size() == 12);
  REQUIRE(plant.mvs.size() == 7);
  REQUIRE(plant.mds.size() == 2);
  // Moves of MV2 and MV4 that bring CV11 and CV12 up by one, each with the other one held.
  const Eigen::MatrixXd gains = plant.G.static_gain();
  const Eigen::MatrixXd free = (Eigen::MatrixXd(12, 2) << gains.col(1), gains.col(3)).finished();
  const Eigen::MatrixXd answers = free * free.bottomRows(2).inverse();
  for (int cv = 0; cv < 12; ++cv) {
    CAPTURE(cv + 1);
    const bool in_range = cv < 10;
    const bool not_by_cv11 = cv == 5 || cv == 6 || cv == 8;
    const bool by_cv12 = cv < 4 || cv == 5;
    CHECK((answers(cv, 0) != 0.0) == (in_range ? !not_by_cv11 : cv == 10));
    CHECK((answers(cv, 1) != 0.0) == (in_range ? by_cv12 : cv == 11));
  }
  CHECK_FALSE(plant.G(10, 4).is_zero());  // the channel that is identified again
}

}  // namespace mpm
