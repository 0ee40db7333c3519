#include "analysis/methods/threshold_rule.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/broken_promise.hpp"
#include "analysis/methods/source_probabilities.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

bool is_scored(const Json& answer, const char* key) {
  const auto score = answer.find(key);
  return score != answer.end() && !score->is_null();
}

/// Does each CV with a flag have a score?
bool has_cv_scores(const Json& answer) {
  const auto flags = answer.find("cv_flagged");
  if (flags == answer.end() || flags->is_null())
    return true;
  for (std::size_t i = 0; i < flags->size(); ++i)
    if (!(*flags)[i].is_null() && (!is_scored(answer, "cv_score") || answer["cv_score"][i].is_null()))
      return false;
  return true;
}

/// How an answer breaks the rule; empty if it keeps the rule.
std::string broken_by(const Json& answer, const Assessment& assessment, const MethodDescription& method,
                      double threshold) {
  if (!is_scored(answer, "score") || !has_cv_scores(answer))
    return "an answer without a score";
  const auto contradicts = [threshold](bool flagged, double score) { return flagged != (score > threshold); };
  const auto said = [threshold](const char* what, bool flagged, double score) {
    return fmt::format("{} = {} with a score of {:g} and a threshold of {:g}", what, flagged, score,
                       threshold);
  };
  if (contradicts(assessment.flagged, assessment.score))
    return said("flagged", assessment.flagged, assessment.score);
  for (const CvAssessment& cv : assessment.cvs)
    if (cv.flagged && contradicts(*cv.flagged, cv.score))
      return said("cv_flagged", *cv.flagged, cv.score);
  return method.locates_cvs && !assessment.worst_cv() ? "an answer that names no CV" : "";
}

}  // namespace

double threshold_in(const std::string& options, const std::string& option) {
  return Json::parse(options).at(option).get<double>();
}

std::string fingerprint_without(const std::string& option, const MethodDescription& method) {
  Json others = Json::parse(method.given_options);
  others.erase(option);
  std::string text = method.fingerprint;
  return text.replace(text.rfind(method.given_options), method.given_options.size(),
                      fmt::format("{} without {}", others.dump(), option));
}

void require_threshold_rule(const MethodDescription& method, const std::string& place) {
  if (method.tells_sources || method.names_channels || method.names_mismatches || method.names_candidates ||
      states_probabilities(method))
    throw BrokenPromise(place, "a method that answers more than its flags, scores and numbers",
                        "answers = [\"cv\"] or none, or no threshold_option");
}

void require_threshold_rule(const Json& answer, const Assessment& assessment, const MethodDescription& method,
                            double threshold, const std::string& place) {
  if (assessment.status != AssessmentStatus::ok)
    return;
  if (const std::string found = broken_by(answer, assessment, method, threshold); !found.empty())
    throw BrokenPromise(place, found, "flags that say whether the score is larger than the threshold");
}

void flag_anew(AssessmentRecord& answer, double threshold) {
  if (!answer.answered())
    return;
  answer.flagged = answer.score > threshold;
  for (const char* const of : {"cv", "window"}) {
    const NumberPlace *const flags = answer.form->find(fmt::format("{}_flagged", of)),
                             *const scores = answer.form->find(fmt::format("{}_score", of));
    for (Eigen::Index i = 0; flags != nullptr && i < flags->size(); ++i)
      if (double& flag = answer.numbers(flags->first + i); !std::isnan(flag))
        flag = answer.numbers(scores->first + i) > threshold ? 1.0 : 0.0;
  }
}

}  // namespace mpm
