#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "tests/plants/plant_samples.hpp"

namespace mpm {
namespace {

TransferFunction lag(double gain, double dead_time) {
  return TransferFunction::first_order(gain, 10, dead_time);
}

}  // namespace

TEST_CASE("a new transfer matrix has no effect", "[transfer_matrix]") {
  const TransferMatrix G(3, 2);
  CHECK(G.rows() == 3);
  CHECK(G.cols() == 2);
  CHECK(G.static_gain() == Eigen::MatrixXd::Zero(3, 2));
  CHECK(TransferMatrix().rows() == 0);
  CHECK(TransferMatrix().cols() == 0);
}

TEST_CASE("channels keep their place", "[transfer_matrix]") {
  TransferMatrix G{{lag(1, 0), lag(2, 1), lag(3, 2)}, {lag(4, 3), lag(5, 4), lag(6, 5)}};
  CHECK(G.static_gain() == (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  G(1, 0) = lag(-7, 9);
  CHECK(G(1, 0).dead_time() == 9);
  CHECK(G.static_gain() == (Eigen::MatrixXd(2, 3) << 1, 2, 3, -7, 5, 6).finished());
}

TEST_CASE("the frequency response is that of each channel", "[transfer_matrix]") {
  const TransferMatrix G = samples::mixed_matrix();
  const std::complex<double> s(0.01, 0.3);
  const Eigen::MatrixXcd response = G.frequency_response(s);
  REQUIRE(response.rows() == 4);
  REQUIRE(response.cols() == 4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      CHECK(response(i, j) == G(i, j)(s));
    }
  }
}

TEST_CASE("bad transfer matrices are refused", "[transfer_matrix]") {
  CHECK_THROWS_AS(TransferMatrix(-1, 2), InputError);
  CHECK_THROWS_AS(TransferMatrix(2, -1), InputError);
  CHECK_THROWS_AS((TransferMatrix{{lag(1, 0), lag(2, 0)}, {lag(3, 0)}}), InputError);

  TransferMatrix G(2, 3);
  const TransferMatrix& constant = G;
  CHECK_THROWS_AS(G(2, 0), InputError);
  CHECK_THROWS_AS(G(0, 3), InputError);
  CHECK_THROWS_AS(constant(-1, 0), InputError);
  CHECK_THROWS_AS(constant(0, -1), InputError);
}

TEST_CASE("the static gain names an integrating channel", "[transfer_matrix]") {
  TransferMatrix G(2, 3);
  G(1, 2) = TransferFunction(samples::polynomial({1}), samples::polynomial({1, 0}));
  CHECK_THROWS_AS(G.static_gain(), InputError);
  CHECK_THROWS_WITH(G.static_gain(), Catch::Contains("(1, 2)"));
}

}  // namespace mpm
