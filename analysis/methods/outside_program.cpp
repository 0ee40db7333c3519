#include "analysis/methods/outside_program.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "plants/child_process.hpp"
#include "plants/error.hpp"
#include "plants/thread_clock.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProtocol = 1;

/// A program that is running, and its answers by number.
class ProgramTalk {
 public:
  explicit ProgramTalk(const MethodProgram& program) : program_(program), child_(program.command) {}

  /// Sends {"ask": what, "number": n, what: content} and returns the answer without its number. Throws
  /// ChildFailure; and InputError for a line that is no answer, after which the talk is out of step.
  Json ask(const char* what, Json content) {
    const double before = child_.processor_seconds();
    Json message{{"ask", what}, {"number", ++number_}};
    message[what] = std::move(content);
    const auto deadline = ChildProcess::in_seconds(program_.time_limit);
    child_.send(message.dump(), deadline);
    for (;;)
      if (std::optional<Json> answer = answer_in(child_.receive(deadline))) {
        count_for_thread(child_.processor_seconds() - before);
        return std::move(*answer);
      }
  }

 private:
  /// None: it answers an earlier message.
  std::optional<Json> answer_in(const std::string& line) const {
    Json answer = Json::parse(line, nullptr, false);
    const auto number = answer.is_object() ? answer.find("number") : answer.end();
    if (!answer.is_object() || number == answer.end() || !number->is_number_integer() ||
        number->get<std::int64_t>() > number_)
      throw InputError(fmt::format("method '{}'", program_.name),
                       fmt::format("the line '{}'", beginning(line)),
                       "a JSON object with the number of the message");
    if (number->get<std::int64_t>() < number_)
      return std::nullopt;
    answer.erase("number");
    return answer;
  }

  static std::string beginning(const std::string& line) {
    constexpr std::size_t kShown = 60;
    std::string text = line.substr(0, kShown);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line.size() > kShown ? fmt::format("{}...", text) : text;
  }

  const MethodProgram& program_;
  ChildProcess child_;
  std::int64_t number_ = 0;
};

Json describe_content(const MethodProgram& program) {
  return {{"protocol", kProtocol}, {"name", program.name}, {"options", Json::parse(program.options)}};
}

/// Reads what a program says of itself.
class DescriptionReader {
 public:
  explicit DescriptionReader(const MethodProgram& program)
      : place_(fmt::format("method '{}', description", program.name)) {}

  void read(const Json& answer, MethodDescription& method) const {
    refuse_others(answer, {"title", "verdict", "needs", "answers", "numbers", "stated_false_alarms"});
    method.title = answer.value("title", method.title);
    method.verdict = answer.value("verdict", method.verdict);
    for (const std::string& need : words(answer, "needs"))
      set(need, {{{"setpoints", &method.requirements.setpoints},
                  {"moving_setpoints", &method.requirements.moving_setpoints},
                  {"benchmark", &method.requirements.benchmark},
                  {"moving_mvs", &method.requirements.moving_mvs},
                  {"complete_record", &method.requirements.complete_record}}});
    for (const std::string& word : words(answer, "answers"))
      set(word, {{{"cv", &method.locates_cvs},
                  {"channel", &method.names_channels},
                  {"source", &method.tells_sources},
                  {"mismatch", &method.names_mismatches},
                  {"candidate", &method.names_candidates}}});
    if (const auto stated = answer.find("stated_false_alarms"); stated != answer.end() && !stated->is_null())
      method.stated_false_alarms = stated->get<double>();
    if (const auto numbers = answer.find("numbers"); numbers != answer.end())
      for (const Json& number : *numbers)
        method.numbers.push_back(number_info(number));
  }

 private:
  using Flags = std::vector<std::pair<std::string, bool*>>;

  static std::vector<std::string> words(const Json& answer, const char* key) {
    return answer.value(key, std::vector<std::string>{});
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
      throw InputError(place_, object.dump(), "a JSON object");
    for (const auto& item : object.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        throw InputError(place_, fmt::format("the unknown key '{}'", item.key()),
                         fmt::format("{}", fmt::join(known, ", ")));
  }

  AssessmentNumberInfo number_info(const Json& json) const {
    refuse_others(json, {"name", "scope", "meaning", "unit"});
    AssessmentNumberInfo info{
        .name = json.at("name"), .meaning = json.value("meaning", ""), .unit = json.value("unit", "1")};
    const std::string scope = json.value("scope", "loop");
    const std::array<std::pair<const char*, NumberScope>, 3> scopes{
        {{"loop", NumberScope::loop}, {"cv", NumberScope::cv}, {"channel", NumberScope::channel}}};
    const auto found =
        std::find_if(scopes.begin(), scopes.end(), [&](const auto& each) { return scope == each.first; });
    const bool is_name =
        !info.name.empty() &&
        info.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string::npos;
    if (found == scopes.end() || !is_name)
      throw InputError(place_, json.dump(),
                       "a number with a name of a-z, 0-9 and _, and a scope loop, cv or channel");
    info.scope = found->second;
    return info;
  }

  std::string place_;
};

MethodDescription description_of(const MethodProgram& program) {
  MethodDescription method;
  method.name = program.name;
  method.title = program.name;
  method.verdict = "as the program means it";
  method.requirements.complete_record = false;
  method.origin = fmt::format("program {}", fmt::join(program.command, " "));
  try {
    DescriptionReader(program).read(ProgramTalk(program).ask("describe", describe_content(program)), method);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("method '{}', description", program.name), error.what(),
                     "the description of a method, docs/bring_your_own.md");
  } catch (const ChildFailure& error) {
    throw InputError(fmt::format("method '{}', description", program.name), error.what(),
                     fmt::format("an answer within {} s", program.time_limit));
  }
  return method;
}

/// One thread's or worker's own.
class ProgramMethod final : public AssessmentMethod {
 public:
  ProgramMethod(const MethodProgram& program, const MethodDescription& method,
                const AssessmentContext& context)
      : program_(program), method_(method), plant_(context.study.plant), context_(context_json(context)) {}

  Assessment assess(const AssessedLoop& loop) override {
    Json answer;
    try {
      if (!talk_)
        begin();
      answer = talk_->ask("loop", loop_json(loop));
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
  void begin() {
    talk_.emplace(program_);
    talk_->ask("describe", describe_content(program_));
    talk_->ask("context", context_);
  }

  const MethodProgram program_;
  const MethodDescription method_;
  const PlantModel& plant_;
  const Json context_;
  std::optional<ProgramTalk> talk_;  ///< none before the first loop, and after one that failed
};

}  // namespace

AssessmentMethodInfo program_method(const MethodProgram& program) {
  const MethodDescription description = description_of(program);
  return {description, {}, [program, description](const AssessmentContext& context) {
            return std::make_unique<ProgramMethod>(program, description, context);
          }};
}

}  // namespace mpm
