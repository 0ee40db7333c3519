#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "scenarios/study/window_scan.hpp"

namespace {

mpm::WindowScan scan_of(int horizon, double shortest = 0.5, double longest = 2.0) {
  mpm::Study study;
  study.controller.prediction_horizon = horizon;
  study.diagnosis.shortest_window = shortest;
  study.diagnosis.longest_window = longest;
  return mpm::window_scan(study);
}

}  // namespace

TEST_CASE("the scan goes from half to twice the prediction horizon") {
  const auto check = [](int horizon, int shortest, int longest) {
    const mpm::WindowScan scan = scan_of(horizon);
    CHECK(scan.shortest == shortest);
    CHECK(scan.longest == longest);
    CHECK(scan.stride == 1);
    CHECK_NOTHROW(scan.validate());
  };
  check(11, 6, 22);   // section 5.3.1
  check(20, 10, 40);  // sections 5.3.2 and 5.3.3
  check(75, 38, 150);
  check(7, 4, 14);
  CHECK(scan_of(75).count() == 113);
  CHECK(mpm::WindowScan{10, 20, 3}.count() == 4);  // 10, 13, 16, 19
}

TEST_CASE("a scan of windows that say nothing, of none and of no stride is refused") {
  CHECK_THROWS_WITH(scan_of(6).validate(), "shortest window: found 3 samples; allowed: 4 or more");
  CHECK_THROWS_WITH(scan_of(20, 0.51, 0.54).validate(), Catch::Contains("longest window: found 10 samples"));
  CHECK_THROWS_WITH((mpm::WindowScan{4, 5, 0}.validate()), Catch::Contains("stride"));
}
