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

/// The CVs that are late: null if all are, one name, or a list of names.
Json late_json(const RecordAssessment& of) {
  Json names = Json::array();
  for (const Eigen::Index cv : of.verdict.model.late_cvs)
    names.push_back(cv_name(of.study, cv));
  return names.empty() ? Json() : names.size() == 1 ? names.front() : names;
}

/// Of the simulated records for which the same source was named as in the verdict: the share named rightly.
Json same_source_json(const RecordAssessment& of) {
  const TrialCounts& counts = of.trial->counts;
  return rate_json(rate(counts.right, counts.same, of.study.aggregate.confidence));
}

Json method_json(const RecordAssessment& of, std::size_t m) {
  const AssessmentRecord& said = of.said[m];
  Json json{{"name", said.form->method().name}, {"status", to_string(said.status)}, {"reason", said.reason}};
  if (!said.answered())
    return json;
  json["flagged"] = of.is_flagged(m);
  json["score"] = said.score;
  json["cv"] =
      of.is_flagged(m) && said.predicted_cv >= 0 ? Json(cv_name(of.study, said.predicted_cv)) : Json();
  json["source"] = to_string(named_source(said));
  const std::string valve = named_source(said) == FaultSource::other ? stuck_mv(of.study, said) : "";
  json["valve"] = valve.empty() ? Json() : Json(valve);
  const auto named = said.named_mismatch();
  json["mismatch"] = named ? named_json(of.study, *named) : Json();
  json["cvs"] = cvs_json(of, said);
  json["windows"] = windows_json(of, said);
  json["trust"] = of.trial_of(m) ? trust_json(*of.trial_of(m)) : Json();
  return json;
}

Json number_or_null(double value) {
  return std::isnan(value) ? Json() : Json(value);
}

/// The probability of each source; null if there are no simulated records.
Json probabilities_json(const std::optional<OfSources>& probabilities) {
  if (!probabilities)
    return {};
  Json json = Json::object();
  for (const RecordSource source : enumerators<RecordSource>())
    json[std::string(to_string(source))] = (*probabilities)[source];
  return json;
}

Json loop_json(const RecordAssessment& of) {
  Json cvs = Json::array();
  for (const CvCost& cost : of.verdict.loop.costs)
    cvs.push_back({{"cv", cv_name(of.study, cost.cv)},
                   {"kind", cost.has_setpoint ? "setpoint" : "range"},
                   {"cost", cost.now},
                   {"designed", cost.designed},
                   {"ratio", cost.ratio},
                   {"threshold", number_or_null(cost.threshold)},
                   {"dearer", cost.is_dearer()}});
  return {{"answer", to_string(of.verdict.loop.answer)}, {"cvs", std::move(cvs)}};
}

Json action_json(const RecordAssessment& of) {
  const RecordVerdict::Action& action = of.verdict.action;
  const auto name = [&of](Eigen::Index place, bool is_cv) {
    return place < 0 ? Json() : Json(is_cv ? cv_name(of.study, place) : mv_name(of.study, place));
  };
  Json worsened = Json::array();
  for (const Eigen::Index cv : action.worsened)
    worsened.push_back(cv_name(of.study, cv));
  return {{"kind", to_string(action.kind)},
          {"cv", name(action.channel ? action.channel->cv : action.cv, true)},
          {"mv", name(action.channel ? action.channel->mv : action.mv, false)},
          {"gain", action.promise ? Json{{"value", action.promise->gain},
                                         {"lower", action.promise->lower},
                                         {"upper", action.promise->upper}}
                                  : Json()},
          {"worsens", std::move(worsened)}};
}

Json health_json(const RecordAssessment& of) {
  Json from = Json::array(), channels = Json::array();
  for (const Eigen::Index begin : of.periods)
    from.push_back(of.record.stamps[static_cast<std::size_t>(begin)]);
  for (const ChannelHistory& history : of.health) {
    const Eigen::Index nu = of.study.mv_count();
    Json periods = Json::array();
    for (const ChannelPeriod& period : history.periods)
      periods.push_back({{"state", to_string(period.state)},
                         {"score", period.score},
                         {"parameter", to_string(period.parameter)},
                         {"size", period.size}});
    channels.push_back(
        {{"cv", cv_name(of.study, history.cv)},
         {"input", history.input < nu
                       ? mv_name(of.study, history.input)
                       : of.study.plant.mds[static_cast<std::size_t>(history.input - nu)].name},
         {"periods", std::move(periods)}});
  }
  return {{"threshold", number_or_null(of.health_threshold())},
          {"from", std::move(from)},
          {"channels", std::move(channels)}};
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

/// One number per MV; null if it is NaN.
Json of_mvs(const Study& study, const Eigen::VectorXd& numbers) {
  Json json = Json::object();
  for (Eigen::Index mv = 0; mv < numbers.size(); ++mv)
    json[mv_name(study, mv)] = std::isnan(numbers(mv)) ? Json() : Json(numbers(mv));
  return json;
}

Json model_json(const RecordAssessment& of) {
  const RecordVerdict::Model& model = of.verdict.model;
  Json at = Json::array(), unexplained = Json::array();
  for (const UnexplainedPart& part : model.at) {
    at.push_back({{"cv", cv_name(of.study, part.cv)},
                  {"score", part.score},
                  {"threshold", part.threshold},
                  {"of", part.is_noise ? "noise" : "errors"}});
    if (part.is_noise)
      unexplained.push_back({{"cv", cv_name(of.study, part.cv)}, {"noise", part.score}});
  }
  const auto stamp = [&of](Eigen::Index sample) {
    return of.record.stamps[static_cast<std::size_t>(sample)];
  };
  return {{"answer", to_string(model.answer)},
          {"at", std::move(at)},
          {"since", model.since ? Json{{"from", stamp(model.since->sample)},
                                       {"earliest", stamp(model.since->earliest)},
                                       {"latest", stamp(model.since->latest)}}
                                : Json()},
          {"source", to_string(model.source)},
          {"drift", model.drifts && model.sensor_cv >= 0 ? Json(cv_name(of.study, model.sensor_cv)) : Json()},
          {"jumps", model.jumps},
          {"md", model.md < 0 ? Json() : Json(of.study.plant.mds[static_cast<std::size_t>(model.md)].name)},
          {"stuck", model.stuck ? Json{{"cv", cv_name(of.study, model.sensor_cv)},
                                       {"from", stamp(model.stuck->first)},
                                       {"to", stamp(model.stuck->end - 1)}}
                                : Json()},
          {"mismatch", model.mismatch ? named_json(of.study, *model.mismatch) : Json()},
          {"valve", model.valve_mv < 0 ? Json() : Json(mv_name(of.study, model.valve_mv))},
          {"late", model.late == 0.0 ? Json()
                                     : Json{{"cv", late_json(of)},
                                            {"samples", model.late},
                                            {"corrected", model.late_is_corrected}}},
          {"error", of.model_error},
          {"score", number_or_null(model.score)},
          {"threshold", number_or_null(model.threshold)},
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
            {"found", assessment.verdict.found()},
            {"verdict", verdict_sentences(assessment)},
            {"model", model_json(assessment)},
            {"loop", loop_json(assessment)},
            {"action", action_json(assessment)},
            {"probabilities", probabilities_json(assessment.verdict.model.probabilities)},
            {"health", health_json(assessment)},
            {"methods", Json::array()}};
  for (std::size_t m = 0; m < assessment.said.size(); ++m)
    json["methods"].push_back(method_json(assessment, m));
  json["controller"] = controller_json(assessment);
  json["repair"] = assessment.repair ? promise_json(assessment) : Json();
  json["candidates"] = prospects_json(assessment.study, assessment.prospects);
  json["trial"] = assessment.trial ? Json{{"loops", assessment.trial->loops},
                                          {"archive", assessment.trial->archive},
                                          {"same_source", same_source_json(assessment)}}
                                   : Json{{"loops", 0}, {"why", assessment.no_trial}};
  const auto [first, end] = assessment.record.benchmark;
  json["benchmark"] = first == end
                          ? Json()
                          : Json{{"from", assessment.record.stamps[static_cast<std::size_t>(first)]},
                                 {"to", assessment.record.stamps[static_cast<std::size_t>(end - 1)]}};
  const RecordBenchmark& best = assessment.verdict.benchmark;
  json["proposed_benchmark"] =
      best.use == BenchmarkUse::proposed
          ? Json{{"from", assessment.record.stamps[static_cast<std::size_t>(best.first)]},
                 {"to", assessment.record.stamps[static_cast<std::size_t>(best.end - 1)]}}
          : Json();
  json["warnings"] = assessment.warnings;
  return json_text(json);
}

}  // namespace mpm
