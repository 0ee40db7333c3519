#include <catch2/catch.hpp>

#include "analysis/indicators/simulation_error.hpp"
#include "base/error.hpp"

namespace {

using namespace mpm;

TEST_CASE("simulation errors: norms of rows, whatever the signals have in common") {
  Eigen::MatrixXd y(2, 3), y_sim(2, 3);
  y << 1, 2, 3, 7, 7, 7;
  y_sim << 4, 2, 7, 7, 7, 7;
  CHECK(simulation_errors(y, y_sim) == Eigen::Vector2d(5, 0));
  CHECK(simulation_errors(y.array() + 9, y_sim.array() + 9) == Eigen::Vector2d(5, 0));
  CHECK_THROWS_AS(simulation_errors(y, y_sim.leftCols(2)), InputError);
}

}  // namespace
