#include <cmath>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "bench/record_bytes.hpp"

namespace {

using namespace mpm;

TEST_CASE("record bytes: there and back, whatever is in the record") {
  ExperimentRecord record;
  record.draw = {17, ExperimentKind::mpm_ud, Mismatch{1, 2, MismatchParameter::dead_time, -1.5},
                 Disturbance{1, 3, 4}};
  record.status = ExperimentStatus::ok;
  record.message = "text";
  record.diagnosis.ivar = Eigen::Vector3d(1.0, std::nan(""), INFINITY);
  record.diagnosis.predicted_cv = 2;
  record.perturbed = {Eigen::Vector3d(0.5, std::nan(""), 2.0), Eigen::Vector3d(1.0, 2.0, 3.0)};
  record.loop.emplace();
  record.loop->y_sim = Eigen::MatrixXd::Random(3, 5);
  record.loop->trajectory.samples_done = 5;
  const std::string bytes = to_bytes(record);
  const ExperimentRecord again = record_from_bytes(bytes);
  CHECK(to_bytes(again) == bytes);
  CHECK(again.draw.mismatch->value == -1.5);
  CHECK(again.perturbed.damping == record.perturbed.damping);
  CHECK(again.loop->y_sim == record.loop->y_sim);
  record.draw.disturbance.reset();
  record.loop.reset();
  CHECK_FALSE(record_from_bytes(to_bytes(record)).draw.disturbance.has_value());
}

TEST_CASE("record bytes: cut or lengthened bytes are refused") {
  const std::string bytes = to_bytes(ExperimentRecord{});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(record_from_bytes(std::string_view(bytes).substr(0, size)), std::runtime_error);
  CHECK_THROWS_AS(record_from_bytes(bytes + "x"), std::runtime_error);
}

}  // namespace
