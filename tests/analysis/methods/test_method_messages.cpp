#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"

// What methods from outside are told and what they answer: docs/bring_your_own.md.

namespace mpm {
namespace {

using MessageJson = nlohmann::ordered_json;

const PlantModel& seven_by_three() {
  static const Study study = find_study("chapter6");
  return study.plant;
}

/// A method that answers everything, with a number of each scope that it can have.
MethodDescription answering_all() {
  MethodDescription method;
  method.name = "mine";
  method.locates_cvs = method.tells_sources = method.names_channels = method.names_mismatches =
      method.names_candidates = true;
  method.numbers = {
      {"total", NumberScope::loop, ""}, {"each", NumberScope::cv, ""}, {"gain", NumberScope::channel, ""}};
  return method;
}

Assessment answer_of(const std::string& text, const MethodDescription& method = answering_all()) {
  return assessment_of(MessageJson::parse(text), seven_by_three(), method, "method 'mine'");
}

std::string message_refusal(const std::string& text, const MethodDescription& method = answering_all()) {
  try {
    answer_of(text, method);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("method messages: a loop is a list of samples for each row, null where one is missing") {
  AssessedLoop loop;
  loop.y = Eigen::MatrixXd{{1.0, kNaN, 3.0}, {4.0, 5.0, 6.0}};
  loop.u = Eigen::MatrixXd{{0.5, 0.25, 0.1}};
  const MessageJson json = MessageJson::parse(loop_json(loop).dump());
  CHECK(json.at("y") == MessageJson::parse("[[1.0, null, 3.0], [4.0, 5.0, 6.0]]"));
  CHECK(json.at("u")[0][2] == 0.1);  // every digit that it takes
  CHECK(json.at("candidates") == MessageJson::array());
  CHECK_FALSE(json.contains("whole"));

  const AssessedLoop window = [&] {
    AssessedLoop part;
    part.y = loop.y.rightCols(2);
    part.whole = &loop;
    part.first = 1;
    return part;
  }();
  const MessageJson of_window = loop_json(window);
  CHECK(of_window.at("first") == 1);
  CHECK(of_window.at("whole").at("y")[1].size() == 3);
}

TEST_CASE("method messages: a loop as numbers row by row, NaN where one is missing or not finite") {
  AssessedLoop loop;
  loop.y = Eigen::MatrixXd{{1.0, kNaN, -2.5}, {kInfinity, 0.1, -0.0}};
  const MessageJson json = loop_json(window_of(loop, 0, 3), SignalForm::base64);
  CHECK(json.at("y") ==
        MessageJson(
            {{"rows", 2}, {"base64", "AAAAAAAA8D8AAAAAAAD4fwAAAAAAAATAAAAAAAAA+H+amZmZmZm5PwAAAAAAAACA"}}));
  CHECK(json.at("candidates") == MessageJson({{"rows", 0}, {"base64", ""}}));
  CHECK(json.at("whole").at("y") == json.at("y"));
}

TEST_CASE("method messages: what a method of this program says is an answer that means the same") {
  Assessment said;
  said.flagged = true;
  said.score = kInfinity;
  said.cvs.resize(7);
  said.cvs[1] = {.flagged = true, .score = 2.5, .source = FaultSource::mpm};
  said.cvs[4] = {.flagged = false, .score = -0.5};
  said.flagged_channels = {{1, 2}, {3, 0}};
  said.named_mismatch = {
      .channel = {1, 2}, .parameter = MismatchParameter::dead_time, .size = 2.0, .upper = kInfinity};
  said.named_candidate = 2;
  said.numbers = {{"total", 7.0}, {"each", 3.0, 2}, {"gain", 0.25, 6, 1}};
  const PlantModel& plant = seven_by_three();
  const MessageJson json = answer_json(said, plant, answering_all());
  const Assessment read = assessment_of(MessageJson::parse(json.dump()), plant, answering_all(), "here");
  CHECK((read.flagged && read.score == kInfinity));
  for (std::size_t cv = 0; cv < 7; ++cv) {
    CHECK(read.cvs[cv].flagged == said.cvs[cv].flagged);
    if (said.cvs[cv].flagged)
      CHECK(read.cvs[cv].score == said.cvs[cv].score);
    CHECK(read.cvs[cv].source == said.cvs[cv].source);
  }
  CHECK(read.flagged_channels == said.flagged_channels);
  CHECK(read.named_mismatch->channel == said.named_mismatch->channel);
  CHECK(read.named_mismatch->parameter == said.named_mismatch->parameter);
  CHECK((read.named_mismatch->size == 2.0 && read.named_mismatch->upper == kInfinity));
  CHECK(std::isnan(read.named_mismatch->lower));
  CHECK(read.named_candidate == said.named_candidate);
  CHECK(read.number("total") == 7.0);
  CHECK(read.number("each", 2) == 3.0);
  CHECK(std::isnan(read.number("each", 3)));
  CHECK(read.number("gain", 6, 1) == 0.25);

  for (const Assessment& none :
       {Assessment::not_applicable("no setpoints"), Assessment::failed("singular")}) {
    const Assessment again = assessment_of(answer_json(none, plant, answering_all()), plant, {}, "here");
    CHECK(again.status == none.status);
    CHECK(again.reason == none.reason);
  }
  // A method that says nothing of CVs or channels.
  CHECK(answer_json(said, plant, {}).dump() ==
        R"({"flagged":true,"score":"Infinity","mismatch":{"channel":["y2","u3"],"parameter":"dead_time",)"
        R"("size":2.0,"lower":null,"upper":"Infinity"},"candidate":3,"numbers":{}})");
}

TEST_CASE("method messages: an answer with everything comes to its places") {
  const Assessment said = answer_of(R"({"flagged": true, "score": 2.5, "cv": "y2", "source": "other",
      "channels": [["y1", "u2"]], "candidate": 3,
      "mismatch": {"channel": ["y3", "u1"], "parameter": "dead_time", "size": 2, "upper": "Infinity"},
      "numbers": {"total": 7, "each": [1, 2, 3, 4, 5, 6, null],
                  "gain": [[1, 2, 3], [4, 5, 6], [7, 8, 9], [1, 2, 3], [4, 5, 6], [7, 8, 9], [0, 0, 0]]}})");
  CHECK((said.flagged && said.score == 2.5 && *said.worst_cv() == 1));
  CHECK(said.cvs[1].source == FaultSource::other);
  CHECK_FALSE(said.cvs[0].flagged.has_value());
  CHECK(said.flagged_channels == std::vector<Channel>{{0, 1}});
  CHECK(*said.named_candidate == 2);
  CHECK(said.named_mismatch->channel == Channel{2, 0});
  CHECK(said.named_mismatch->parameter == MismatchParameter::dead_time);
  CHECK((said.named_mismatch->size == 2.0 && said.named_mismatch->upper == kInfinity));
  CHECK(std::isnan(said.named_mismatch->lower));
  CHECK(said.number("total") == 7.0);
  CHECK(said.number("each", 5) == 6.0);
  CHECK(std::isnan(said.number("each", 6)));
  CHECK(said.number("gain", 1, 2) == 6.0);
}

TEST_CASE("method messages: what an answer leaves out") {
  CHECK(answer_of(R"({"flagged": true})").score == 1.0);
  CHECK(answer_of(R"({"flagged": false, "score": null})").score == 0.0);
  CHECK(answer_of(R"({"flagged": true, "score": "-Infinity"})").score == -kInfinity);
  const Assessment by_cv =
      answer_of(R"({"flagged": true, "cv_flagged": [true, false, null, null, null, null, null],
      "cv_source": ["ud", null, null, null, null, null, null]})");
  CHECK((*by_cv.cvs[0].flagged && by_cv.cvs[0].score == 1.0 && by_cv.cvs[0].source == FaultSource::ud));
  CHECK((!*by_cv.cvs[1].flagged && by_cv.cvs[1].score == 0.0));
  CHECK_FALSE(by_cv.cvs[2].flagged.has_value());
  const Assessment failed = answer_of(R"({"error": "too short"})");
  CHECK((failed.status == AssessmentStatus::failed && failed.reason == "too short"));
  CHECK(answer_of(R"({"not_applicable": "no"})").status == AssessmentStatus::not_applicable);
}

TEST_CASE("method messages: what is no answer is refused by its key") {
  using Catch::StartsWith;
  const auto flagged_with = [](const std::string& rest) {
    return message_refusal(fmt::format("{{\"flagged\": true, {}}}", rest));
  };
  CHECK_THAT(message_refusal("[1]"), StartsWith("method 'mine': answer: found [1]; allowed: a JSON object"));
  CHECK_THAT(message_refusal("{}"), StartsWith("method 'mine': flagged: found null; allowed: true, false"));
  CHECK_THAT(message_refusal(R"({"flagged": 1})"), StartsWith("method 'mine': flagged: found 1; allowed:"));
  CHECK_THAT(message_refusal(R"({"error": 3})"),
             StartsWith("method 'mine': error: found 3; allowed: a text"));
  CHECK_THAT(flagged_with(R"("tea": 1)"),
             StartsWith("method 'mine': found the unknown key 'tea'; allowed: flagged"));
  CHECK_THAT(flagged_with(R"("score": "high")"),
             StartsWith("method 'mine': score: found \"high\"; allowed: a number"));
  CHECK_THAT(flagged_with(R"("cv": "y9")"), StartsWith("method 'mine': cv: found \"y9\"; allowed: y1, y2"));
  CHECK_THAT(flagged_with(R"("cv": 1)"), StartsWith("method 'mine': cv: found 1; allowed: y1, y2"));
  CHECK_THAT(flagged_with(R"("cv": "y1", "source": "tea")"),
             StartsWith("method 'mine': source: found \"tea\"; allowed: none, mpm, ud, mpm_ud, other"));
  CHECK_THAT(flagged_with(R"("source": "ud")"),
             StartsWith("method 'mine': source: found \"ud\"; allowed: none, or"));
  CHECK(flagged_with(R"("source": "none")") == "accepted");
  CHECK_THAT(flagged_with(R"("cv_flagged": [true])"),
             StartsWith("method 'mine': cv_flagged: found [true]; allowed: a list of 7"));
  CHECK_THAT(flagged_with(R"("cv_flagged": [1, 0, 0, 0, 0, 0, 0])"),
             StartsWith("method 'mine': cv_flagged: found 1; allowed: true"));
  CHECK_THAT(flagged_with(R"("channels": "y1/u1")"),
             StartsWith("method 'mine': channels: found \"y1/u1\"; allowed: a list of"));
  CHECK_THAT(flagged_with(R"("channels": [["y1"]])"),
             StartsWith("method 'mine': channels: found [\"y1\"]; allowed: a list of 2"));
  CHECK_THAT(flagged_with(R"("mismatch": {"channel": ["y1", "u1"]})"),
             StartsWith("method 'mine': mismatch: found {"));
  CHECK_THAT(
      flagged_with(R"("mismatch": {"channel": ["y1", "u1"], "parameter": "gain", "hue": 1})"),
      StartsWith(
          "method 'mine': found the unknown key 'hue'; allowed: channel, parameter, size, lower, upper"));
  CHECK_THAT(flagged_with(R"("candidate": 0)"),
             StartsWith("method 'mine': candidate: found 0; allowed: the number of"));
  CHECK_THAT(flagged_with(R"("candidate": 1.5)"),
             StartsWith("method 'mine': candidate: found 1.5; allowed: the number"));
  CHECK_THAT(flagged_with(R"("numbers": {"tea": 1})"),
             StartsWith("method 'mine': found the number 'tea'; allowed: numbers that"));
  CHECK_THAT(flagged_with(R"("numbers": {"each": [1]})"),
             StartsWith("method 'mine': each: found [1]; allowed: a list of 7"));
}

TEST_CASE("method messages: what the description does not announce is refused") {
  MethodDescription plain;
  plain.name = "mine";
  for (const auto& [key, value, word] :
       {std::tuple{"cv", "\"y1\"", "cv"}, std::tuple{"cv_flagged", "[]", "cv"},
        std::tuple{"source", "\"mpm\"", "source"}, std::tuple{"channels", "[]", "channel"},
        std::tuple{"mismatch", "{}", "mismatch"}, std::tuple{"candidate", "1", "candidate"}}) {
    const std::string said =
        message_refusal(fmt::format("{{\"flagged\": true, \"{}\": {}}}", key, value), plain);
    CHECK_THAT(said, Catch::StartsWith(fmt::format("method 'mine': {}: found", key)));
    CHECK_THAT(said,
               Catch::EndsWith(fmt::format("nothing: the method does not say that it answers '{}'", word)));
  }
}

TEST_CASE("method messages: another fault is told with what it is about, and comes back", "[confusions]") {
  const MethodDescription method = answering_all();
  for (const ToldSource told : enumerators<ToldSource>()) {
    const Assessment said =
        answer_of(fmt::format(R"({{"flagged": true, "cv": "y1", "source": "{}"}})", to_string(told)));
    INFO(to_string(told));
    CHECK(said.cvs[0].source == source_of(told));
    CHECK(told_source(said.cvs[0].source, said.cvs[0].about) == told);
    const MessageJson json = answer_json(said, seven_by_three(), method);
    CHECK(json.at("cv_source")[0] == to_string(told));
    const Assessment again = assessment_of(json, seven_by_three(), method, "method 'mine'");
    CHECK(told_source(again.cvs[0].source, again.cvs[0].about) == told);
    const auto form = assessment_forms(find_study("chapter6"), {"likelihood"}).front();
    CHECK(kept(form, said).told() == told);
    const auto of_old_archive = std::make_shared<const AssessmentForm>(method, find_study("chapter6"));
    CHECK(kept(of_old_archive, said).told() == told_source(source_of(told)));
  }
  CHECK(message_refusal(R"({"flagged": true, "cv": "y1", "source": "pump"})")
            .find("none, mpm, ud, mpm_ud, other, sensor, valve, data") != std::string::npos);
}

}  // namespace mpm
