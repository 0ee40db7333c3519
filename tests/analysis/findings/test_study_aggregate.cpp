#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/findings/study_aggregate.hpp"
#include "scenarios/study_library.hpp"
#include "tests/analysis/made_up_record.hpp"

namespace {

using namespace mpm;
using testing::made_up_record;

TEST_CASE("aggregate counts what was put in") {
  Study study = find_study("chapter6");
  study.aggregate.bootstrap_replications = 200;
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 8; ++i)
    records.push_back(made_up_record(i, ExperimentKind::mpm, i % 7, i < 6 ? 0.2 : 0.05));
  records.push_back(made_up_record(8, ExperimentKind::ud, 3, 0.05));
  records.back().diagnosis.predicted_cv = 4;
  records.push_back(made_up_record(9, ExperimentKind::mpm_ud, 2, 0.3));
  ExperimentRecord infeasible = made_up_record(10, ExperimentKind::ud, 1, 0.5);
  infeasible.status = ExperimentStatus::infeasible;
  infeasible.diagnosis = {};
  records.push_back(infeasible);
  ExperimentRecord failed = infeasible;
  failed.status = ExperimentStatus::failed;
  records.push_back(failed);

  const StudyAggregate total = aggregate(study, records);
  CHECK(total.experiments == 12);
  CHECK(total.failed == 1);
  CHECK(total.infeasible.hits == 1);
  CHECK(total.infeasible.total == 11);
  REQUIRE(total.kinds.size() == 3);
  const KindAggregate& mpm = total.kinds[0];
  CHECK(mpm.located.value == 1.0);
  CHECK(mpm.source_recognised.hits == 6);
  CHECK(mpm.source_recognised.total == 8);
  CHECK(mpm.regression.fit.slope == Approx(2.0));
  CHECK(mpm.regression.fit.r_squared == Approx(1.0));
  CHECK(mpm.i_mpm.mean == Approx((6 * 0.2 + 2 * 0.05) / 8));
  const KindAggregate& ud = total.kinds[1];
  CHECK(ud.located.hits == 0);
  CHECK(ud.confusion.counts()(3, 4) == 1);
  CHECK(ud.source_recognised.value == 1.0);
  CHECK(total.kinds[2].source_recognised.total == 0);  // both sources are true
  REQUIRE(total.dominance.size() == 4);
  CHECK(total.dominance[3].i_mpm.count == 1);
  CHECK(total.dominance[3].above_threshold.hits == 1);
}

TEST_CASE("non-impactful experiments count for nothing but the regression, unless the study says so") {
  Study study = find_study("chapter6");
  study.aggregate.bootstrap_replications = 200;
  std::vector<ExperimentRecord> records;
  for (int i = 0; i < 5; ++i) {
    records.push_back(made_up_record(i, ExperimentKind::mpm, i, 0.2));
    records.back().diagnosis.impactful = i < 2;
  }
  CHECK(aggregate(study, records).kinds[0].located.total == 2);
  CHECK(aggregate(study, records).kinds[0].source_recognised.total == 2);
  CHECK(aggregate(study, records).kinds[0].regression.fit.pairs == 35);
  study.diagnosis.source_population = SourcePopulation::feasible;
  CHECK(aggregate(study, records).kinds[0].source_recognised.total == 5);
}

TEST_CASE("summarise: t interval of the mean") {
  const SampleSummary summary = summarise({1.0, 2.0, 3.0, std::nan("")}, 0.95);
  CHECK(summary.count == 3);
  CHECK(summary.mean == Approx(2.0));
  // t(0.975, 2) = 4.302653 from tables; standard error 1/sqrt(3).
  CHECK(summary.mean_interval.upper == Approx(2.0 + 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(summarise({}, 0.95).count == 0);
  CHECK(std::isnan(summarise({1.0}, 0.95).mean_interval.lower));
}

TEST_CASE("farthest_from_one: linear and logarithmic distance, ties and NaN") {
  const Eigen::Vector3d indices(1.8, 0.4, 1.0);
  CHECK(farthest_from_one(indices, LocationDistance::linear) == 0);
  CHECK(farthest_from_one(indices, LocationDistance::logarithmic) == 1);
  CHECK(farthest_from_one(Eigen::Vector3d(1.0, 1.0, 1.0), LocationDistance::linear) == 0);
  CHECK(farthest_from_one(Eigen::Vector3d(std::nan(""), 1.1, 1.2), LocationDistance::linear) == 2);
  CHECK(farthest_from_one(Eigen::Vector2d::Constant(std::nan("")), LocationDistance::linear) == -1);
}

}  // namespace
