#pragma once

#include <string>

#include "analysis/findings/fault_size.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/roc.hpp"
#include "results/report/report_sections.hpp"

// The words of the page: the verdict at the top, and below each question a sentence made from the numbers and
// their uncertainty. A text is empty if its numbers are missing.

namespace mpm {

/// The first three sentences of the page: what was asked, what came out, and what to do.
std::string verdict_html(const ReportInput& input);

std::string rates_answer(const ReportInput& input);
std::string false_alarm_answer(const ReportInput& input);
std::string variance_answer(const ReportInput& input);
std::string location_answer(const ReportInput& input);
std::string indicator_answer(const ReportInput& input);
std::string dominance_answer(const ReportInput& input);
std::string roc_answer(const RocCurve& curve, const Interval& area, const RocPoint& at_study);
/// `faults`: all experiments with a single fault, however its size is measured.
std::string fault_size_answer(const std::vector<SizedFault>& faults, double confidence);
std::string s0_answer(const ReportInput& input);
std::string interaction_answer(const ReportInput& input, const LoopInteraction& interaction);

}  // namespace mpm
