#include "base/system/program_talk.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/system/foreign_text.hpp"
#include "base/system/thread_clock.hpp"

namespace mpm {
namespace {

constexpr std::size_t kShownOfLine = 60;  // bytes, in a message

using Json = nlohmann::ordered_json;

/// Tells whether a text needs only quotes around it to be JSON. The loop does not end early, so that the
/// compiler can look at many characters at once.
bool is_plain(const std::string& text) {
  unsigned char odd = 0;
  for (const signed char c : text)
    odd |= static_cast<unsigned char>((c < ' ') | (c == 0x7f) | (c == '"') | (c == '\\'));
  return odd == 0;
}

/// Writes what Json::dump() writes, which takes twenty times as long for the texts of signals.
void append(const Json& json, std::string& text) {
  if (json.is_object()) {
    char before = '{';
    for (const auto& item : json.items()) {
      text += before;
      append(Json(item.key()), text);
      text += ':';
      append(item.value(), text);
      before = ',';
    }
    text += before == '{' ? "{}" : "}";
  } else if (json.is_string() && is_plain(json.get_ref<const std::string&>())) {
    text += '"';
    text += json.get_ref<const std::string&>();
    text += '"';
  } else {
    text += json.dump();
  }
}

}  // namespace

ProgramTalk::ProgramTalk(std::string place, const std::vector<std::string>& command, double time_limit)
    : place_(std::move(place)), time_limit_(time_limit), child_(command) {}

nlohmann::ordered_json ProgramTalk::ask(nlohmann::ordered_json message) {
  const double before = child_.processor_seconds();
  message["number"] = ++number_;
  const auto deadline = ChildProcess::in_seconds(time_limit_);
  std::string text;
  append(message, text);
  child_.send(text, deadline);
  for (;;)
    if (std::optional<nlohmann::ordered_json> answer = answer_in(child_.receive(deadline))) {
      count_for_thread(child_.processor_seconds() - before);
      return std::move(*answer);
    }
}

/// Returns none if the line answers an earlier message.
std::optional<nlohmann::ordered_json> ProgramTalk::answer_in(const std::string& line) const {
  nlohmann::ordered_json answer = nlohmann::ordered_json::parse(line, nullptr, false);
  const auto number = answer.is_object() ? answer.find("number") : answer.end();
  if (!answer.is_object() || number == answer.end() || !number->is_number_integer() ||
      number->get<std::int64_t>() > number_)
    throw InputError(place_, fmt::format("the line '{}'", foreign_text(line, kShownOfLine)),
                     "a JSON object with the number of the message");
  if (number->get<std::int64_t>() < number_)
    return std::nullopt;
  answer.erase("number");
  return answer;
}

}  // namespace mpm
