#pragma once

#include <string>

#include "results/campaign.hpp"

namespace mpm {

/// What a campaign found, for people: what was run, the self-check, every number that the study has a
/// reported value for beside it, the other numbers, and the experiments with wrong verdicts with the command
/// that replays them. `archive` is the name to show in these commands.
std::string summary_text(const Campaign& campaign, const std::string& archive);

/// The same for programs: an object with `study`, `seed`, `solver`, `seconds`, `experiments`, `failed`,
/// `basis`
/// {`healthy`, `explanation`} and `aggregates`, a list of {`name`, `description`, `value`, `lower`, `upper`,
/// `count`, `reported`}. Numbers that do not exist are null.
std::string summary_json(const Campaign& campaign);

}  // namespace mpm
