#include "analysis/methods/outside_program.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/system/foreign_text.hpp"
#include "plants/system/program_talk.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProtocol = 1;
constexpr std::size_t kShownOfUnknown = 100;  // bytes, in a message

std::unique_ptr<ProgramTalk> talk_with(const MethodProgram& program) {
  return std::make_unique<ProgramTalk>(fmt::format("method '{}'", program.name), program.command,
                                       program.time_limit);
}

/// {"ask": what, what: content}
Json question(const char* what, Json content) {
  return {{"ask", what}, {what, std::move(content)}};
}

Json describe_content(const MethodProgram& program) {
  return {{"protocol", kProtocol}, {"name", program.name}, {"options", Json::parse(program.options)}};
}

/// What a program says of itself, and the methods of this program whose answers it is told with each loop.
struct ProgramDescription {
  MethodDescription method;
  std::vector<std::string> methods;
};

/// Reads what a program says of itself.
class DescriptionReader {
 public:
  explicit DescriptionReader(const MethodProgram& program)
      : place_(fmt::format("method '{}', description", program.name)) {}

  void read(const Json& answer, ProgramDescription& description) const {
    MethodDescription& method = description.method;
    refuse_others(answer,
                  {"title", "verdict", "needs", "answers", "methods", "numbers", "stated_false_alarms"});
    method.title = text(answer, "title", method.title);
    method.verdict = text(answer, "verdict", method.verdict);
    for (const std::string& need : words(answer, "needs"))
      set(need, {{{"setpoints", &method.requirements.setpoints},
                  {"moving_setpoints", &method.requirements.moving_setpoints},
                  {"benchmark", &method.requirements.benchmark},
                  {"moving_mvs", &method.requirements.moving_mvs},
                  {"nominal_loop", &method.requirements.nominal_loop},
                  {"complete_record", &method.requirements.complete_record}}});
    for (const std::string& word : words(answer, "answers"))
      set(word, {{{"cv", &method.locates_cvs},
                  {"channel", &method.names_channels},
                  {"source", &method.tells_sources},
                  {"mismatch", &method.names_mismatches},
                  {"candidate", &method.names_candidates}}});
    for (const std::string& name : words(answer, "methods"))
      description.methods.push_back(own_method(name));
    if (const auto stated = answer.find("stated_false_alarms"); stated != answer.end() && !stated->is_null())
      method.stated_false_alarms = stated->get<double>();
    if (const auto numbers = answer.find("numbers"); numbers != answer.end())
      read_numbers(*numbers, method);
  }

 private:
  using Flags = std::vector<std::pair<std::string, bool*>>;

  std::string text(const Json& object, const char* key, const std::string& standard) const {
    std::string found = object.value(key, standard);
    if (found.size() > kLongestMethodText)
      throw InputError(place_, fmt::format("{} of {} bytes", key, found.size()),
                       fmt::format("at most {}", kLongestMethodText));
    return found;
  }

  void read_numbers(const Json& numbers, MethodDescription& method) const {
    if (numbers.size() > kMostMethodNumbers)
      throw InputError(place_, fmt::format("{} numbers", numbers.size()),
                       fmt::format("at most {}", kMostMethodNumbers));
    std::set<std::string> names;
    for (const Json& number : numbers) {
      method.numbers.push_back(number_info(number));
      if (const std::string& name = method.numbers.back().name; !names.insert(name).second)
        throw InputError(place_, fmt::format("the number '{}' a second time", name), "every name once");
    }
  }

  static std::vector<std::string> words(const Json& answer, const char* key) {
    return answer.value(key, std::vector<std::string>{});
  }

  /// A method from outside could ask for itself.
  std::string own_method(const std::string& name) const {
    std::vector<std::string> own;
    for (const AssessmentMethodInfo& method : assessment_methods())
      if (method.origin.empty())
        own.push_back(method.name);
    if (std::find(own.begin(), own.end(), name) == own.end())
      throw InputError(fmt::format("{}, methods", place_),
                       fmt::format("'{}'", foreign_text(name, kShownOfUnknown)),
                       fmt::format("{}", fmt::join(own, ", ")));
    return name;
  }

  void set(const std::string& word, const Flags& flags) const {
    std::vector<std::string> known;
    for (const auto& [name, flag] : flags) {
      known.push_back(name);
      if (name == word) {
        *flag = true;
        return;
      }
    }
    throw InputError(place_, fmt::format("'{}'", word), fmt::format("{}", fmt::join(known, ", ")));
  }

  void refuse_others(const Json& object, const std::vector<std::string>& known) const {
    if (!object.is_object())
      throw InputError(
          place_, object.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, kLongestMethodText),
          "a JSON object");
    for (const auto& item : object.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        throw InputError(place_,
                         fmt::format("the unknown key '{}'", foreign_text(item.key(), kShownOfUnknown)),
                         fmt::format("{}", fmt::join(known, ", ")));
  }

  AssessmentNumberInfo number_info(const Json& json) const {
    refuse_others(json, {"name", "scope", "meaning", "unit"});
    AssessmentNumberInfo info{text(json, "name", ""), NumberScope::loop, text(json, "meaning", ""),
                              text(json, "unit", "1")};
    const std::string scope = json.value("scope", "loop");
    const std::array<std::pair<const char*, NumberScope>, 3> scopes{
        {{"loop", NumberScope::loop}, {"cv", NumberScope::cv}, {"channel", NumberScope::channel}}};
    const auto found =
        std::find_if(scopes.begin(), scopes.end(), [&](const auto& each) { return scope == each.first; });
    const bool is_name =
        !info.name.empty() &&
        info.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string::npos;
    if (found == scopes.end() || !is_name)
      throw InputError(place_,
                       json.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, kLongestMethodText),
                       "a number with a name of a-z, 0-9 and _, and a scope loop, cv or channel");
    info.scope = found->second;
    return info;
  }

  std::string place_;
};

ProgramDescription description_of(const MethodProgram& program) {
  ProgramDescription description;
  MethodDescription& method = description.method;
  method.name = program.name;
  method.title = program.name;
  method.verdict = "as the program means it";
  method.requirements.complete_record = false;
  method.origin = fmt::format("program {}", fmt::join(program.command, " "));
  try {
    const Json answer = talk_with(program)->ask(question("describe", describe_content(program)));
    DescriptionReader(program).read(answer, description);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("method '{}', description", program.name), error.what(),
                     "the description of a method, docs/bring_your_own.md");
  } catch (const ChildFailure& error) {
    throw InputError(fmt::format("method '{}', description", program.name), error.what(),
                     fmt::format("an answer within {} s", program.time_limit));
  }
  return description;
}

/// One thread's or worker's own.
class ProgramMethod final : public AssessmentMethod {
 public:
  ProgramMethod(const MethodProgram& program, const ProgramDescription& description,
                const AssessmentContext& context)
      : program_(program),
        method_(description.method),
        plant_(context.study.plant),
        context_(context_json(context)) {
    for (const std::string& name : description.methods)
      told_.push_back({&assessment_method(name), {assessment_method(name), context}});
  }

  Assessment assess(const AssessedLoop& loop) override {
    Json told = loop_json(loop);
    for (Told& each : told_)
      told["answers"][each.method->name] = answer_json(each.assessor.assess(loop), plant_, *each.method);
    Json answer;
    try {
      if (!talk_)
        begin();
      answer = talk_->ask(question("loop", std::move(told)));
    } catch (const ChildFailure& error) {
      talk_.reset();
      throw InputError(fmt::format("method '{}'", program_.name), error.what(),
                       fmt::format("an answer within {} s", program_.time_limit));
    } catch (const InputError&) {
      talk_.reset();
      throw;
    }
    return assessment_of(answer, plant_, method_, fmt::format("method '{}'", program_.name));
  }

 private:
  /// A method whose answers the program is told.
  struct Told {
    const AssessmentMethodInfo* method;
    Assessor assessor;
  };

  void begin() {
    talk_ = talk_with(program_);
    talk_->ask(question("describe", describe_content(program_)));
    talk_->ask(question("context", context_));
  }

  const MethodProgram program_;
  const MethodDescription method_;
  const PlantModel& plant_;
  const Json context_;
  std::vector<Told> told_;
  std::unique_ptr<ProgramTalk> talk_;  ///< none before the first loop, and after one that failed
};

}  // namespace

AssessmentMethodInfo program_method(const MethodProgram& program) {
  const ProgramDescription description = description_of(program);
  return {description.method, {}, [program, description](const AssessmentContext& context) {
            return std::make_unique<ProgramMethod>(program, description, context);
          }};
}

}  // namespace mpm
