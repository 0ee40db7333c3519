#include <nlohmann/json.hpp>

#include "results/archive/method_json.hpp"
#include "results/files/utf8.hpp"
#include "results/summary/comparison.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json rates_json(const Study& study, const MethodRates& method) {
  Json rates = Json::object();
  for (const RateRow& row : rows_for(study, rate_rows()))
    rates[row.name] = rate_json(method.rates.of(row));
  return rates;
}

/// Returns the points as columns. JSON has no infinity: the first and the last threshold, which are infinite,
/// are null.
Json roc_json(const RocCurve& roc, const Interval& area) {
  Json threshold = Json::array(), true_positive = Json::array(), false_positive = Json::array();
  roc.each([&](const RocPoint& point) {
    threshold.push_back(point.threshold);
    true_positive.push_back(point.true_positive_rate);
    false_positive.push_back(point.false_positive_rate);
  });
  return {{"area", roc.area},
          {"lower", area.lower},
          {"upper", area.upper},
          {"faulty", roc.positives},
          {"healthy", roc.negatives},
          {"threshold", threshold},
          {"true_positive_rate", true_positive},
          {"false_positive_rate", false_positive}};
}

/// Returns the thresholds. A threshold is null if it had too few loops, or if it is infinite (no finite score
/// is above it), which JSON cannot write.
Json thresholds_json(const CalibratedThresholds& thresholds) {
  Json json = Json::object();
  for (const ThresholdRow& row : threshold_rows()) {
    const CalibratedThreshold& threshold = thresholds.*row.threshold;
    json[row.name] = {{"value", threshold.value ? Json(*threshold.value) : Json(nullptr)},
                      {"loops", threshold.loops}};
  }
  return json;
}

Json estimates_json(const Study& study, const MethodRates& rates) {
  Json json = Json::object();
  for (const EstimateRow& row : rows_for(study, estimate_rows()))
    json[row.name] = estimate_json(rates.estimates.of(row));
  return json;
}

Json method_findings_json(const Study& study, const MethodFindings& method) {
  const MethodRates& rates = method.rates;
  Json json = method_json(method.form->method());
  json["reason"] = proper_utf8(rates.reason);
  json["rates"] = rates_json(study, rates);
  json["estimates"] = estimates_json(study, rates);
  json["unanswered"] = Json::object();
  for (const UnansweredPart& part : unanswered_parts(study, rates))
    json["unanswered"][part.name] = part.reason;
  json["false_alarm_mark"] = to_string(false_alarm_mark(method.form->method(), rates));
  json["roc"] = roc_json(rates.roc, rates.roc_area);
  json["roc_impact"] = roc_json(rates.roc_impact, rates.roc_impact_area);
  if (study.calibration)
    json["thresholds"] = thresholds_json(rates.thresholds);
  json["milliseconds"] = method.rates.milliseconds;
  return json;
}

Json pair_json(const StudyFindings& findings, const MethodPair& pair) {
  return {{"truth", to_string(pair.truth)},
          {"first", findings.methods[pair.first].name()},
          {"second", findings.methods[pair.second].name()},
          {"loops", pair.loops},
          {"first_alone", pair.test.lost},
          {"second_alone", pair.test.gained},
          {"p_two_sided", pair.test.p_two_sided},
          {"p_worse", pair.test.p_worse},
          {"p_holm", pair.p_holm}};
}

Json rate_names_json(const Study& study) {
  Json names = Json::object();
  for (const RateRow& row : rows_for(study, rate_rows()))
    names[row.name] = row.meaning;
  return names;
}

Json headings_json() {
  Json headings = Json::object();
  for (const MethodNumber& number : method_numbers())
    headings[number.name] = number.heading;
  return headings;
}

}  // namespace

void put_comparison(Json& json, const Campaign& campaign, const StudyFindings& findings) {
  Json methods = Json::array(), pairs = Json::array();
  for (const MethodFindings& method : findings.methods)
    methods.push_back(method_findings_json(campaign.study, method));
  for (const MethodPair& pair : findings.pairs)
    pairs.push_back(pair_json(findings, pair));
  json.update({{"study", campaign.study.name},
               {"seed", campaign.study.seed},
               {"experiments", findings.experiments},
               {"loops", findings.assessed},
               {"confidence", campaign.study.aggregate.confidence},
               {"rates", rate_names_json(campaign.study)},
               {"headings", headings_json()},
               {"columns", overview_rates(findings)},
               {"methods", methods},
               {"pairs", pairs}});
  if (campaign.study.calibration)
    json["calibration"] = {{"false_alarms", campaign.study.calibration->false_alarms},
                           {"seed", campaign.calibration.seed},
                           {"loops", campaign.calibration.loops.size()}};
}

}  // namespace mpm
