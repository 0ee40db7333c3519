#pragma once

#include <string>
#include <vector>

#include "analysis/findings/run_change.hpp"
#include "results/archive/campaign.hpp"
#include "results/report/report_sections.hpp"

namespace mpm {

/// What the sections of a page of two archives are made from. The first is A, the second B.
struct ChangeInput {
  const Campaign &before, &now;
  std::string before_file, now_file;  ///< how commands name the archives
  RunPairing pairing;
  std::vector<MethodChange> methods;
};

// Each section, in the order in which a reader asks.

ReportSection changes_section(const ChangeInput& input);          ///< the verdict in sentences
ReportSection change_studies_section(const ChangeInput& input);   ///< what differs between the studies
ReportSection change_rates_section(const ChangeInput& input);     ///< rates of A and B
ReportSection change_verdicts_section(const ChangeInput& input);  ///< experiments with another verdict
ReportSection change_numbers_section(const ChangeInput& input);   ///< Ivar, I_MPM, scores

/// "botelho, sse" of the methods of a list that `takes`; empty when there is none.
template <class Takes>
std::string names_of_methods(const std::vector<MethodChange>& methods, Takes takes) {
  std::string names;
  for (const MethodChange& method : methods)
    if (takes(method))
      names += (names.empty() ? "" : ", ") + method.name;
  return names;
}

}  // namespace mpm
