#include "analysis/methods/method_messages.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/source_probabilities.hpp"
#include "base/base64.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"
#include "base/system/foreign_text.hpp"
#include "scenarios/controller/model_json.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownOfKey = 100;  // bytes, in a message
constexpr double kRoundingOfSum = 1e-3;   // of probabilities that a program has rounded

std::string found_text(const Json& value) {
  constexpr std::size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > kLongest ? fmt::format("{}...", text.substr(0, kLongest)) : text;
}

/// Reads the parts of one answer.
class AnswerReader {
 public:
  AnswerReader(const PlantModel& plant, const MethodDescription& method, const std::string& place)
      : plant_(plant), method_(method), place_(place) {}

  Assessment read(const Json& answer) const {
    if (!answer.is_object())
      refuse("answer", answer, "a JSON object");
    refuse_unknown(answer,
                   {"flagged", "score", "cv", "source", "cv_flagged", "cv_score", "cv_source", "channels",
                    "mismatch", "candidate", "probabilities", "numbers", "error", "not_applicable"});
    if (const Json* const error = given(answer, "error"))
      return Assessment::failed(text("error", *error));
    if (const Json* const reason = given(answer, "not_applicable"))
      return Assessment::not_applicable(text("not_applicable", *reason));
    Assessment assessment;
    const Json* const flagged = given(answer, "flagged");
    if (flagged == nullptr || !flagged->is_boolean())
      refuse("flagged", flagged ? *flagged : Json(), "true, false, or an `error` instead");
    assessment.flagged = flagged->get<bool>();
    const Json* const score = given(answer, "score");
    assessment.score = score ? number("score", *score) : assessment.flagged ? 1.0 : 0.0;
    read_cvs(answer, assessment);
    read_channels(answer, assessment);
    read_mismatch(answer, assessment);
    read_candidate(answer, assessment);
    read_probabilities(answer, assessment);
    read_numbers(answer, assessment);
    return assessment;
  }

 private:
  [[noreturn]] void refuse(std::string_view key, const Json& found, const std::string& allowed) const {
    throw InputError(fmt::format("{}: {}", place_, key), found_text(found), allowed);
  }

  void refuse_unknown(const Json& object, const std::vector<std::string>& known) const {
    for (const auto& item : object.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        throw InputError(place_, fmt::format("the unknown key '{}'", foreign_text(item.key(), kShownOfKey)),
                         fmt::format("{}", fmt::join(known, ", ")));
  }

  /// The value of a key, null when it is absent or null.
  static const Json* given(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
  }

  /// The same for a key that is allowed only if the description of the method announces it.
  const Json* given_if(bool described, const Json& object, const char* key, const char* answers) const {
    const Json* const value = given(object, key);
    if (value != nullptr && !described)
      refuse(key, *value, fmt::format("nothing: the method does not say that it answers '{}'", answers));
    return value;
  }

  std::string text(const char* key, const Json& value) const {
    if (!value.is_string())
      refuse(key, value, "a text");
    return shortened(value.get<std::string>());
  }

  /// Cuts the text between two characters, because it is kept with every loop.
  static std::string shortened(std::string text) {
    if (text.size() <= kLongestMethodText)
      return text;
    std::size_t end = kLongestMethodText;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
      --end;
    text.resize(end);
    return text + "...";
  }

  /// JSON has no word for values that are not finite: infinities are texts.
  double number(const char* key, const Json& value) const {
    if (value.is_null())
      return kNaN;
    if (value == "Infinity" || value == "-Infinity")
      return value == "Infinity" ? kInfinity : -kInfinity;
    if (!value.is_number())
      refuse(key, value, "a number, null, \"Infinity\" or \"-Infinity\"");
    return value.get<double>();
  }

  Eigen::Index place_of(const char* key, const Json& value,
                        const std::vector<PlantModel::Variable>& variables) const {
    std::vector<std::string> names;
    for (const PlantModel::Variable& variable : variables)
      names.push_back(variable.name);
    const auto found =
        std::find(names.begin(), names.end(), value.is_string() ? value.get<std::string>() : "");
    if (found == names.end())
      refuse(key, value, fmt::format("{}", fmt::join(names, ", ")));
    return found - names.begin();
  }

  template <class Enum>
  Enum word(const char* key, const Json& value) const {
    if (const auto found = enumerator<Enum>(value.is_string() ? value.get<std::string>() : ""))
      return *found;
    refuse(key, value, fmt::format("{}", fmt::join(kWords<Enum>, ", ")));
  }

  const Json& list(const char* key, const Json& value, std::size_t length) const {
    if (!value.is_array() || value.size() != length)
      refuse(key, value, fmt::format("a list of {}", length));
    return value;
  }

  static void take_source(ToldSource told, CvAssessment& cv) {
    cv.source = source_of(told);
    if (cv.source == FaultSource::other)
      cv.about = told;
  }

  void read_cvs(const Json& answer, Assessment& assessment) const {
    const Json* const cv = given_if(method_.locates_cvs, answer, "cv", "cv");
    const Json* const flags = given_if(method_.locates_cvs, answer, "cv_flagged", "cv");
    const Json* const scores = given_if(method_.locates_cvs, answer, "cv_score", "cv");
    const Json* const source = given_if(method_.tells_sources, answer, "source", "source");
    const Json* const sources = given_if(method_.tells_sources, answer, "cv_source", "source");
    if (source != nullptr && cv == nullptr && *source != "none")
      refuse("source", *source, "none, or a source together with its CV");
    if (cv == nullptr && flags == nullptr)
      return;
    const std::size_t count = plant_.cvs.size();
    assessment.cvs.resize(count);
    for (std::size_t i = 0; i < count && flags != nullptr; ++i) {
      CvAssessment& of_cv = assessment.cvs[i];
      const Json& flag = list("cv_flagged", *flags, count)[i];
      if (flag.is_null())
        continue;
      if (!flag.is_boolean())
        refuse("cv_flagged", flag, "true, false or null");
      of_cv.flagged = flag.get<bool>();
      of_cv.score = scores ? number("cv_score", list("cv_score", *scores, count)[i]) : kNaN;
      if (std::isnan(of_cv.score))
        of_cv.score = *of_cv.flagged ? 1.0 : 0.0;
      if (sources != nullptr && !list("cv_source", *sources, count)[i].is_null())
        take_source(word<ToldSource>("cv_source", (*sources)[i]), of_cv);
    }
    if (cv == nullptr)
      return;
    if (flags != nullptr)
      refuse("cv", *cv, "this or cv_flagged, not both");
    CvAssessment& named = assessment.cvs[static_cast<std::size_t>(place_of("cv", *cv, plant_.cvs))];
    named.flagged = assessment.flagged;
    named.score = std::isnan(assessment.score) ? 0.0 : assessment.score;
    if (source != nullptr)
      take_source(word<ToldSource>("source", *source), named);
  }

  Channel channel(const char* key, const Json& value) const {
    list(key, value, 2);
    return {place_of(key, value[0], plant_.cvs), place_of(key, value[1], plant_.mvs)};
  }

  void read_channels(const Json& answer, Assessment& assessment) const {
    const Json* const channels = given_if(method_.names_channels, answer, "channels", "channel");
    if (channels == nullptr)
      return;
    if (!channels->is_array())
      refuse("channels", *channels, "a list of [CV, MV]");
    for (const Json& each : *channels)
      assessment.flagged_channels.push_back(channel("channels", each));
  }

  void read_mismatch(const Json& answer, Assessment& assessment) const {
    const Json* const mismatch = given_if(method_.names_mismatches, answer, "mismatch", "mismatch");
    if (mismatch == nullptr)
      return;
    if (!mismatch->is_object() || !mismatch->contains("channel") || !mismatch->contains("parameter"))
      refuse("mismatch", *mismatch, "an object with channel and parameter, and size, lower, upper or not");
    refuse_unknown(*mismatch, {"channel", "parameter", "size", "lower", "upper"});
    const auto size = [&](const char* key) { return number(key, mismatch->value(key, Json())); };
    assessment.named_mismatch = {channel("mismatch", mismatch->at("channel")),
                                 word<MismatchParameter>("mismatch", mismatch->at("parameter")), size("size"),
                                 size("lower"), size("upper")};
  }

  void read_candidate(const Json& answer, Assessment& assessment) const {
    const Json* const candidate = given_if(method_.names_candidates, answer, "candidate", "candidate");
    if (candidate == nullptr)
      return;
    if (!candidate->is_number_integer() || candidate->get<std::int64_t>() < 1)
      refuse("candidate", *candidate, "the number of a logged signal, from 1");
    assessment.named_candidate = candidate->get<std::int64_t>() - 1;
  }

  void read_probabilities(const Json& answer, Assessment& assessment) const {
    const Json* const stated =
        given_if(states_probabilities(method_), answer, "probabilities", "probabilities");
    if (stated == nullptr)
      return;
    if (!stated->is_object())
      refuse("probabilities", *stated,
             fmt::format("an object with {}", fmt::join(kWords<FaultSource>, ", ")));
    refuse_unknown(*stated, {kWords<FaultSource>.begin(), kWords<FaultSource>.end()});
    double sum = 0.0;
    for (std::size_t i = 0; i < kWords<FaultSource>.size(); ++i) {
      const std::string key(kWords<FaultSource>[i]);
      const double p = stated->contains(key) ? number("probabilities", stated->at(key)) : 0.0;
      if (!(p >= 0.0 && p <= 1.0))
        refuse("probabilities", *stated, "numbers from 0 to 1");
      sum += p;
      assessment.numbers.push_back({source_probability_numbers()[i].name, p});
    }
    if (std::abs(sum - 1.0) > kRoundingOfSum)
      refuse("probabilities", *stated, "numbers that add up to 1");
  }

  void read_numbers(const Json& answer, Assessment& assessment) const {
    const Json* const numbers = given(answer, "numbers");
    if (numbers == nullptr)
      return;
    if (!numbers->is_object())
      refuse("numbers", *numbers, "an object with numbers that the description of the method lists");
    for (const auto& item : numbers->items()) {
      const auto info = std::find_if(method_.numbers.begin(), method_.numbers.end(),
                                     [&](const auto& each) { return each.name == item.key(); });
      if (info == method_.numbers.end())
        throw InputError(place_, fmt::format("the number '{}'", foreign_text(item.key(), kShownOfKey)),
                         "numbers that the description of the method lists");
      add_number(*info, item.value(), assessment.numbers);
    }
  }

  void add_number(const AssessmentNumberInfo& info, const Json& value,
                  std::vector<AssessmentNumber>& list_of) const {
    const char* const key = info.name.c_str();
    if (info.scope == NumberScope::loop) {
      list_of.push_back({info.name, number(key, value)});
      return;
    }
    list(key, value, plant_.cvs.size());
    for (std::size_t cv = 0; cv < value.size(); ++cv) {
      const auto row = static_cast<Eigen::Index>(cv);
      if (info.scope == NumberScope::cv)
        list_of.push_back({info.name, number(key, value[cv]), row});
      else
        for (std::size_t mv = 0; mv < list(key, value[cv], plant_.mvs.size()).size(); ++mv)
          list_of.push_back({info.name, number(key, value[cv][mv]), row, static_cast<Eigen::Index>(mv)});
    }
  }

  const PlantModel& plant_;
  const MethodDescription& method_;
  const std::string& place_;
};

/// The inverse of AnswerReader::number().
Json number_json(double value) {
  if (std::isnan(value))
    return {};
  if (std::isinf(value))
    return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}

Json channel_json(const Channel& channel, const PlantModel& plant) {
  return {plant.cvs[static_cast<std::size_t>(channel.cv)].name,
          plant.mvs[static_cast<std::size_t>(channel.mv)].name};
}

/// Adds the three lists of what a method says about each CV.
void add_cvs_json(const Assessment& assessment, const PlantModel& plant, bool tells_sources, Json& json) {
  for (std::size_t cv = 0; cv < plant.cvs.size(); ++cv) {
    const CvAssessment of_cv = cv < assessment.cvs.size() ? assessment.cvs[cv] : CvAssessment{};
    json["cv_flagged"].push_back(of_cv.flagged ? Json(*of_cv.flagged) : Json());
    json["cv_score"].push_back(number_json(of_cv.score));
    if (tells_sources)
      json["cv_source"].push_back(to_string(told_source(of_cv.source, of_cv.about)));
  }
}

Json signal_json(const Eigen::MatrixXd& signal, SignalForm form) {
  static_assert(std::endian::native == std::endian::little);
  if (form == SignalForm::lists)
    return matrix_json(signal);
  const RowMajorMatrix rows =
      signal.unaryExpr([](double value) { return std::isfinite(value) ? value : kNaN; });
  return {{"rows", rows.rows()},
          {"base64", base64(std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(rows.size()))))}};
}

/// The numbers with a scope that an answer can have.
Json numbers_json(const Assessment& assessment, const PlantModel& plant, const MethodDescription& method) {
  const auto ny = static_cast<Eigen::Index>(plant.cvs.size()),
             nu = static_cast<Eigen::Index>(plant.mvs.size());
  Json numbers = Json::object();
  for (const AssessmentNumberInfo& info : method.numbers) {
    if (info.scope == NumberScope::loop)
      numbers[info.name] = number_json(assessment.number(info.name));
    else if (info.scope == NumberScope::cv)
      for (Eigen::Index cv = 0; cv < ny; ++cv)
        numbers[info.name].push_back(number_json(assessment.number(info.name, cv)));
    else if (info.scope == NumberScope::channel)
      for (Eigen::Index cv = 0; cv < ny; ++cv) {
        Json row = Json::array();
        for (Eigen::Index mv = 0; mv < nu; ++mv)
          row.push_back(number_json(assessment.number(info.name, cv, mv)));
        numbers[info.name].push_back(std::move(row));
      }
  }
  return numbers;
}

}  // namespace

const std::vector<LoopSignal>& loop_signals() {
  static const std::vector<LoopSignal> signals{
      {"y", "cv", "CVs as the historian has them", &AssessedLoop::y},
      {"u", "mv", "MVs", &AssessedLoop::u},
      {"u_target", "mv", "targets of the optimizer for the MVs", &AssessedLoop::u_target},
      {"d", "md", "measured disturbances", &AssessedLoop::d},
      {"y_sim", "cv", "output of the nominal model under the MVs and measured disturbances",
       &AssessedLoop::y_sim},
      {"y_set", "cv", "setpoints; NaN for a CV without one", &AssessedLoop::y_set},
      {"candidates", "candidate", "logged signals that are not in the model", &AssessedLoop::candidates}};
  return signals;
}

Json loop_json(const AssessedLoop& loop, SignalForm form) {
  Json json;
  for (const LoopSignal& signal : loop_signals())
    json[signal.name] = signal_json(loop.*signal.member, form);
  if (loop.whole != nullptr) {
    json["first"] = loop.first;
    json["whole"] = loop_json(*loop.whole, form);
  }
  return json;
}

void add_corrected(Json& json, const AssessedLoop& loop, const ModelCorrection* correction, SignalForm form) {
  const std::shared_ptr<const AssessedLoop> corrected =
      correction != nullptr ? correction->corrected(loop) : nullptr;
  const AssessedLoop& shown = corrected ? *corrected : loop;
  json["y_sim_corrected"] = signal_json(shown.y_sim, form);
  if (loop.whole != nullptr)
    json["whole"]["y_sim_corrected"] = signal_json(shown.whole->y_sim, form);
}

Json context_json(const AssessmentContext& context, SignalForm form) {
  const Study& study = context.study;
  Json json = loop_context_json(study.plant, study.controller, study.sensitivity.samples);
  json["samples"] = study.simulation.samples;
  json["operating_point"] = {{"u", vector_json(context.basis.point.u)},
                             {"y", vector_json(context.basis.point.y)}};
  json["benchmark"] = context.benchmark ? loop_json(*context.benchmark, form) : Json();
  return json;
}

Json answer_json(const Assessment& assessment, const PlantModel& plant, const MethodDescription& method) {
  if (assessment.status == AssessmentStatus::not_applicable)
    return Json::object({{"not_applicable", assessment.reason}});
  if (assessment.status != AssessmentStatus::ok)
    return Json::object({{"error", assessment.reason}});
  Json json{{"flagged", assessment.flagged}, {"score", number_json(assessment.score)}};
  if (method.locates_cvs)
    add_cvs_json(assessment, plant, method.tells_sources, json);
  if (method.names_channels) {
    json["channels"] = Json::array();
    for (const Channel& channel : assessment.flagged_channels)
      json["channels"].push_back(channel_json(channel, plant));
  }
  if (const auto& named = assessment.named_mismatch)
    json["mismatch"] = {{"channel", channel_json(named->channel, plant)},
                        {"parameter", to_string(named->parameter)},
                        {"size", number_json(named->size)},
                        {"lower", number_json(named->lower)},
                        {"upper", number_json(named->upper)}};
  if (assessment.named_candidate)
    json["candidate"] = *assessment.named_candidate + 1;
  json["numbers"] = numbers_json(assessment, plant, method);
  return json;
}

Assessment assessment_of(const Json& answer, const PlantModel& plant, const MethodDescription& method,
                         const std::string& place) {
  return AnswerReader(plant, method, place).read(answer);
}

}  // namespace mpm
