#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "base/system/program_talk.hpp"

namespace mpm {

TEST_CASE("program talk: a message arrives as it is, with whatever texts") {
  using MessageJson = nlohmann::ordered_json;
  ProgramTalk talk("cat", {"cat"}, 60.0);  // answers what it is asked
  for (const MessageJson& content :
       {MessageJson("plain"), MessageJson(""), MessageJson("\"\\/\b\n\t\x1f\x7f"),
        MessageJson("\u00e9\u20ac\U0001F600"), MessageJson(std::string(300000, 'A')), MessageJson(),
        MessageJson::object(), MessageJson::array(), MessageJson({1.5, nullptr, "x\n", true, -0.0}),
        MessageJson({{"a\"b", {{"deep", {{"list", {1, 2}}}}}}, {"", "empty"}, {"z", 1e-300}, {"a", 2}})}) {
    const MessageJson message{{"ask", "loop"}, {"loop", content}};
    CHECK(talk.ask(message).dump() == message.dump());
  }
}

}  // namespace mpm
