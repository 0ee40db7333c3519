#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/standstill.hpp"
#include "base/non_finite.hpp"
#include "tests/analysis/signals.hpp"

namespace mpm {

TEST_CASE("standstill: the longest stretch of one value, over what is missing", "[standstill]") {
  Eigen::RowVectorXd values(9);
  values << 1.0, 1.0, 2.0, 2.0, kNaN, 2.0, 3.0, kNaN, 3.0;
  const Standstill longest = longest_standstill(values);
  CHECK((longest.first == 2 && longest.end == 6));
  CHECK(longest.chance == 1.0);  // two of four neighbours outside are equal: 9 (3/6)^2 is above 1
  values << 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0, 4.0, 5.0;
  CHECK(longest_standstill(values).chance == Approx(9.0 * std::pow(1.0 / 6.0, 4)));
  CHECK(longest_standstill(Eigen::RowVectorXd::Constant(4, kNaN)).length() == 0);
  CHECK(longest_standstill(Eigen::RowVectorXd::Constant(4, 7.0)).length() == 4);
}

TEST_CASE("standstill: chance does not freeze noise, also where it is rounded or held", "[standstill]") {
  constexpr Eigen::Index N = 600;
  Eigen::RowVectorXd noise = testing::white_noise(N, 3).transpose();
  const auto freezes = [](const Eigen::RowVectorXd& values) {
    const Standstill longest = longest_standstill(values);
    return is_frozen(longest, N);
  };
  Eigen::RowVectorXd rounded = (noise.array() / 0.5).round() * 0.5, held = noise;
  for (Eigen::Index k = 0; k < N; ++k)
    held(k) = noise(k / 80 * 80);  // an analysis every 80 samples
  CHECK_FALSE(freezes(noise));
  CHECK_FALSE(freezes(rounded));
  CHECK_FALSE(freezes(held));
  rounded.segment(200, 100).setConstant(rounded(200));
  noise.segment(200, 100).setConstant(noise(200));
  CHECK(freezes(rounded));
  CHECK(freezes(noise));
  CHECK_FALSE(is_long(longest_standstill(noise.head(250)), 600));
}

TEST_CASE("standstill: values kept in the place of bad ones are missing, rounded and held ones are not",
          "[standstill]") {
  constexpr Eigen::Index N = 600;
  const Eigen::RowVectorXd noise = testing::white_noise(N, 3).transpose();
  Eigen::RowVectorXd kept = noise, held = noise, frozen = noise;
  kept.segment(101, 4).setConstant(kept(100));
  kept.segment(401, 7).setConstant(kept(400));
  const Eigen::RowVectorXd left = without_standstills(kept);
  for (Eigen::Index k = 0; k < N; ++k)
    if ((k > 100 && k < 105) || (k > 400 && k < 408))
      CHECK(std::isnan(left(k)));
    else
      CHECK(left(k) == noise(k));
  for (Eigen::Index k = 0; k < N; ++k)
    held(k) = noise(k / 10 * 10);
  frozen.segment(200, 100).setConstant(frozen(200));
  for (const Eigen::RowVectorXd& values :
       {noise, held, frozen, Eigen::RowVectorXd((noise.array() / 0.5).round() * 0.5)})
    CHECK(without_standstills(values) == values);
  CHECK(without_standstills(Eigen::RowVectorXd::Constant(3, kNaN)).array().isNaN().all());
}

}  // namespace mpm
