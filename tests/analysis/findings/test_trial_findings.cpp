#include <cmath>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/findings/trial_findings.hpp"

namespace mpm {
namespace {

std::vector<double> scores_up_to(int count) {
  std::vector<double> scores(static_cast<std::size_t>(count));
  std::iota(scores.begin(), scores.end(), 1.0);
  return scores;
}

}  // namespace

TEST_CASE("thresholds of simulated records: conformal, and with few scores from an exponential tail") {
  CHECK(trial_threshold(scores_up_to(99)) == 98.0);
  CHECK(trial_threshold(scores_up_to(49)) == 49.0);
  // 7, 8, 9 and 10 lie 2.5 above the median in the mean.
  CHECK(trial_threshold(scores_up_to(10)) == Approx(10.0 + 2.5 * std::log(1.0 / (11.0 * 0.02))));
  CHECK(trial_threshold(scores_up_to(10), 0.2) == 9.0);
  CHECK(trial_threshold({3.0}) == 3.0);
  CHECK(trial_threshold({2.0, 2.0, 2.0}) == 2.0);
  CHECK(std::isnan(trial_threshold({})));
}

}  // namespace mpm
