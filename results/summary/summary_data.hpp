#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "results/archive/campaign.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/summary_content.hpp"

// The data of a summary for programs, by section. docs/report.md lists the keys.

namespace mpm {

/// Adds what was run, the basis case, and how many experiments ended in which way.
void put_run(nlohmann::ordered_json& json, const Campaign& campaign, const SummaryContent& parts,
             const std::optional<Unfinished>& unfinished);

/// Adds all findings.
void put_findings(nlohmann::ordered_json& json, const Study& study, const SummaryContent& parts);

/// Adds the named scenarios; an empty list in a study of random experiments.
void put_scenarios(nlohmann::ordered_json& json, const Campaign& campaign);

/// Adds the audit, and all experiments that failed or got a wrong verdict.
void put_experiments(nlohmann::ordered_json& json, const CampaignInfo& info, const SummaryContent& parts);

}  // namespace mpm
