#include <algorithm>
#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"

// An answer as it is kept: every number in its place, and back again by its name.

namespace mpm {
namespace {

/// The chapter 6 study with records of 20 samples: 7 CVs, 6 lags.
const Study& short_study() {
  static const Study study = [] {
    Study chapter6 = find_study("chapter6");
    chapter6.simulation.samples = 20;
    return chapter6;
  }();
  return study;
}

/// A method that tells everything, with a number of each scope.
MethodDescription talker() {
  MethodDescription method;
  method.name = "talker";
  method.locates_cvs = method.tells_sources = method.names_channels = true;
  method.numbers = {{"total", NumberScope::loop, "of the loop"},
                    {"each", NumberScope::cv, "of a CV"},
                    {"gain", NumberScope::channel, "of a channel"},
                    {"curve", NumberScope::cv_lag, "of a CV at a lag"}};
  return method;
}

std::shared_ptr<const AssessmentForm> form_of(const MethodDescription& method) {
  return std::make_shared<const AssessmentForm>(method, short_study());
}

std::vector<std::string> names_of(const AssessmentForm& form) {
  std::vector<std::string> names;
  for (const NumberPlace& place : form.places())
    names.push_back(place.info.name);
  return names;
}

}  // namespace

TEST_CASE("assessment form: what a method tells comes first, then its own numbers, in places side by side") {
  const auto form = form_of(talker());
  CHECK(names_of(*form) == std::vector<std::string>{"cv_flagged", "cv_score", "cv_source", "channel_flagged",
                                                    "total", "each", "gain", "curve"});
  Eigen::Index next = 0;
  for (const NumberPlace& place : form->places()) {
    CHECK(place.first == next);
    next += place.size();
  }
  CHECK(form->size() == next);
  const Eigen::Index ny = short_study().cv_count(), nu = short_study().mv_count();
  CHECK(lag_count(short_study()) == 6);
  const auto shape = [&](const char* name) {
    return std::pair(form->find(name)->rows, form->find(name)->columns);
  };
  CHECK(shape("total") == std::pair<Eigen::Index, Eigen::Index>(1, 1));
  CHECK(shape("each") == std::pair<Eigen::Index, Eigen::Index>(ny, 1));
  CHECK(shape("gain") == std::pair(ny, nu));
  CHECK(shape("channel_flagged") == std::pair(ny, nu));
  CHECK(shape("curve") == std::pair<Eigen::Index, Eigen::Index>(ny, 6));
  CHECK(form->find("nothing") == nullptr);
  CHECK(form->method().numbers.size() == 4);  // as the method describes itself
}

TEST_CASE("assessment form: no place for what a method does not tell") {
  MethodDescription method;
  CHECK(form_of(method)->size() == 0);
  method.locates_cvs = true;
  CHECK(names_of(*form_of(method)) == std::vector<std::string>{"cv_flagged", "cv_score"});
  method.locates_cvs = false;
  method.names_channels = true;
  CHECK(names_of(*form_of(method)) == std::vector<std::string>{"channel_flagged"});
}

TEST_CASE("assessment forms: a study of named scenarios has further numbers, of methods that have such") {
  Study study = find_study("chapter6");
  const auto random = assessment_forms(study, {"sse", "botelho"});
  REQUIRE(random.size() == 2);
  CHECK(random[0]->method().name == "sse");
  CHECK(random[1]->find("cv_acf_y0") == nullptr);
  study.scenarios.resize(1);
  const auto named = assessment_forms(study, {"sse", "botelho"});
  CHECK(named[0]->size() == random[0]->size());
  REQUIRE(named[1]->find("cv_acf_y0") != nullptr);
  CHECK(named[1]->find("cv_acf_y0")->columns == study.simulation.samples / 4 + 1);
  CHECK(named[1]->find("ivar")->first == random[1]->find("ivar")->first);
  CHECK_THROWS_AS(assessment_forms(study, {"nobody"}), InputError);
}

TEST_CASE("an answer that is kept has every number under its name") {
  const auto form = form_of(talker());
  Assessment said;
  said.flagged = true;
  said.score = 4.5;
  said.cvs.resize(7);
  said.cvs[1] = {true, 3.0, FaultSource::ud};
  said.cvs[2] = {false, 7.0, FaultSource::mpm};
  said.flagged_channels = {{1, 0}, {4, 2}};
  double value = 10.0;
  said.numbers.push_back({"total", value++});
  for (Eigen::Index cv = 0; cv < 7; ++cv) {
    said.numbers.push_back({"each", value++, cv});
    for (Eigen::Index mv = 0; mv < short_study().mv_count(); ++mv)
      said.numbers.push_back({"gain", value++, cv, mv});
    for (Eigen::Index lag = 0; lag < 6; ++lag)
      said.numbers.push_back({"curve", value++, cv, lag});
  }
  const AssessmentRecord record = kept(form, said);
  CHECK(record.answered());
  CHECK(record.flagged);
  CHECK(record.score == 4.5);
  CHECK(record.predicted_cv == 2);  // the largest score, flagged or not
  CHECK(record.predicted_source == FaultSource::mpm);
  CHECK(std::isnan(record.number("cv_flagged", 0)));  // nothing is said of it
  CHECK(record.number("cv_flagged", 1) == 1.0);
  CHECK(record.number("cv_flagged", 2) == 0.0);
  CHECK(std::isnan(record.number("cv_score", 0)));
  CHECK(record.number("cv_score", 1) == 3.0);
  CHECK(record.number("cv_source", 1) == static_cast<double>(FaultSource::ud));
  CHECK(record.values("channel_flagged").sum() == 2.0);
  CHECK((record.names({1, 0}) && record.names({4, 2}) && !record.names({0, 0})));
  for (const AssessmentNumber& number : said.numbers) {
    const Eigen::Index row = std::max<Eigen::Index>(number.cv, 0);
    const Eigen::Index column = std::max<Eigen::Index>(number.column, 0);
    REQUIRE(record.number(number.name, row, column) == number.value);
    REQUIRE(record.values(number.name)(row, column) == number.value);
  }
  CHECK(std::isnan(record.number("nothing")));
  CHECK(record.values("nothing").size() == 0);
}

TEST_CASE("an answer that is kept names its mismatch in the place of its channel, or none") {
  MethodDescription method = talker();
  method.names_mismatches = true;
  const auto form = form_of(method);
  CHECK_FALSE(kept(form, {}).named_mismatch());
  Assessment said;
  said.named_mismatch = {{4, 2}, MismatchParameter::dead_time, 3.0, 2.5, 4.0, SizeBound::at_least};
  const AssessmentRecord record = kept(form, said);
  CHECK(record.values("mismatch_parameter").array().isNaN().count() ==
        short_study().cv_count() * short_study().mv_count() - 1);
  const auto named = record.named_mismatch();
  REQUIRE(named);
  CHECK(named->channel == Channel{4, 2});
  CHECK(named->parameter == MismatchParameter::dead_time);
  CHECK((named->size == 3.0 && named->lower == 2.5 && named->upper == 4.0));
  CHECK(named->bound == SizeBound::none);  // an archive from before there was such a number
  CHECK(kept(assessment_forms(short_study(), {"likelihood"}).front(), said).named_mismatch()->bound ==
        SizeBound::at_least);
  CHECK_FALSE(kept(form_of(talker()), said).named_mismatch());  // a method that does not say it names any
}

TEST_CASE("an answer that is kept: a number that was not given is NaN, one that is set stays in its place") {
  AssessmentRecord record = kept(form_of(talker()), {});
  CHECK(record.answered());
  CHECK(record.predicted_cv == -1);
  CHECK(record.values("gain").array().isNaN().all());
  CHECK(record.values("channel_flagged").isZero(0.0));  // it names no channel, and says so
  record.set_number("gain", 2.0, 3, 1);
  CHECK(record.number("gain", 3, 1) == 2.0);
  CHECK(record.numbers.array().isNaN().count() ==
        record.numbers.size() - record.values("channel_flagged").size() - 1);
}

TEST_CASE("an answer that is kept: without a verdict there is a reason, and no number") {
  const AssessmentRecord failed = kept(form_of(talker()), Assessment::failed("why not"));
  CHECK(failed.status == AssessmentStatus::failed);
  CHECK(failed.reason == "why not");
  CHECK_FALSE(failed.answered());
  CHECK_FALSE(failed.flagged);
  CHECK(failed.numbers.size() == 0);
  CHECK(std::isnan(failed.number("total")));
  CHECK(failed.values("each").size() == 0);
  CHECK_FALSE(failed.names({0, 0}));
  CHECK(AssessmentRecord{}.status == AssessmentStatus::not_assessed);
  CHECK(std::isnan(AssessmentRecord{}.number("total")));
}

}  // namespace mpm
