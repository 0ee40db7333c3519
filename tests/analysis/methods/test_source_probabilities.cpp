#include <cmath>
#include <memory>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/random/random_stream.hpp"

// Probabilities that methods state of the sources of what is wrong, and how they are scored.

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

MethodDescription stating() {
  MethodDescription method;
  method.name = "mine";
  method.numbers = source_probability_numbers();
  return method;
}

std::string refusal(const Json& probabilities) {
  try {
    assessment_of({{"flagged", true}, {"probabilities", probabilities}}, find_study("wood-berry").plant,
                  stating(), "mine");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("probabilities come through the protocol, and what is none is refused", "[probabilities]") {
  const Study study = find_study("wood-berry");
  const MethodDescription method = stating();
  const Assessment said =
      assessment_of({{"flagged", true}, {"probabilities", {{"mpm", 0.75}, {"ud", 0.2}, {"none", 0.05}}}},
                    study.plant, method, "mine");
  const auto form = std::make_shared<const AssessmentForm>(method, study);
  const auto stated = stated_probabilities(kept(form, said));
  REQUIRE(stated);
  CHECK(*stated == SourceProbabilities{0.05, 0.75, 0.2, 0.0, 0.0});
  CHECK_FALSE(stated_probabilities(kept(form, Assessment{})));  // states nothing

  CHECK(refusal({{"mpm", 0.5}}).find("add up to 1") != std::string::npos);
  CHECK(refusal({{"mpm", 1.5}, {"ud", -0.5}}).find("numbers from 0 to 1") != std::string::npos);
  CHECK(refusal({{"valve", 1.0}}).find("none, mpm, ud, mpm_ud, other") != std::string::npos);
  CHECK(refusal("likely").find("an object") != std::string::npos);
  MethodDescription silent = stating();
  silent.numbers.clear();
  CHECK_THROWS_WITH(
      assessment_of({{"flagged", true}, {"probabilities", {{"mpm", 1.0}}}}, study.plant, silent, "mine"),
      Catch::Contains("does not say that it answers 'probabilities'"));
}

TEST_CASE("scores: certain and right is 0, certain and wrong is 1, and honesty pays", "[probabilities]") {
  const SourceProbabilities certain{0, 1, 0, 0, 0}, even{0.2, 0.2, 0.2, 0.2, 0.2};
  CHECK(log_score(certain, FaultSource::mpm) == 0.0);
  CHECK(log_score(certain, FaultSource::ud) == 1.0);
  CHECK(brier_score(certain, FaultSource::mpm) == 0.0);
  CHECK(brier_score(certain, FaultSource::ud) == 1.0);
  CHECK(log_score(even, FaultSource::other) == Approx(std::log(5.0) / std::log(1000.0)));
  CHECK(brier_score(even, FaultSource::other) == Approx(0.4));
  // Proper: the expected score is least for the probabilities that are true.
  const SourceProbabilities truth{0.5, 0.3, 0.1, 0.05, 0.05};
  const auto expected = [&truth](const SourceProbabilities& stated, auto score) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      sum += truth[i] * score(stated, static_cast<FaultSource>(i));
    return sum;
  };
  RandomStream stream(3, 0, StreamId::excitation);
  for (int k = 0; k < 200; ++k) {
    SourceProbabilities other = truth;
    for (double& p : other)
      p += 0.2 * stream.uniform();
    double sum = 0.0;
    for (const double p : other)
      sum += p;
    for (double& p : other)
      p /= sum;
    CHECK(expected(other, log_score) >= expected(truth, log_score));
    CHECK(expected(other, brier_score) >= expected(truth, brier_score));
  }
}

TEST_CASE("calibration: a method that is right as often as it says has no error", "[probabilities]") {
  Reliability honest, boasting;
  CHECK(std::isnan(honest.error()));
  RandomStream stream(4, 0, StreamId::excitation);
  for (int k = 0; k < 20000; ++k) {
    const FaultSource truth = stream.uniform() < 0.7 ? FaultSource::mpm : FaultSource::ud;
    honest.add({0, 0.7, 0.3, 0, 0}, truth);
    boasting.add({0, 0.95, 0.05, 0, 0}, truth);
  }
  CHECK(honest.error() < 0.01);  // a standard deviation of 0.003
  CHECK(boasting.error() == Approx(0.25).margin(0.01));
  CHECK(honest.bins()[7].count + honest.bins()[6].count == 20000);
}

}  // namespace mpm
