#include "analysis/methods/method_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>

#include "scenarios/toml/toml_file.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_text.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

const std::vector<std::string> kProgramKeys{"command", "time_limit", "options", "threshold_option"};
const std::vector<std::string> kCompositeKeys{"detector", "namer"};

std::string program_options(const TomlTable& table) {
  const toml::node* const node = table.find("options");
  if (node == nullptr)
    return "{}";
  if (!node->is_table())
    table.refuse("options", describe(*node), "a table");
  std::ostringstream text;
  text << toml::json_formatter{*node->as_table()};
  return text.str();
}

/// The name of an option, whose value must be a number; empty if the file gives none.
std::string threshold_option(const TomlTable& table) {
  std::string name = read_text_or(table, "threshold_option", "");
  const toml::table* const options = table.find("options") ? table.find("options")->as_table() : nullptr;
  if (!name.empty() && (options == nullptr || !(*options)[name].is_number()))
    table.refuse("threshold_option", in_quotes(name), "the name of a number among the options");
  return name;
}

}  // namespace

bool is_answering_name(std::string_view name) {
  constexpr std::size_t kLongest = 256;
  if (name.size() > kLongest)
    return false;
  const std::size_t end = name.find_first_of(":+");
  return is_method_name(name.substr(0, end)) &&
         (end == std::string_view::npos || is_answering_name(name.substr(end + 1)));
}

bool is_method_name(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  constexpr std::array<std::string_view, 4> kTaken{"all", "experiments", "findings", "loops"};
  return !name.empty() && name.size() <= kLongest && name.front() != '-' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") ==
             std::string_view::npos &&
         std::find(kTaken.begin(), kTaken.end(), name) == kTaken.end();
}

std::vector<MethodProgram> load_method_file(const std::filesystem::path& path) {
  const std::string file_name = path.string();
  const toml::table toml = parse_toml(read_toml_file(path, "a file of methods"), file_name);
  const TomlTable document(toml, file_name, {"method"});
  std::vector<std::string> names;
  if (const toml::table* const methods = toml["method"].as_table())
    for (const auto& [name, value] : *methods)
      names.emplace_back(name.str());
  const TomlTable methods = document.table("method", names);
  if (names.empty())
    methods.refuse("", "no method", "tables [method.NAME]");
  std::vector<MethodProgram> programs;
  for (const std::string& name : names) {
    if (!is_method_name(name))
      methods.refuse(name, in_quotes(name), kMethodNameRule);
    const toml::table* const entry = toml["method"][name].as_table();
    if (entry != nullptr && (entry->contains("detector") || entry->contains("namer"))) {
      const TomlTable table = methods.table(name, kCompositeKeys);
      programs.push_back(
          {.name = name, .detector = read_text(table, "detector"), .namer = read_text(table, "namer")});
      continue;
    }
    const TomlTable table = methods.table(name, kProgramKeys);
    MethodProgram program{
        .name = name, .command = read_command(table, "command"), .options = program_options(table)};
    program.time_limit = read_time_limit_or(table, "time_limit", program.time_limit);
    program.threshold_option = threshold_option(table);
    programs.push_back(std::move(program));
  }
  return programs;
}

}  // namespace mpm
