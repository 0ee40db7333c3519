#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"

namespace mpm {
TEST_CASE("location margin: how much farther the first index is from 1 than the second") {
  const Eigen::Vector4d ivar_diag(1.5, 0.25, 4.0, 1.0);
  CHECK(location_margin(ivar_diag, LocationDistance::linear) == Approx(3.0 - 0.75));
  CHECK(location_margin(ivar_diag, LocationDistance::logarithmic) == Approx(0.0).margin(1e-15));
  CHECK(location_margin(Eigen::Vector3d(kNaN, 3.0, 1.5), LocationDistance::linear) == Approx(1.5));
}

TEST_CASE("location margin: one index has nothing beside it") {
  CHECK(std::isnan(location_margin(Eigen::Vector2d(kNaN, 3.0), LocationDistance::linear)));
}

TEST_CASE("source: by the threshold of I_MPM, and none where there is no I_MPM") {
  Study study = find_study("chapter6");
  study.assessment.of<ChainOptions>().mpm_threshold = 0.25;
  const DiagnosisChain chain(study);
  CHECK(chain.source_of({.i_mpm = 0.26}) == FaultSource::mpm);
  CHECK(chain.source_of({.i_mpm = 0.25}) == FaultSource::ud);
  CHECK(chain.source_of({.i_mpm = kNaN}) == FaultSource::none);
}

}  // namespace mpm
