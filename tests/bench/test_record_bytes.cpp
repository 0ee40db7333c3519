#include <cmath>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "bench/record_bytes.hpp"

namespace {

using namespace mpm;

TEST_CASE("record bytes: there and back, whatever is in the record") {
  ExperimentRecord record;
  record.draw = {17, ExperimentKind::mpm_ud, {{1, 2, MismatchParameter::dead_time, -1.5}}, {{1, 3, 4}}};
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
  CHECK(again.draw.mismatches.front().value == -1.5);
  CHECK(again.perturbed.damping == record.perturbed.damping);
  CHECK(again.loop->y_sim == record.loop->y_sim);
  record.draw.disturbances.clear();
  record.loop.reset();
  CHECK_FALSE(record_from_bytes(to_bytes(record)).draw.disturbances.size() == 1);
}

TEST_CASE("record bytes: everything of a named scenario") {
  ExperimentRecord record;
  const TransferFunction G(Eigen::Vector2d(2, 1), Eigen::Vector3d(30, 12, 1), 4);
  record.draw = {1,
                 ExperimentKind::mpm_ud,
                 {{1, 2, MismatchParameter::gain, 1.5}, {0, 4, MismatchParameter::channel, 0.0, G}},
                 {{1, 3, 4, DisturbanceModel::first_order, {}, Sine{0.5, 6}},
                  {0, 0, 0, DisturbanceModel::transfer_function, G, Ramp{7, 8}},
                  {0, 0, 0, DisturbanceModel::direct, {}, StepSequence{{{1, 2.0}, {3, 4.0}}}},
                  {2, 1, 1, DisturbanceModel::first_order, {}, WhiteNoise{0.25, 3}}},
                 true,
                 {{0, 2}},
                 {{"cd1", 7.86}}};
  record.draw.disturbances[2].inner_input = 7;
  record.diagnosis.cvs = {{true, ExperimentKind::ud, {}, {}, 0.5}, {}};
  record.diagnosis.cvs[1].distribution.means.dkts.co = 0.75;
  record.diagnosis.cvs[1].distribution.scatter_diag.skn.pairs = 7;
  record.diagnosis.cvs[1].acf.origin = ErrorOrigin::both;
  record.diagnosis.cvs[1].acf.y0.values = Eigen::Vector2d(1.0, 0.5);
  const std::string bytes = to_bytes(record);
  const ExperimentRecord again = record_from_bytes(bytes);
  CHECK(to_bytes(again) == bytes);
  CHECK(again.draw.named);
  CHECK(again.draw.affected_cvs == std::vector<Eigen::Index>{0, 2});
  REQUIRE(again.draw.parameters.size() == 1);
  CHECK(again.draw.parameters[0].name == "cd1");
  CHECK(again.draw.parameters[0].value == 7.86);
  CHECK(again.draw.disturbances[2].inner_input == 7);
  CHECK_FALSE(again.draw.disturbances[1].inner_input.has_value());
  CHECK(again.draw.mismatches[0].input == 2);
  CHECK(again.draw.mismatches[0].value == 1.5);
  REQUIRE(again.draw.mismatches[1].channel.has_value());
  CHECK(again.draw.mismatches[1].channel->numerator() == Eigen::Vector2d(2, 1));
  CHECK(again.draw.mismatches[1].channel->dead_time() == 4);
  CHECK_FALSE(again.draw.disturbances[0].Gd.has_value());
  // Member by member: a member that is forgotten in both directions would leave the bytes the same.
  const std::vector<Disturbance>& disturbances = again.draw.disturbances;
  CHECK(disturbances[0].time_constant == 4);
  CHECK(disturbances[2].model == DisturbanceModel::direct);
  const auto sine = std::get<Sine>(disturbances[0].signal);
  CHECK((sine.amplitude == 0.5 && sine.period == 6));
  const auto ramp = std::get<Ramp>(disturbances[1].signal);
  CHECK((ramp.slope == 7 && ramp.start == 8));
  const auto step = std::get<StepSequence>(disturbances[2].signal).steps.at(1);
  CHECK((step.sample == 3 && step.level == 4.0));
  const auto noise = std::get<WhiteNoise>(disturbances[3].signal);
  CHECK((noise.factor == 0.25 && noise.hold == 3));
  CHECK(again.diagnosis.cvs[0].flagged);
  CHECK(again.diagnosis.cvs[0].source == ExperimentKind::ud);
  CHECK(again.diagnosis.cvs[0].sse == 0.5);
  CHECK(again.diagnosis.cvs[1].distribution.mpm.co_dkts == 0.75);
  CHECK(again.diagnosis.cvs[1].distribution.scatter_diag.skn.pairs == 7);
  CHECK(again.diagnosis.cvs[1].acf.origin == ErrorOrigin::both);
  CHECK(again.diagnosis.cvs[1].acf.y0.values == Eigen::Vector2d(1.0, 0.5));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(record_from_bytes(std::string_view(bytes).substr(0, size)), std::runtime_error);
}

TEST_CASE("record bytes: a changed tuning") {
  ExperimentRecord record;
  record.draw.kind = ExperimentKind::tuning;
  record.draw.tuning = TuningChange{TuningParameter::slack_weight, 6, 0.07};
  const std::string bytes = to_bytes(record);
  const ExperimentRecord again = record_from_bytes(bytes);
  CHECK(to_bytes(again) == bytes);
  CHECK(again.draw.kind == ExperimentKind::tuning);
  CHECK(again.draw.tuning == record.draw.tuning);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(record_from_bytes(std::string_view(bytes).substr(0, size)), std::runtime_error);
}

TEST_CASE("record bytes: cut or lengthened bytes are refused") {
  const std::string bytes = to_bytes(ExperimentRecord{});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(record_from_bytes(std::string_view(bytes).substr(0, size)), std::runtime_error);
  CHECK_THROWS_AS(record_from_bytes(bytes + "x"), std::runtime_error);
}

}  // namespace
