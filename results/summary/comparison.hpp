#pragma once

#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// Returns the method with the highest value of `rate` among those that answer and detect; null if there is
/// none. The first one wins a tie.
const MethodFindings* best_method(const StudyFindings& findings, std::string_view rate);

/// Tells whether any method was right or wrong on some loop.
bool was_judged(const StudyFindings& findings);

/// Says (as words) which method finds the CV, the source and the channel most often, and what the user's own
/// methods find. Empty if no loop was judged.
std::string comparison_answer(const StudyFindings& findings);

/// Says which share of the loops each of the user's own methods flags, the best method first: sentences, each
/// after a space. Empty if there is no such method.
std::string own_methods_words(const StudyFindings& findings);

/// Returns the most important of the rates that count at least one loop.
std::vector<std::string> overview_rates(const StudyFindings& findings);

/// Makes a table of these rates, with one row per method that gave a verdict, the best method first.
Table overview_table(const Campaign& campaign, const StudyFindings& findings);

/// Returns the same table for a paper (table_latex()).
std::string comparison_latex(const Campaign& campaign, const StudyFindings& findings);

/// The overview table with its notes, for one screen.
Section comparison_overview(const Campaign& campaign, const StudyFindings& findings);

/// Shows how often each method of the campaign is right, side by side, and for each pair how often only one
/// of the two is right.
Section comparison_section(const Campaign& campaign, const StudyFindings& findings);

/// "wood-berry: 12 of 14 experiments compared"
std::string comparison_heading(const Study& study, const StudyFindings& findings);

/// Makes a document of the overview under this heading and, for those who ask for everything, the whole
/// comparison. Its data have an array `methods`, with one object per method, and an array `pairs`. `campaign`
/// and `findings` must outlive it.
Document comparison_document(const Campaign& campaign, const StudyFindings& findings);

/// Adds the data of comparison_document() to `json`.
void put_comparison(nlohmann::ordered_json& json, const Campaign& campaign, const StudyFindings& findings);

/// Heading for the share of healthy loops that a method claims to flag
/// (MethodDescription::stated_false_alarms).
inline constexpr const char* kStatedAlarmsHeading = "False alarms stated";

/// Returns the rates that count a loop of at least one method. The others would be empty rows and panels.
std::vector<const RateRow*> counted_rates(const std::vector<MethodFindings>& methods);

}  // namespace mpm
