#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "analysis/methods/broken_promise.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/threshold_rule.hpp"
#include "analysis/study_files/study_library.hpp"

namespace mpm {
namespace {

using AnswerJson = nlohmann::ordered_json;

MethodDescription method_with_threshold() {
  MethodDescription method;
  method.name = "mine";
  method.locates_cvs = true;
  method.given_options = R"({"lags":3,"threshold":1.5})";
  method.fingerprint = "python3 mine.py, options " + method.given_options;
  return method;
}

/// What is refused of an answer; empty: nothing.
std::string refused_answer(const std::string& text, double threshold) {
  static const Study study = find_study("wood-berry");
  const MethodDescription method = method_with_threshold();
  const AnswerJson answer = AnswerJson::parse(text);
  try {
    require_threshold_rule(answer, assessment_of(answer, study.plant, method, "method"), method, threshold,
                           "rule");
    return "";
  } catch (const BrokenPromise& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("threshold rule: flags follow the scores and the threshold of now, and nothing else changes") {
  Study study = find_study("wood-berry");
  study.monitoring = {.window = 200, .stride = 100};
  const MethodDescription method = method_with_threshold();
  const auto form = std::make_shared<const AssessmentForm>(method, study);
  Assessment said;
  said.flagged = true;
  said.score = 2.0;
  said.cvs = {{.flagged = false, .score = 1.25}, {}};
  AssessmentRecord before = kept(form, said);
  Assessment of_window;
  of_window.score = 1.3;
  add_window(before, 1, of_window);
  for (const auto& [threshold, loop, cv, window] : {std::tuple(1.5, true, 0.0, 0.0),
                                                    {1.25, true, 0.0, 1.0},
                                                    {1.0, true, 1.0, 1.0},
                                                    {2.0, false, 0.0, 0.0}}) {
    AssessmentRecord now = before;
    flag_anew(now, threshold);
    CAPTURE(threshold);
    CHECK(now.flagged == loop);
    CHECK(now.number("cv_flagged", 0) == cv);
    CHECK(std::isnan(now.number("cv_flagged", 1)));
    CHECK(now.number("window_flagged", 0, 1) == window);
    CHECK(std::isnan(now.number("window_flagged", 0, 0)));
    CHECK(now.score == before.score);
    CHECK(now.number("cv_score", 0) == 1.25);
    CHECK(now.predicted_cv == before.predicted_cv);
  }
}

TEST_CASE("threshold rule: the threshold is one of the options") {
  CHECK(threshold_in(R"({"lags":3,"threshold":1.5})", "threshold") == 1.5);
  CHECK(threshold_in(R"({"lags":3,"threshold":1.5})", "lags") == 3.0);
}

TEST_CASE("threshold rule: the fingerprint without the threshold is that of every threshold") {
  MethodDescription one = method_with_threshold(), other = one;
  other.given_options = R"({"lags":3,"threshold":9.0})";
  other.fingerprint = "python3 mine.py, options " + other.given_options;
  CHECK(fingerprint_without("threshold", one) == fingerprint_without("threshold", other));
  other.given_options = R"({"lags":4,"threshold":9.0})";
  other.fingerprint = "python3 mine.py, options " + other.given_options;
  CHECK(fingerprint_without("threshold", one) != fingerprint_without("threshold", other));
}

TEST_CASE("threshold rule: an answer that contradicts it is refused") {
  const std::string whole =
      R"({"flagged": true, "score": 2.0, "cv_flagged": [true, null], "cv_score": [2.0, null]})";
  CHECK(refused_answer(whole, 1.5).empty());
  CHECK(refused_answer(R"({"error": "no"})", 1.5).empty());
  CHECK_THAT(refused_answer(whole, 2.0),
             Catch::Contains("flagged = true with a score of 2 and a threshold of 2"));
  CHECK_THAT(
      refused_answer(R"({"flagged": true, "score": 2, "cv_flagged": [true, true], "cv_score": [2, 1]})", 1.5),
      Catch::Contains("cv_flagged = true with a score of 1"));
  for (const char* const without :
       {R"({"flagged": true, "cv": "xD"})", R"({"flagged": true, "score": 2, "cv_flagged": [true, false]})",
        R"({"flagged": true, "score": 2, "cv_flagged": [true, false], "cv_score": [2, null]})"})
    CHECK_THAT(refused_answer(without, 0.5), Catch::Contains("an answer without a score"));
  CHECK_THAT(refused_answer(R"({"flagged": true, "score": 2})", 1.5), Catch::Contains("names no CV"));
  MethodDescription method = method_with_threshold();
  CHECK_NOTHROW(require_threshold_rule(method, "rule"));
  method.tells_sources = true;
  CHECK_THROWS_AS(require_threshold_rule(method, "rule"), BrokenPromise);
}

}  // namespace mpm
