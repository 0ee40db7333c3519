#include "scenarios/files/study_differences.hpp"

#include <map>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "scenarios/files/resolved_study.hpp"

namespace mpm {
namespace {

using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// Reads the lines that TomlDraft writes: one heading or value a line, but for long lists, which go on on
/// lines that begin with a space or end the list.
class ResolvedLines {
 public:
  explicit ResolvedLines(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      read(line);
  }

  const KeyValues& values() const { return values_; }

 private:
  void read(const std::string& line) {
    if (!values_.empty() && (line.rfind(' ', 0) == 0 || line.rfind(']', 0) == 0))
      values_.back().second += line;
    else if (line.rfind("[[", 0) == 0)
      table_ = numbered(line.substr(2, line.size() - 4), true);
    else if (line.rfind('[', 0) == 0)
      table_ = numbered(line.substr(1, line.size() - 2), false);
    else if (const std::size_t equals = line.find(" = "); equals != std::string::npos && line[0] != '#')
      add(line.substr(0, equals), line.substr(equals + 3));
    else if (const std::size_t colon = line.find(": ");
             line.rfind("# ", 0) == 0 && colon != std::string::npos)
      add(line.substr(2, colon - 2), line.substr(colon + 2));  // what TOML cannot have
  }

  void add(const std::string& key, const std::string& value) {
    values_.emplace_back(table_.empty() ? key : fmt::format("{}.{}", table_, key), value);
  }

  /// The path of a heading with the places of the lists that it is in.
  std::string numbered(const std::string& heading, bool is_entry) {
    if (is_entry)
      ++entries_[heading];
    std::string path;
    for (std::size_t end = 0; end != std::string::npos;) {
      const std::size_t begin = end;
      end = heading.find('.', begin + 1);
      path += heading.substr(begin, end == std::string::npos ? end : end - begin);
      if (const auto list = entries_.find(heading.substr(0, end)); list != entries_.end())
        path += fmt::format("[{}]", list->second - 1);
    }
    return path;
  }

  std::string table_;
  std::map<std::string, int> entries_;  ///< of each list so far
  KeyValues values_;
};

}  // namespace

std::vector<StudyDifference> study_differences(const Study& before, const Study& now) {
  const ResolvedLines first(resolved_study(before)), second(resolved_study(now));
  std::map<std::string, std::string> old(first.values().begin(), first.values().end());
  std::vector<StudyDifference> differences;
  for (const auto& [key, value] : second.values()) {
    const auto was = old.find(key);
    if (was == old.end())
      differences.push_back({key, "", value});
    else if (was->second != value)
      differences.push_back({key, was->second, value});
    if (was != old.end())
      old.erase(was);
  }
  for (const auto& [key, value] : first.values())
    if (old.count(key) > 0)
      differences.push_back({key, value, ""});
  return differences;
}

}  // namespace mpm
