#include <string>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "tests/solvers/p1_controller.hpp"

// Every refusal of the controller's options, by the quantity it has to name.

namespace mpm {
namespace {

template <typename Spoil>
std::string refusal(Spoil spoil) {
  MpcOptions options = samples::p1_options();
  spoil(options);
  try {
    options.validate(7, 3, 2);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Catch::StartsWith;
using Options = MpcOptions;

}  // namespace

TEST_CASE("the options of table 6.2 pass", "[options]") {
  CHECK(refusal([](Options&) {}).empty());
  CHECK(refusal([](Options& o) { o.control_horizon = o.prediction_horizon; }).empty());
  CHECK(refusal([](Options& o) { o.mv_cost.setZero(); }).empty());
  CHECK(refusal([](Options& o) { o.move_suppression.setZero(); }).empty());
  CHECK(refusal([](Options& o) { o.target_weight.setZero(); }).empty());
  CHECK(refusal([](Options& o) { o.cv_soft = Limits::none(7); }).empty());
  CHECK(refusal([](Options& o) { o.mv_hard.lower = o.mv_hard.upper; }).empty());  // MVs out of service
}

TEST_CASE("a sample time that is none is refused", "[options]") {
  for (const double bad : {0.0, -4.0, kNaN, kInfinity})
    CHECK_THAT(refusal([bad](Options& o) { o.sample_time = bad; }), StartsWith("sample_time"));
}

TEST_CASE("horizons out of range are refused", "[options]") {
  CHECK_THAT(refusal([](Options& o) { o.prediction_horizon = 0; }), StartsWith("prediction_horizon"));
  CHECK_THAT(refusal([](Options& o) { o.control_horizon = 0; }), StartsWith("control_horizon"));
  CHECK_THAT(refusal([](Options& o) { o.control_horizon = 76; }), StartsWith("control_horizon"));
}

TEST_CASE("weights of the wrong size or sign are refused", "[options]") {
  CHECK_THAT(refusal([](Options& o) { o.move_suppression.setOnes(2); }), StartsWith("move_suppression"));
  CHECK_THAT(refusal([](Options& o) { o.target_weight.setOnes(7); }), StartsWith("target_weight"));
  CHECK_THAT(refusal([](Options& o) { o.slack_weight.setOnes(3); }), StartsWith("slack_weight"));
  for (const double bad : {-1.0, kNaN, kInfinity}) {
    CHECK_THAT(refusal([bad](Options& o) { o.move_suppression(2) = bad; }),
               StartsWith("move_suppression[2]"));
    CHECK_THAT(refusal([bad](Options& o) { o.target_weight(1) = bad; }), StartsWith("target_weight[1]"));
    CHECK_THAT(refusal([bad](Options& o) { o.slack_weight(6) = bad; }), StartsWith("slack_weight[6]"));
  }
  CHECK_THAT(refusal([](Options& o) { o.slack_weight(0) = 0; }), StartsWith("slack_weight[0]"));
}

TEST_CASE("an MV without any weight is refused", "[options]") {
  CHECK_THAT(refusal([](Options& o) { o.move_suppression(1) = o.target_weight(1) = 0; }),
             StartsWith("move_suppression[1] and target_weight[1]"));
}

TEST_CASE("limits of the wrong size or order are refused", "[options]") {
  CHECK_THAT(refusal([](Options& o) { o.mv_hard = Limits::none(2); }), StartsWith("mv_hard"));
  CHECK_THAT(refusal([](Options& o) { o.cv_hard = Limits::none(3); }), StartsWith("cv_hard"));
  CHECK_THAT(refusal([](Options& o) { o.cv_soft = Limits::none(8); }), StartsWith("cv_soft"));
  CHECK_THAT(refusal([](Options& o) { o.cv_soft.upper.setOnes(3); }), StartsWith("cv_soft"));
  CHECK_THAT(refusal([](Options& o) { o.mv_hard.lower(1) = 0.6; }), StartsWith("mv_hard[1]"));
  CHECK_THAT(refusal([](Options& o) { o.cv_hard.upper(6) = kNaN; }), StartsWith("cv_hard[6]"));
  CHECK_THAT(refusal([](Options& o) { o.cv_soft.lower(2) = kNaN; }), StartsWith("cv_soft[2]"));
  CHECK_THAT(refusal([](Options& o) { o.cv_soft.upper(2) = -kInfinity; }), StartsWith("cv_soft[2]"));
  CHECK_THAT(refusal([](Options& o) { o.cv_hard.lower(0) = o.cv_hard.upper(0) = kInfinity; }),
             StartsWith("cv_hard[0]"));
}

TEST_CASE("costs that are no numbers are refused", "[options]") {
  CHECK_THAT(refusal([](Options& o) { o.mv_cost.setOnes(4); }), StartsWith("mv_cost"));
  for (const double bad : {kNaN, kInfinity})
    CHECK_THAT(refusal([bad](Options& o) { o.mv_cost(0) = bad; }), StartsWith("mv_cost"));
  for (const double bad : {0.0, -1.0, kNaN, kInfinity})
    CHECK_THAT(refusal([bad](Options& o) { o.target_violation_cost = bad; }),
               StartsWith("target_violation_cost"));
  for (const double bad : {0.0, -1.0, kNaN})
    CHECK_THAT(refusal([bad](Options& o) { o.solver_time_limit = bad; }), StartsWith("solver_time_limit"));
}

TEST_CASE("the choices have names", "[options]") {
  CHECK(to_string(WeightConvention::direct) == "direct");
  CHECK(to_string(WeightConvention::squared) == "squared");
  CHECK(to_string(SlackForm::per_sample) == "per-sample");
  CHECK(to_string(SlackForm::per_cv) == "per-cv");
}

}  // namespace mpm
