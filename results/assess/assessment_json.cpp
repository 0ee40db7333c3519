#include "results/assess/assessment_json.hpp"

#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/assessment_sentences.hpp"
#include "results/assess/repair_form.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json cvs_json(const RecordAssessment& of, const AssessmentRecord& said) {
  Json cvs = Json::array();
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv) {
    const double flagged = number_of_cv(said, "cv_flagged", cv);
    cvs.push_back({{"cv", cv_name(of.study, cv)},
                   {"flagged", std::isnan(flagged) ? Json() : Json(flagged == 1.0)},
                   {"score", number_of_cv(said, "cv_score", cv)},
                   {"ivar", number_of_cv(said, "ivar", cv)},
                   {"source", to_string(source_of_cv(said, cv))},
                   {"channels", named_mvs(of.study, said, cv)},
                   {"candidate", named_candidate(of, said, cv)}});
  }
  return cvs;
}

Json windows_json(const RecordAssessment& of, const AssessmentRecord& said) {
  Json windows = Json::array();
  const Eigen::MatrixXd flags = said.values("window_flagged"), scores = said.values("window_score");
  for (int window = 0; window < flags.cols(); ++window) {
    const MonitoringOptions& monitoring = *of.study.monitoring;
    const auto stamp = [&](int sample) { return of.record.stamps[static_cast<std::size_t>(sample)]; };
    windows.push_back({{"from", stamp(monitoring.begin(window))},
                       {"to", stamp(monitoring.end(window) - 1)},
                       {"flagged", std::isnan(flags(0, window)) ? Json() : Json(flags(0, window) == 1.0)},
                       {"score", scores(0, window)}});
  }
  return windows;
}

Json named_json(const Study& study, const NamedMismatch& named) {
  return {{"cv", cv_name(study, named.channel.cv)},
          {"mv", mv_name(study, named.channel.mv)},
          {"parameter", to_string(named.parameter)},
          {"size", named.size},
          {"lower", named.lower},
          {"upper", named.upper},
          {"bound", to_string(named.bound)}};
}

Json trust_json(const TrialFindings& found) {
  Json rates;
  for (const RateRow& row : rate_rows())
    if (row.of == StudyFeature::any)
      rates[row.name] = rate_json(found.rates.rates.of(row));
  return {{"threshold", found.threshold},
          {"rates", rates},
          {"as_high", rate_json(found.as_high)},
          {"same_source", rate_json(found.same_source)}};
}

Json method_json(const RecordAssessment& of, std::size_t m) {
  const AssessmentRecord& said = of.said[m];
  Json json{{"name", said.form->method().name}, {"status", to_string(said.status)}, {"reason", said.reason}};
  if (!said.answered())
    return json;
  json["flagged"] = of.answers_of(m).has_fault();
  json["score"] = said.score;
  json["cv"] = of.answers_of(m).has_fault() && said.predicted_cv >= 0
                   ? Json(cv_name(of.study, said.predicted_cv))
                   : Json();
  json["source"] = to_string(named_source(said));
  const std::string valve = named_source(said) == FaultSource::other ? stuck_mv(of.study, said) : "";
  json["valve"] = valve.empty() ? Json() : Json(valve);
  const auto named = said.named_mismatch();
  json["mismatch"] = named ? named_json(of.study, *named) : Json();
  json["cvs"] = cvs_json(of, said);
  json["windows"] = windows_json(of, said);
  json["trust"] = of.trial ? trust_json(of.trial->methods[m]) : Json();
  return json;
}

/// Probabilities of the kinds of fault, given one; null without an answer.
Json odds_json(const std::optional<FaultOdds>& odds) {
  if (!odds)
    return {};
  return {{"mpm", odds->mpm}, {"ud", odds->ud}, {"mpm_ud", odds->mpm_ud}, {"other", odds->other}};
}

Json promise_json(const RecordAssessment& of) {
  const PromisedRepair& promised = *of.repair;
  const auto variances = [](const Eigen::VectorXd& all) {
    return std::vector<double>(all.begin(), all.end());
  };
  Json json{{"cv", cv_name(of.study, promised.repair.channel.cv)},
            {"mv", mv_name(of.study, promised.repair.channel.mv)}};
  json.update(repair_json(promised.repair));
  json["variance"] = {{"now", variances(promised.now)}, {"predicted", variances(promised.predicted)}};
  json["worsens"] = worsened_by_repair(of);
  json["information"] = of.information ? information_json(*of.information) : Json();
  return json;
}

/// Numbers of the MVs; null where there is none.
Json of_mvs(const Study& study, const Eigen::VectorXd& numbers) {
  Json json = Json::object();
  for (Eigen::Index mv = 0; mv < numbers.size(); ++mv)
    json[mv_name(study, mv)] = std::isnan(numbers(mv)) ? Json() : Json(numbers(mv));
  return json;
}

Json model_json(const RecordAssessment& of) {
  const bool is_known = of.model.answered();
  Json unexplained = Json::array();
  for (const UnexplainedCv& each : of.unexplained)
    unexplained.push_back({{"cv", cv_name(of.study, each.cv)}, {"noise", each.noise}});
  return {{"error", of.model_error},
          {"score", is_known ? Json(of.model.score) : Json()},
          {"flagged", is_known ? Json(is_above(of.model, of.trial ? &of.trial->model : nullptr)) : Json()},
          {"unexplained", std::move(unexplained)},
          {"trust", of.trial ? trust_json(of.trial->model) : Json()}};
}

Json controller_json(const RecordAssessment& of) {
  return {{"alike", of.controller.is_alike()},
          {"agreement", of_mvs(of.study, of.controller.agreement)},
          {"closed_loop", of.controller.is_closed_loop},
          {"says", controller_sentences(of)}};
}

}  // namespace

std::string assessment_json(const RecordAssessment& assessment) {
  Json json{{"study", assessment.study.name},
            {"file", assessment.file},
            {"from", assessment.record.stamps.front()},
            {"to", assessment.record.stamps.back()},
            {"samples", assessment.record.samples()},
            {"unjudged", assessment.unjudged},
            {"found", to_string(assessment.found())},
            {"verdict", verdict_sentences(assessment)},
            {"methods", Json::array()}};
  for (std::size_t m = 0; m < assessment.said.size(); ++m)
    json["methods"].push_back(method_json(assessment, m));
  json["probabilities"] = odds_json(assessment.fault_odds());
  json["model"] = model_json(assessment);
  json["controller"] = controller_json(assessment);
  json["repair"] = assessment.repair ? promise_json(assessment) : Json();
  json["candidates"] = prospects_json(assessment.study, assessment.prospects);
  json["trial"] = assessment.trial
                      ? Json{{"loops", assessment.trial->loops}, {"archive", assessment.trial->archive}}
                      : Json{{"loops", 0}, {"why", assessment.no_trial}};
  const auto [first, end] = assessment.record.benchmark;
  json["benchmark"] = first == end
                          ? Json()
                          : Json{{"from", assessment.record.stamps[static_cast<std::size_t>(first)]},
                                 {"to", assessment.record.stamps[static_cast<std::size_t>(end - 1)]}};
  json["warnings"] = assessment.warnings;
  return json_text(json);
}

}  // namespace mpm
