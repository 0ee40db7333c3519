#include "analysis/findings/leaderboard.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "analysis/findings/method_rates.hpp"
#include "analysis/statistics/clustered_rate.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The fewest loops of each source: on fewer, it may be chance that the method never named the source.
constexpr std::int64_t kFewestOfSource = 10;

/// Whether the rate counts some loop and reaches `least`.
bool at_least(const Rate& rate, double least) {
  return rate.total > 0 && rate.value >= least;
}

using Belongs = std::function<bool(const CellScores&)>;

PooledScores pool(std::size_t method, const std::vector<CellScores>& cells, double confidence,
                  const Belongs& belongs) {
  PooledScores pooled;
  std::vector<const MethodScores*> of_cells;
  for (const CellScores& cell : cells) {
    if (!belongs(cell) || !cell.trouble.empty())
      continue;
    const MethodScores& scores = *of_cells.emplace_back(&cell.methods[method]);
    ++pooled.cells;
    pooled.answering_cells += scores["answered"].hits > 0 ? 1 : 0;
    if (pooled.reason.empty())
      pooled.reason = scores.reason;
    pooled.reliability.add(scores.reliability);
    for (std::size_t loop = 0; scores.scope.is_told && loop < scores.outcomes.size(); ++loop)
      if (scores.outcomes[loop])
        pooled.confusions.add(*cell.truths[loop], *scores.outcomes[loop]);
  }
  for (const RateRow& row : rate_rows()) {
    std::vector<std::vector<ClusterCount>> strata;  // the worlds of each cell
    double further = 0.0, total = 0.0;
    for (const MethodScores* const scores : of_cells) {
      const Rate& rate = scores->rates.of(row);
      strata.push_back(rate.clusters.empty() ? std::vector<ClusterCount>{{rate.hits, rate.total}}
                                             : rate.clusters);
      const auto trials = static_cast<double>(rate.total);  // each cell has a threshold of its own
      further += trials * trials * rate.further_variance;
      total += trials;
    }
    pooled.rates.of(row) =
        clustered_rate(strata, confidence, further > 0.0 ? further / (total * total) : 0.0);
  }
  for (const EstimateRow& row : estimate_rows()) {
    std::vector<std::vector<ClusterSum>> strata;
    for (const MethodScores* const scores : of_cells)
      strata.push_back(scores->estimates.of(row).clusters);
    pooled.estimates.of(row) = clustered_mean(strata, confidence);
  }
  pooled.estimates["calibration_error"] = {.value = pooled.reliability.error(),
                                           .count = pooled.reliability.count()};
  return pooled;
}

/// Returns the entries of an axis that some cell has, and gives the cells their new places among these.
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

void add_shares(const PooledScores& reference, PooledScores& scores) {
  for (const std::string_view name : leaderboard_rates()) {
    const Rate &reached = scores[name], &possible = reference[name];
    const bool counted = !row_of(rate_rows(), name).low_is_good && reached.total > 0 && possible.hits > 0;
    scores.shares_of_ceiling.push_back(counted ? reached.value / possible.value : kNaN);
  }
}

/// Compares every method with the reference, family by family.
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
  for (const MethodFindings& method : findings.methods)
    scores.methods.push_back(
        {.reason = method.rates.reason,
         .failed = method.rates.failures.failed,
         .rates = method.rates.rates,
         .estimates = method.rates.estimates,
         .outcomes = method.rates.outcomes,
         .scope = outcome_scope(cell.study, method.form->method(), method.rates.thresholds),
         .reliability = method.rates.reliability});
  return scores;
}

MethodScores scores_of_outcomes(const CellScores& cell, LoopOutcomes outcomes, const OutcomeScope& scope) {
  RateCounts counts;
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i])
      counts.add({scope, *cell.truths[i], *outcomes[i]}, cell.worlds[i]);
  return {
      .reason = "", .rates = counts.rates(kBoardConfidence), .outcomes = std::move(outcomes), .scope = scope};
}

bool PooledScores::answers_in_part() const {
  const Rate& answered = rates["answered"];
  return answered.hits > 0 && answered.value < kFewestAnswers;
}

bool PooledScores::too_many_false_alarms() const {
  const Rate& alarms = rates["false_alarm_healthy"];
  return alarms.total > 0 && alarms.interval.lower > kMostFalseAlarms;
}

bool passes(const PooledScores& scores, LeaderboardTask task) {
  const Rate& alarms = scores["false_alarm_healthy"];
  const bool quiet = alarms.total > 0 && alarms.value <= kPassingFalseAlarms;
  if (!quiet || !at_least(scores["answered"], kFewestAnswers))
    return false;
  switch (task) {
    case LeaderboardTask::detection:
      return at_least(scores["detected_impact"], kPassingShare);
    case LeaderboardTask::location:
      return at_least(scores["located"], kPassingShare);
    case LeaderboardTask::source:
      return at_least(scores["source_all"], kPassingShare);
  }
  return false;
}

std::vector<std::string_view> leaderboard_rates() {
  return {"answered", "detected_impact", "power_05_impact", "false_alarm_healthy", "false_alarm_calibrated",
          "located",  "source",          "source_all"};
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

bool answers(const Leaderboard& board, std::size_t method, std::string_view rate) {
  const PooledScores& scores = board.overall[method];
  if (board.methods[method] == kReferenceMethod || scores.rates[rate].total == 0)
    return false;
  const Rate &mismatches = scores["source_05_mpm"], &disturbances = scores["source_05_ud"];
  const bool one_of_them = std::min(mismatches.total, disturbances.total) >= kFewestOfSource &&
                           (mismatches.hits == 0) != (disturbances.hits == 0);
  return rate != kRankingSource || !one_of_them;
}

std::optional<int> question_rank(const Leaderboard& board, std::size_t method, std::string_view rate) {
  if (!answers(board, method, rate))
    return std::nullopt;
  int place = 1;
  for (std::size_t other = 0; other < board.methods.size(); ++other)
    if (answers(board, other, rate) &&
        board.overall[other].rates[rate].value > board.overall[method].rates[rate].value)
      ++place;
  return place;
}

std::vector<RankedMethod> ranking(const Leaderboard& board) {
  std::vector<RankedMethod> ranked;
  if (!board.in_worlds())
    return ranked;
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (board.methods[method] != kReferenceMethod)
      ranked.push_back({method});
  const auto repair = [&board](const RankedMethod& each) {
    return board.overall[each.method].estimates[kRankingRepair].value;
  };
  const auto rank = [&ranked](const RankedMethod& one, const auto& value) -> std::optional<int> {
    if (std::isnan(value(one)))
      return std::nullopt;
    return 1 + static_cast<int>(std::count_if(ranked.begin(), ranked.end(), [&](const RankedMethod& other) {
             return value(other) > value(one);
           }));
  };
  for (RankedMethod& each : ranked) {
    each.source = question_rank(board, each.method, kRankingSource);
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
