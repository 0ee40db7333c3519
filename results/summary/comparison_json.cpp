#include <nlohmann/json.hpp>

#include "results/archive/method_json.hpp"
#include "results/files/utf8.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json rates_json(const MethodRates& method) {
  Json rates = Json::object();
  for (const MethodRateInfo& info : method_rate_infos()) {
    const Rate& rate = method.*info.rate;
    rates[info.name] = {{"hits", rate.hits},
                        {"total", rate.total},
                        {"value", rate.value},
                        {"lower", rate.interval.lower},
                        {"upper", rate.interval.upper}};
  }
  return rates;
}

/// The points as columns. The first and the last threshold are infinite, which JSON cannot say: null.
Json roc_json(const MethodRates& method) {
  Json threshold = Json::array(), true_positive = Json::array(), false_positive = Json::array();
  for (const RocPoint& point : method.roc.points) {
    threshold.push_back(point.threshold);
    true_positive.push_back(point.true_positive_rate);
    false_positive.push_back(point.false_positive_rate);
  }
  return {{"area", method.roc.area},
          {"lower", method.roc_area.lower},
          {"upper", method.roc_area.upper},
          {"faulty", method.roc.positives},
          {"healthy", method.roc.negatives},
          {"threshold", threshold},
          {"true_positive_rate", true_positive},
          {"false_positive_rate", false_positive}};
}

Json method_findings_json(const MethodFindings& method) {
  Json json = method_json(method.form->method());
  json["reason"] = proper_utf8(method.rates.reason);
  json["rates"] = rates_json(method.rates);
  json["roc"] = roc_json(method.rates);
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
          {"p_worse", pair.test.p_worse}};
}

Json rate_names_json() {
  Json names = Json::object();
  for (const MethodRateInfo& info : method_rate_infos())
    names[info.name] = info.meaning;
  return names;
}

}  // namespace

std::string comparison_json(const Campaign& campaign, const StudyFindings& findings) {
  Json methods = Json::array(), pairs = Json::array();
  for (const MethodFindings& method : findings.methods)
    methods.push_back(method_findings_json(method));
  for (const MethodPair& pair : findings.pairs)
    pairs.push_back(pair_json(findings, pair));
  const Json comparison{{"study", campaign.study.name},
                        {"seed", campaign.study.seed},
                        {"experiments", campaign.records.size()},
                        {"loops", assessed_loops(campaign)},
                        {"confidence", campaign.study.aggregate.confidence},
                        {"rates", rate_names_json()},
                        {"methods", methods},
                        {"pairs", pairs}};
  return comparison.dump(2) + "\n";
}

}  // namespace mpm
