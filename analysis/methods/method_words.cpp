#include "analysis/methods/method_words.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mpm {
namespace {

/// The words whose condition holds.
std::string listed(const std::vector<std::pair<bool, const char*>>& words) {
  std::vector<const char*> chosen;
  for (const auto& [holds, word] : words)
    if (holds)
      chosen.push_back(word);
  return chosen.empty() ? "nothing else" : fmt::format("{}", fmt::join(chosen, ", "));
}

}  // namespace

std::string needs_text(const MethodDescription& method) {
  const AssessmentRequirements& needs = method.requirements;
  return listed({{needs.setpoints && !needs.moving_setpoints, "setpoints"},
                 {needs.moving_setpoints, "setpoints that move"},
                 {needs.benchmark, "a benchmark period"},
                 {needs.moving_mvs, "MVs that move"},
                 {needs.nominal_loop, "a controller that runs on its model"},
                 {needs.complete_record, "every sample"}});
}

std::string answers_text(const MethodDescription& method) {
  return listed({{method.locates_cvs, "the CV"},
                 {method.names_channels, "the channels"},
                 {method.tells_sources, "the source"},
                 {method.names_mismatches, "the parameter"},
                 {method.names_candidates, "the logged cause"}});
}

}  // namespace mpm
