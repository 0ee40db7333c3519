#include "analysis/study_files/study_differences.hpp"

#include <map>
#include <string>
#include <vector>

#include "analysis/study_files/study_file_parts.hpp"
#include "scenarios/toml/toml_draft.hpp"

namespace mpm {

std::vector<StudyDifference> study_differences(const Study& before, const Study& now) {
  const std::vector<TomlDraft::Line> first = resolved_lines(before), second = resolved_lines(now);
  std::map<std::string, std::string> old;
  for (const TomlDraft::Line& line : first)
    old.emplace(line.path, line.value);
  std::vector<StudyDifference> differences;
  for (const auto& [key, value, fallback] : second) {
    const auto was = old.find(key);
    if (was == old.end())
      differences.push_back({key, "", value});
    else if (was->second != value)
      differences.push_back({key, was->second, value});
    if (was != old.end())
      old.erase(was);
  }
  for (const auto& [key, value, fallback] : first)
    if (old.count(key) > 0)
      differences.push_back({key, value, ""});
  return differences;
}

}  // namespace mpm
