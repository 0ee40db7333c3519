#include <algorithm>
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

Rows found_in_measured(const std::vector<double>& values, double lower = -kInfinity,
                       double upper = kInfinity) {
  return implausible_rows(values, lower, upper, true);
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

TEST_CASE("a round value far from all others that comes again is no measurement", "[records]") {
  for (const double round : {1000.0, -1000.0, 100.0, -500.0}) {
    INFO(round);
    std::vector<double> values = sine(200);
    values[30] = values[31] = values[170] = round;
    CHECK(found_in_measured(values) == Rows{30, 31, 170});
    CHECK(found(values).empty());  // what operators write may be round
    CHECK(found_in_measured(values, -1e7, 1e7).empty());
    values[31] = values[170] = 0.5;
    CHECK(found_in_measured(values).empty());  // once: a spike, and a short one for its size
    for (std::size_t row = 60; row < 120; ++row)
      values[row] = round;
    CHECK(found_in_measured(values).size() == 61);
  }
  for (const double round : {2500.0, 99000.0, 1e6}) {  // so far away that even one of them is none
    INFO(round);
    std::vector<double> values = sine(200);
    values[30] = values[31] = values[170] = round;
    CHECK(found_in_measured(values) == Rows{30, 31, 170});
    CHECK(found_in_measured(values, -1e7, 1e7).empty());
  }
  for (const double other : {999.5, 1234.0, 42.0, 0.0}) {
    INFO(other);
    std::vector<double> values = sine(200, other == 0.0 ? 100.5 : 0.0);
    values[30] = values[31] = values[170] = other;
    CHECK(found_in_measured(values).empty());
  }
}

TEST_CASE("round values among others like them are measurements", "[records]") {
  std::vector<double> counts, levels, valve(200, 0.0), rounded = sine(400);
  for (std::size_t k = 0; k < 400; ++k)
    counts.push_back(100.0 * static_cast<double>(k % 37));  // all of them round
  CHECK(found_in_measured(counts).empty());
  for (std::size_t k = 0; k < 400; ++k)
    levels.push_back(k < 380 ? 1.0 : 500.0);  // a feed of two levels
  CHECK(found_in_measured(levels).empty());
  valve[7] = valve[8] = 100.0;
  CHECK(found_in_measured(valve).empty());
  for (double& value : rounded)
    value = std::round(100.0 * (7.0 + value));  // whole numbers, some of them round
  CHECK(found_in_measured(rounded).empty());
  std::vector<double> excursion = sine(400);
  for (std::size_t k = 0; k < 20; ++k)  // an instrument at its end, which it has come to step by step
    excursion[100 + k] = excursion[139 - k] = std::min(100.0, 10.0 * static_cast<double>(k));
  CHECK(found_in_measured(excursion).empty());
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
