#include "analysis/methods/outside_program.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "analysis/methods/threshold_rule.hpp"
#include "base/error.hpp"
#include "base/system/foreign_text.hpp"
#include "base/system/json_entry.hpp"
#include "base/system/surroundings.hpp"
#include "base/system/waiting_programs.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProtocol = 1;

/// {"ask": what, what: content}
Json question(const char* what, Json content) {
  return {{"ask", what}, {what, std::move(content)}};
}

Json describe_content(const MethodProgram& program) {
  return {{"protocol", kProtocol},
          {"signals", kWords<SignalForm>},
          {"name", program.name},
          {"options", Json::parse(program.options)}};
}

/// What a program says about itself, how it reads signals, and the methods of this program whose answers it
/// receives with each loop.
struct ProgramDescription {
  MethodDescription method;
  SignalForm signals = SignalForm::lists;
  std::vector<std::string> methods;
};

using Flags = std::vector<std::pair<std::string, bool*>>;

std::string text_or(const JsonEntry& object, const char* key, const std::string& standard) {
  const std::optional<JsonEntry> found = object.find(key);
  return found ? found->text(kLongestMethodText) : standard;
}

/// The positions in `known` of the words in the list under a key, which may be absent.
std::vector<std::size_t> words_in(const JsonEntry& description, const char* key,
                                  const std::vector<std::string>& known) {
  std::vector<std::size_t> places;
  if (const std::optional<JsonEntry> found = description.find(key))
    for (const JsonEntry& word : found->list(fmt::format("a list of some of {}", fmt::join(known, ", "))))
      places.push_back(word.one_of(known));
  return places;
}

/// Sets the flags of the words in the list.
void read_flags(const JsonEntry& description, const char* key, const Flags& flags) {
  std::vector<std::string> known;
  for (const auto& flag : flags)
    known.push_back(flag.first);
  for (const std::size_t place : words_in(description, key, known))
    *flags[place].second = true;
}

AssessmentNumberInfo number_info(const JsonEntry& entry) {
  entry.require_keys({"name", "scope", "meaning", "unit"});
  AssessmentNumberInfo info{text_or(entry, "name", ""), NumberScope::loop, text_or(entry, "meaning", ""),
                            text_or(entry, "unit", "1")};
  entry.at("name").require(
      !info.name.empty() &&
          info.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string::npos,
      "a name of a-z, 0-9 and _");
  constexpr std::array kScopes{NumberScope::loop, NumberScope::cv, NumberScope::channel};
  if (const std::optional<JsonEntry> scope = entry.find("scope"))
    info.scope = kScopes[scope->one_of({"loop", "cv", "channel"})];
  return info;
}

void read_numbers(const JsonEntry& entry, MethodDescription& method) {
  const std::vector<JsonEntry> numbers = entry.list("a list of objects with a name");
  if (numbers.size() > kMostMethodNumbers)
    throw InputError(entry.place(), fmt::format("{} numbers", numbers.size()),
                     fmt::format("at most {}", kMostMethodNumbers));
  std::set<std::string> names;
  for (const JsonEntry& number : numbers) {
    method.numbers.push_back(number_info(number));
    if (const std::string& name = method.numbers.back().name; !names.insert(name).second)
      throw InputError(number.place(), fmt::format("the number '{}' a second time", name), "every name once");
  }
}

/// Adds the numbers that hold stated probabilities. The program must not have numbers of its own with these
/// names.
void take_probabilities(const JsonEntry& entry, MethodDescription& method) {
  for (const AssessmentNumberInfo& number : source_probability_numbers()) {
    if (std::any_of(method.numbers.begin(), method.numbers.end(),
                    [&](const AssessmentNumberInfo& own) { return own.name == number.name; }))
      throw InputError(entry.place(),
                       fmt::format("the number '{}' beside the answer 'probabilities'", number.name),
                       "one of the two");
    method.numbers.push_back(number);
  }
}

/// Reads what a program says about itself.
void read_description(const JsonEntry& entry, ProgramDescription& description) {
  MethodDescription& method = description.method;
  AssessmentRequirements& needs = method.requirements;
  entry.require_keys(
      {"title", "verdict", "needs", "answers", "methods", "numbers", "stated_false_alarms", "signals"});
  method.title = text_or(entry, "title", method.title);
  method.verdict = text_or(entry, "verdict", method.verdict);
  bool corrected = false;
  read_flags(entry, "needs",
             {{"setpoints", &needs.setpoints},
              {"moving_setpoints", &needs.moving_setpoints},
              {"benchmark", &needs.benchmark},
              {"moving_mvs", &needs.moving_mvs},
              {"nominal_loop", &needs.nominal_loop},
              {"complete_record", &needs.complete_record},
              {"corrected", &corrected}});
  method.information = corrected ? ModelInformation::learnt : ModelInformation::nominal;
  bool states_them = false;
  read_flags(entry, "answers",
             {{"cv", &method.locates_cvs},
              {"channel", &method.names_channels},
              {"source", &method.tells_sources},
              {"mismatch", &method.names_mismatches},
              {"candidate", &method.names_candidates},
              {"probabilities", &states_them}});
  const std::vector<std::string> own =
      shipped_methods().every_name();  // a method from outside could ask for itself
  for (const std::size_t place : words_in(entry, "methods", own))
    description.methods.push_back(own[place]);
  if (const std::optional<JsonEntry> form = entry.find("signals"))
    description.signals =
        static_cast<SignalForm>(form->one_of({kWords<SignalForm>.begin(), kWords<SignalForm>.end()}));
  if (const std::optional<JsonEntry> stated = entry.find("stated_false_alarms"))
    method.stated_false_alarms = stated->number(0.0, 1.0);
  if (const std::optional<JsonEntry> numbers = entry.find("numbers"))
    read_numbers(*numbers, method);
  if (states_them)
    take_probabilities(entry, method);
}

std::string threshold_place(const MethodProgram& program) {
  return fmt::format("method '{}': threshold_option '{}'", program.name, program.threshold_option);
}

ProgramDescription description_of(const MethodProgram& program, WaitingPrograms& programs) {
  ProgramDescription description;
  MethodDescription& method = description.method;
  method.name = program.name;
  method.title = program.name;
  method.verdict = "as the program means it";
  method.requirements.complete_record = false;
  method.origin = fmt::format("program {}", fmt::join(program.command, " "));
  try {
    std::unique_ptr<RunningProgram> first = programs.take_new();
    const Json answer = first->talk.ask(question("describe", describe_content(program)));
    read_description({answer, fmt::format("method '{}', description", program.name)}, description);
    first->is_new = false;
    programs.give_back(std::move(first));
  } catch (const ChildFailure& error) {
    throw InputError(fmt::format("method '{}', description", program.name), error.what(),
                     fmt::format("an answer within {} s", program.time_limit));
  }
  if (!program.threshold_option.empty())
    require_threshold_rule(method, threshold_place(program));
  return description;
}

/// Each thread or worker has its own object; only the process that the object asks is shared.
class ProgramMethod final : public AssessmentMethod {
 public:
  ProgramMethod(const MethodProgram& program, const ProgramDescription& description,
                std::shared_ptr<WaitingPrograms> programs, const AssessmentContext& context)
      : program_(program),
        method_(description.method),
        signals_(description.signals),
        programs_(std::move(programs)),
        plant_(context.study.plant),
        correction_(context.correction),
        context_(told_context(context)),
        context_text_(context_.dump()) {
    for (const std::string& name : description.methods)
      told_.push_back({&assessment_method(name), shared_assessor(assessment_method(name), context)});
  }

  Assessment assess(const AssessedLoop& loop) override {
    Json told = loop_json(loop, signals_);
    if (method_.information == ModelInformation::learnt)
      add_corrected(told, loop, correction_.get(), signals_);
    for (Told& each : told_)
      told["answers"][each.method->name] = answer_json(each.assessor->assess(loop), plant_, *each.method);
    Json answer;
    try {
      std::unique_ptr<RunningProgram> running = begun();
      answer = running->talk.ask(question("loop", std::move(told)));
      programs_->give_back(std::move(running));
    } catch (const ChildFailure& error) {
      throw InputError(fmt::format("method '{}'", program_.name), error.what(),
                       fmt::format("an answer within {} s", program_.time_limit));
    } catch (const SurroundingsFailure&) {
      programs_->end_all();
      throw;
    }
    Assessment assessment = assessment_of(answer, plant_, method_, fmt::format("method '{}'", program_.name));
    if (!program_.threshold_option.empty())
      require_threshold_rule(answer, assessment, method_,
                             threshold_in(program_.options, program_.threshold_option),
                             threshold_place(program_));
    return assessment;
  }

 private:
  Json told_context(const AssessmentContext& context) const {
    Json told = context_json(context, signals_);
    if (method_.information == ModelInformation::learnt && context.benchmark)
      add_corrected(told["benchmark"], *context.benchmark, correction_.get(), signals_);
    return told;
  }

  /// A method whose answers the program is told.
  struct Told {
    const AssessmentMethodInfo* method;
    std::shared_ptr<Assessor> assessor;
  };

  /// A process that has the context. A waiting process may not accept a second context: then a new process
  /// gets it.
  std::unique_ptr<RunningProgram> begun() const {
    std::unique_ptr<RunningProgram> running = programs_->take(context_text_);
    if (running->context == context_text_)
      return running;
    if (!running->context.empty()) {
      try {
        tell_context(*running);
        return running;
      } catch (const ChildFailure&) {
        running = programs_->take_new();
      } catch (const InputError&) {
        running = programs_->take_new();
      }
    }
    tell_context(*running);
    return running;
  }

  void tell_context(RunningProgram& running) const {
    if (std::exchange(running.is_new, false))
      running.talk.ask(question("describe", describe_content(program_)));
    running.talk.ask(question("context", context_));
    running.context = context_text_;
  }

  const MethodProgram program_;
  const MethodDescription method_;
  const SignalForm signals_;
  const std::shared_ptr<WaitingPrograms> programs_;
  const PlantModel& plant_;
  const std::shared_ptr<const ModelCorrection> correction_;
  const Json context_;
  const std::string context_text_;
  std::vector<Told> told_;
};

}  // namespace

AssessmentMethodInfo program_method(const MethodProgram& program) {
  auto programs = std::make_shared<WaitingPrograms>(fmt::format("method '{}'", program.name), program.command,
                                                    program.time_limit);
  const ProgramDescription description = description_of(program, *programs);
  return {description.method, {}, [program, description, programs](const AssessmentContext& context) {
            return std::make_unique<ProgramMethod>(program, description, programs, context);
          }};
}

}  // namespace mpm
