#pragma once

#include <string>

#include "analysis/findings/leaderboard.hpp"
#include "results/plot/figure.hpp"

namespace mpm {

/// The leaderboard for people: a table a score, methods down and families across, at most 120 columns wide.
std::string leaderboard_text(const Leaderboard& board);

/// The same as JSON (docs/suite.md), with all rates, by family and by plant.
std::string leaderboard_json(const Leaderboard& board);

/// The same as a page that needs nothing else: the tables are coloured by the numbers in them. Errors:
/// GnuplotError.
std::string leaderboard_html(const Leaderboard& board);

/// Detection against false alarms, a panel a family.
Figure leaderboard_figure(const Leaderboard& board);

}  // namespace mpm
