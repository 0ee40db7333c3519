#include "results/text/experiment_heading.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {

std::string verdict_text(const Study& study, const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  const AssessmentRecord& chain = record.chain();
  if (record.draw.named)
    return fmt::format("flagged {}; {}", flagged_text(study, chain), scenario_verdict_text(study, record));
  if (!chain.answered())
    return "not assessed by the chain";
  const double i_mpm = chain.number("i_mpm");
  return fmt::format(
      "{}located {}, {}", chain.flagged ? "" : "no impact, ", cv_name(study, chain.predicted_cv),
      std::isnan(i_mpm) ? "no I_MPM"
                        : fmt::format("I_MPM {:.3f}: {}", i_mpm, source_name(chain.predicted_source)));
}

std::vector<std::string> experiment_heading(const Study& study, const ExperimentRecord& record) {
  constexpr std::size_t kLongest = 100;
  std::vector<std::string> lines;
  std::string rest = experiment_title(study, record.draw);
  while (rest.size() > kLongest) {
    const std::size_t blank = rest.rfind("; ", kLongest - 1);
    if (blank == std::string::npos)
      break;
    lines.push_back(rest.substr(0, blank + 1));
    rest.erase(0, blank + 2);
  }
  lines.push_back(rest);
  lines.push_back(verdict_text(study, record));
  if (std::string conditions = conditions_text(record); !conditions.empty())
    lines.push_back(std::move(conditions));
  return lines;
}

std::string experiment_line(const Study& study, const ExperimentRecord& record) {
  return experiment_title(study, record.draw) + "; " + verdict_text(study, record);
}

}  // namespace mpm
