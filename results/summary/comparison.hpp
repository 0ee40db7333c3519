#pragma once

#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// How often each method of the campaign is right, side by side, and which of two is right where the other is
/// not.
Section comparison_section(const Campaign& campaign, const StudyFindings& findings);

/// The same for a terminal, with a heading.
std::string comparison_text(const Campaign& campaign, const StudyFindings& findings);

/// The same as JSON: an array `methods`, one object a method, and an array `pairs`.
std::string comparison_json(const Campaign& campaign, const StudyFindings& findings);

/// The rates that were counted on some loop of some method; the others are empty rows and panels.
std::vector<MethodRateInfo> counted_rates(const std::vector<MethodFindings>& methods);

}  // namespace mpm
