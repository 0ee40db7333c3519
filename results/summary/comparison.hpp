#pragma once

#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"

namespace mpm {

/// The method that is right most often, of those that answer and detect; null when there is none. The first
/// one wins a tie.
const MethodFindings* best_method(const StudyFindings& findings, std::string_view rate);

/// Is there a method that was right or wrong on some loop?
bool was_judged(const StudyFindings& findings);

/// Words: which method finds the CV, the source and the channel most often, and what the methods find that
/// are programs of the user; empty where no loop was judged.
std::string comparison_answer(const StudyFindings& findings);

/// Sentences, each after a space, on the loops that each of the user's own methods flags, the best first;
/// empty if there is none.
std::string own_methods_words(const StudyFindings& findings);

/// The rates that matter most, of those that some loop counts for.
std::vector<std::string> overview_rates(const StudyFindings& findings);

/// A table of them, one row a method that gave a verdict, the best one first.
Table overview_table(const Campaign& campaign, const StudyFindings& findings);

/// The same for a paper (table_latex()).
std::string comparison_latex(const Campaign& campaign, const StudyFindings& findings);

/// The table with its notes, for one screen.
Section comparison_overview(const Campaign& campaign, const StudyFindings& findings);

/// How often each method of the campaign is right, side by side, and which of two is right where the other is
/// not.
Section comparison_section(const Campaign& campaign, const StudyFindings& findings);

/// "wood-berry: 12 of 14 experiments compared"
std::string comparison_heading(const Study& study, const StudyFindings& findings);

/// The overview under this heading, and the whole comparison for those who ask for it. Its data have an array
/// `methods`, one object a method, and an array `pairs`. `campaign` and `findings` must outlive it.
Document comparison_document(const Campaign& campaign, const StudyFindings& findings);

/// These data.
void put_comparison(nlohmann::ordered_json& json, const Campaign& campaign, const StudyFindings& findings);

/// Of the share of healthy loops that a method claims to flag (MethodDescription::stated_false_alarms).
inline constexpr const char* kStatedAlarmsHeading = "False alarms stated";

/// The rates that were counted on some loop of some method; the others are empty rows and panels.
std::vector<const RateRow*> counted_rates(const std::vector<MethodFindings>& methods);

}  // namespace mpm
