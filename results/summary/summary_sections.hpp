#pragma once

#include <string>

#include "results/archive/campaign.hpp"
#include "results/summary/summary_content.hpp"
#include "results/summary/summary_lines.hpp"

namespace mpm {

// Parts of the summary as text.

/// Of a study of named scenarios: what the chain says of each of them against what the study says.
void add_scenarios(SummaryLines& text, const Campaign& campaign);

/// Of a study that modifies S0: fits and changes of the CVs at a soft limit, and the fits with MVs fixed.
void add_s0_perturbation(SummaryLines& text, const Study& study, const SummaryContent& parts);

}  // namespace mpm
