#pragma once

#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// How often each method of the campaign is right, side by side, and which of two is right where the other is
/// not.
Section comparison_section(const Campaign& campaign, const StudyFindings& findings);

/// "wood-berry: 12 of 14 experiments compared"
std::string comparison_heading(const Study& study, const StudyFindings& findings);

/// The section under this heading. Its data have an array `methods`, one object a method, and an array
/// `pairs`. `campaign` and `findings` must outlive it.
Document comparison_document(const Campaign& campaign, const StudyFindings& findings);

/// These data.
void put_comparison(nlohmann::ordered_json& json, const Campaign& campaign, const StudyFindings& findings);

/// The rates that were counted on some loop of some method; the others are empty rows and panels.
std::vector<MethodRateInfo> counted_rates(const std::vector<MethodFindings>& methods);

}  // namespace mpm
