#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "results/records/implausible_values.hpp"

// What no instrument has measured is found, and nothing that one can measure.

namespace mpm {
namespace {

using Rows = std::vector<std::size_t>;

std::vector<double> sine(std::size_t count, double level = 0.0) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k)
    values.push_back(level + std::sin(0.1 * static_cast<double>(k)));
  return values;
}

Rows found(const std::vector<double>& values, double lower = -kInfinity, double upper = kInfinity) {
  return implausible_rows(values, lower, upper);
}

TEST_CASE("fillers are no measurements, however many there are", "[records]") {
  for (const double filler : {-9999.0, 999.0, -999.25, 32767.0, -2147483648.0, 1e20, 9.96921e36, -1.7e308}) {
    INFO(filler);
    std::vector<double> values = sine(200);
    Rows rows;
    for (std::size_t row = 3; row < 80; row += 2) {
      values[row] = filler;
      rows.push_back(row);
    }
    values[4] = kNaN;
    CHECK(found(values) == rows);
  }
  std::vector<double> both = sine(200);
  both[0] = -9999.0;
  both[199] = 9999.0;
  CHECK(found(both) == Rows{0, 199});
}

TEST_CASE("a filler among values like it is a measurement", "[records]") {
  std::vector<double> values = sine(200, 998.0);
  values[7] = 999.0;
  CHECK(found(values).empty());
  CHECK(found({999.0, 9999.0, 999.0}).empty());  // nothing else to hold them against
  std::vector<double> of_valve(100, 0.0);
  of_valve[50] = -9999.0;
  CHECK(found(of_valve) == Rows{50});
  CHECK(found(of_valve, -10000.0, 10000.0).empty());  // within its hard limits
}

TEST_CASE("a short spike far from all others is no measurement, a step is one", "[records]") {
  std::vector<double> values = sine(400);
  values[100] = values[101] = 5000.0;
  values[200] = -5000.0;
  CHECK(found(values) == Rows{100, 101, 200});
  for (std::size_t row = 390; row < 400; ++row)  // the last samples: nobody knows what comes
    values[row] = 5000.0;
  CHECK(found(values) == Rows{100, 101, 200});
  std::vector<double> spiky = sine(400);
  spiky[100] = 100.0;  // a hundred times the amplitude
  CHECK(found(spiky).empty());
  std::vector<double> stepping(400, 0.0);
  stepping[200] = 1.0;
  CHECK(found(stepping).empty());
  std::vector<double> quiet = sine(400);
  for (double& value : quiet)
    value *= 1e-5;
  quiet[200] = 1.0;  // an MV at its hard limit
  CHECK(found(quiet, -1.0, 1.0).empty());
  CHECK(found(quiet) == Rows{200});
  CHECK(found({}).empty());
  CHECK(found({kNaN, 1.0}).empty());
}

}  // namespace
}  // namespace mpm
