#include "analysis/findings/leaderboard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "analysis/findings/method_rates.hpp"
#include "analysis/statistics/clustered_rate.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr std::array kScores{
    LeaderboardScore{"answered", "verdict given"},
    LeaderboardScore{"detected_impact", "faults with an impact, flagged"},
    LeaderboardScore{"power_05_impact", "faults with an impact, flagged at 5 % false alarms"},
    LeaderboardScore{"false_alarm_healthy", "healthy loops, flagged", true},
    LeaderboardScore{"false_alarm_calibrated", "healthy loops, flagged at the calibrated threshold", true},
    LeaderboardScore{"located", "flagged, the affected CV named"},
    LeaderboardScore{"source", "flagged, the right source named"},
    LeaderboardScore{"source_all", "all faults, the right source named"},
};

const MethodRateInfo* info_of(std::string_view name) {
  const auto infos = method_rate_infos();
  const auto found = std::find_if(infos.begin(), infos.end(),
                                  [name](const MethodRateInfo& info) { return info.name == name; });
  return found == infos.end() ? nullptr : &*found;
}

/// The value of a rate that was counted on some loop; none otherwise.
bool at_least(const Rate* rate, double least) {
  return rate != nullptr && rate->total > 0 && rate->value >= least;
}

using Belongs = std::function<bool(const CellScores&)>;

PooledScores pool(std::size_t method, const std::vector<CellScores>& cells, double confidence,
                  const Belongs& belongs) {
  PooledScores pooled;
  const auto infos = method_rate_infos();
  std::vector<std::vector<std::vector<ClusterCount>>> strata(infos.size());  // the worlds of each cell
  std::vector<std::vector<std::vector<ClusterSum>>> of_estimates(method_estimate_infos().size());
  for (const CellScores& cell : cells) {
    if (!belongs(cell) || !cell.trouble.empty())
      continue;
    const MethodScores& scores = cell.methods[method];
    ++pooled.cells;
    const Rate* const answered = scores.of("answered");
    pooled.answering_cells += answered != nullptr && answered->hits > 0 ? 1 : 0;
    if (pooled.reason.empty())
      pooled.reason = scores.reason;
    for (std::size_t i = 0; i < infos.size(); ++i)
      strata[i].push_back(scores.rates[i].clusters.empty()
                              ? std::vector<ClusterCount>{{scores.rates[i].hits, scores.rates[i].total}}
                              : scores.rates[i].clusters);
    for (std::size_t i = 0; i < scores.estimates.size(); ++i)
      of_estimates[i].push_back(scores.estimates[i].clusters);
  }
  for (std::size_t i = 0; i < infos.size(); ++i)
    pooled.rates.push_back(clustered_rate(strata[i], confidence));
  for (const std::vector<std::vector<ClusterSum>>& cells_of_one : of_estimates)
    pooled.estimates.push_back(clustered_mean(cells_of_one, confidence));
  return pooled;
}

/// The entries of an axis that some cell has, with the places of the cells counted anew.
std::vector<SuiteAxis> used(const std::vector<SuiteAxis>& axis, std::vector<CellScores>& cells,
                            std::size_t CellScores::*place) {
  std::vector<SuiteAxis> kept;
  for (std::size_t old = 0; old < axis.size(); ++old) {
    const auto here = [&](const CellScores& cell) { return cell.*place == old; };
    if (std::none_of(cells.begin(), cells.end(), here))
      continue;
    for (CellScores& cell : cells)
      if (here(cell))
        cell.*place = kept.size();  // never above `old`, so that no cell is moved twice
    kept.push_back(axis[old]);
  }
  return kept;
}

MethodScores scores_of(const MethodRates& of) {
  MethodScores scores{.reason = of.reason, .failed = of.failures.failed, .rates = {}};
  for (const MethodRateInfo& info : method_rate_infos())
    scores.rates.push_back(of.*info.rate);
  for (const MethodEstimateInfo& info : method_estimate_infos())
    scores.estimates.push_back(of.*info.estimate);
  return scores;
}

void add_shares(const PooledScores& reference, PooledScores& scores) {
  for (const LeaderboardScore& score : leaderboard_scores()) {
    const Rate* const reached = scores.of(score.rate);
    const Rate* const possible = reference.of(score.rate);
    const bool counted = !score.low_is_good && reached->total > 0 && possible->hits > 0;
    scores.shares_of_ceiling.push_back(counted ? reached->value / possible->value : kNaN);
  }
}

/// Holds every method against the reference, family by family.
void add_shares(Leaderboard& board) {
  const auto reference = std::find(board.methods.begin(), board.methods.end(), kReferenceMethod);
  if (reference == board.methods.end())
    return;
  const auto place = static_cast<std::size_t>(reference - board.methods.begin());
  for (std::vector<PooledScores>& of_method : board.by_family)
    for (std::size_t family = 0; family < board.families.size(); ++family)
      if (board.families[family].has_reference)
        add_shares(board.by_family[place][family], of_method[family]);
}

}  // namespace

const Rate* MethodScores::of(std::string_view name) const {
  const MethodRateInfo* const info = info_of(name);
  return info == nullptr ? nullptr : &rates[static_cast<std::size_t>(info - method_rate_infos().data())];
}

Estimate MethodScores::estimate(std::string_view name) const {
  const auto infos = method_estimate_infos();
  for (std::size_t i = 0; i < estimates.size(); ++i)
    if (infos[i].name == name)
      return estimates[i];
  return {};
}

CellScores cell_scores(const SuiteCell& cell, const StudyFindings& findings) {
  CellScores scores{.plant = cell.plant,
                    .family = cell.family,
                    .seed = cell.study.seed,
                    .time_unit = cell.study.plant.time_unit,
                    .monitored = cell.study.monitoring.has_value(),
                    .in_worlds = cell.study.world.has_value(),
                    .experiments = findings.experiments,
                    .failed = findings.failed,
                    .infeasible = findings.infeasible.hits,
                    .truths = findings.truths,
                    .worlds = findings.worlds};
  for (const MethodFindings& method : findings.methods) {
    MethodScores& of_method = scores.methods.emplace_back(scores_of(method.rates));
    of_method.outcomes = method.rates.outcomes;
    of_method.scope = outcome_scope(cell.study, method.form->method(), method.rates.thresholds);
  }
  return scores;
}

MethodScores scores_of_outcomes(const CellScores& cell, std::string outcomes, const OutcomeScope& scope) {
  OutcomeCounts counts;
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i] != kNoLoop)
      counts.add(scope, cell.worlds[i], *fault_truth(cell.truths[i]), *loop_outcome(outcomes[i]));
  MethodRates rates{};
  counts.put(rates, kBoardConfidence);
  MethodScores scores = scores_of(rates);
  scores.outcomes = std::move(outcomes);
  scores.scope = scope;
  return scores;
}

bool PooledScores::answers_in_part() const {
  const Rate* const answered = of("answered");
  return answered != nullptr && answered->hits > 0 && answered->value < kFewestAnswers;
}

bool PooledScores::too_many_false_alarms() const {
  const Rate* const alarms = of("false_alarm_healthy");
  return alarms != nullptr && alarms->total > 0 && alarms->interval.lower > kMostFalseAlarms;
}

bool passes(const PooledScores& scores, LeaderboardTask task) {
  const Rate* const alarms = scores.of("false_alarm_healthy");
  const bool quiet = alarms != nullptr && alarms->total > 0 && alarms->value <= kPassingFalseAlarms;
  if (!quiet || !at_least(scores.of("answered"), kFewestAnswers))
    return false;
  switch (task) {
    case LeaderboardTask::detection:
      return at_least(scores.of("detected_impact"), kPassingShare);
    case LeaderboardTask::location:
      return at_least(scores.of("located"), kPassingShare);
    case LeaderboardTask::source:
      return at_least(scores.of("source_all"), kPassingShare);
  }
  return false;
}

std::vector<LeaderboardScore> leaderboard_scores() {
  std::vector<LeaderboardScore> known;
  for (const LeaderboardScore& score : kScores)
    if (info_of(score.rate) != nullptr)
      known.push_back(score);
  return known;
}

bool Leaderboard::in_worlds() const {
  const auto ran = [](const CellScores& cell) { return cell.trouble.empty(); };
  return std::any_of(cells.begin(), cells.end(), ran) &&
         std::all_of(cells.begin(), cells.end(),
                     [&ran](const CellScores& cell) { return cell.in_worlds || !ran(cell); });
}

bool Leaderboard::is_own(std::size_t method) const {
  return std::find(own.begin(), own.end(), methods[method]) != own.end();
}

std::vector<RankedMethod> ranking(const Leaderboard& board) {
  std::vector<RankedMethod> ranked;
  if (!board.in_worlds())
    return ranked;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (board.methods[method] != kReferenceMethod)
      ranked.push_back({method});
  const auto source = [&board](const RankedMethod& each) {
    const Rate* const rate = board.overall[each.method].of(kRankingSource);
    return rate != nullptr && rate->total > 0 ? rate->value : kNaN;
  };
  const auto repair = [&board](const RankedMethod& each) {
    return board.overall[each.method].estimate(kRankingRepair).value;
  };
  const auto rank = [&ranked](const RankedMethod& one, const auto& value) -> std::optional<int> {
    if (std::isnan(value(one)))
      return std::nullopt;
    return 1 + static_cast<int>(std::count_if(ranked.begin(), ranked.end(), [&](const RankedMethod& other) {
             return value(other) > value(one);
           }));
  };
  for (RankedMethod& each : ranked) {
    each.source = rank(each, source);
    each.repair = rank(each, repair);
  }
  const auto last = [](const std::optional<int>& place) {
    return place.value_or(std::numeric_limits<int>::max());
  };
  std::stable_sort(ranked.begin(), ranked.end(), [&last](const RankedMethod& a, const RankedMethod& b) {
    return std::pair(last(a.source), last(a.repair)) < std::pair(last(b.source), last(b.repair));
  });
  return ranked;
}

bool has_reference(const Leaderboard& board) {
  return std::any_of(
      board.by_family.begin(), board.by_family.end(), [](const std::vector<PooledScores>& of_method) {
        return std::any_of(of_method.begin(), of_method.end(),
                           [](const PooledScores& scores) { return !scores.shares_of_ceiling.empty(); });
      });
}

Leaderboard make_leaderboard(const Suite& suite, const std::vector<std::string>& methods,
                             const std::string& program, std::vector<CellScores> cells, double confidence) {
  Leaderboard board{.suite = suite.name,
                    .version = suite.version,
                    .title = suite.title,
                    .seed = suite.seed,
                    .program = program,
                    .confidence = confidence,
                    .methods = methods};
  board.plants = used(suite.plants, cells, &CellScores::plant);
  board.families = used(suite.families, cells, &CellScores::family);
  board.cells = std::move(cells);
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const bool counts = methods[method] != kReferenceMethod;
    const auto pooled = [&](const Belongs& belongs, bool counts_here) {
      return pool(
          method, board.cells, board.confidence,
          counts_here ? belongs : [](const CellScores&) { return false; });
    };
    std::vector<PooledScores>& families = board.by_family.emplace_back();
    for (std::size_t family = 0; family < board.families.size(); ++family)
      families.push_back(pooled([family](const CellScores& cell) { return cell.family == family; },
                                counts || board.families[family].has_reference));
    std::vector<PooledScores>& plants = board.by_plant.emplace_back();
    for (std::size_t plant = 0; plant < board.plants.size(); ++plant)
      plants.push_back(pooled([plant](const CellScores& cell) { return cell.plant == plant; }, counts));
    board.overall.push_back(pooled([](const CellScores&) { return true; }, counts));
  }
  add_shares(board);
  return board;
}

std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task) {
  std::vector<std::string> names;
  const auto somebody_passes = [&](std::size_t family) {
    for (std::size_t method = 0; method < board.methods.size(); ++method)
      if (board.methods[method] != kReferenceMethod && passes(board.by_family[method][family], task))
        return true;
    return false;
  };
  for (std::size_t family = 0; family < board.families.size(); ++family)
    if (!somebody_passes(family))
      names.push_back(board.families[family].name);
  return names;
}

}  // namespace mpm
