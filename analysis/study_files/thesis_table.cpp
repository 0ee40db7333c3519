#include "analysis/study_files/thesis_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace mpm {

const VerdictRule* ThesisTable::rule_for(const std::string& quantity) const {
  for (const VerdictRule& rule : rules)
    if (std::find(rule.quantities.begin(), rule.quantities.end(), quantity) != rule.quantities.end())
      return &rule;
  return nullptr;
}

std::string ThesisTable::label() const {
  return fmt::format("{} {}", figure ? "Figure" : "Table", number);
}

std::string ThesisTable::name() const {
  return (figure ? "figure" : "") + number;
}

}  // namespace mpm
