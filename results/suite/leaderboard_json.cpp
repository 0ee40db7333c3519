#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "analysis/findings/leaderboard_standing.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/source_confusions.hpp"
#include "analysis/findings/source_forecast.hpp"
#include "results/document/words.hpp"
#include "results/files/utf8.hpp"
#include "results/suite/board_columns.hpp"
#include "results/suite/leaderboard_output.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using SuiteJson = nlohmann::ordered_json;

SuiteJson axis_json(const std::vector<SuiteAxis>& axis) {
  SuiteJson list = SuiteJson::array();
  for (const SuiteAxis& entry : axis)
    list.push_back({{"name", entry.name}, {"title", proper_utf8(entry.title)}});
  return list;
}

/// Tells whether the board can have this number: numbers on worlds are only in boards of worlds.
bool has_number(const Leaderboard& board, StudyFeature of) {
  return board.in_worlds() || (of != StudyFeature::worlds && of != StudyFeature::calibrated_worlds);
}

/// Lists the bins that hold a loop.
SuiteJson reliability_json(const Leaderboard& board, const Reliability& reliability) {
  SuiteJson bins = SuiteJson::array();
  for (const Reliability::Bin& bin : reliability.bins())
    if (bin.count > 0) {
      SuiteJson json = rate_json(rate(bin.right, bin.count, board.confidence));
      json["stated"] = bin.stated / static_cast<double>(bin.count);
      bins.push_back(std::move(json));
    }
  return bins;
}

/// Lists the truths that have a loop, each with every answer.
SuiteJson confusions_json(const SourceConfusions& confusions) {
  SuiteJson json = SuiteJson::object();
  for (const ToldSource truth : enumerators<ToldSource>())
    if (confusions.of(truth) > 0)
      for (const AnsweredSource answer : enumerators<AnsweredSource>())
        json[std::string(to_string(truth))][std::string(to_string(answer))] = confusions.of(truth, answer);
  return json;
}

/// Returns the forecast from frequencies, and the skill of methods relative to it.
SuiteJson forecast_json(const Leaderboard& board, const SourceProbabilities& frequencies) {
  SuiteJson json;
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    json["frequencies"][std::string(kWords<FaultSource>[i])] = frequencies[i];
  const ForecastScores scores = frequency_scores(board, [](const CellScores&) { return true; });
  json["log_score"] = scores.log_score;
  json["brier_score"] = scores.brier_score;
  json["count"] = scores.loops;
  json["skill"] = SuiteJson::object();
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    if (states_probabilities(board, method)) {
      const ForecastSkill skill = forecast_skill(board, method);
      json["skill"][board.methods[method]] = {{"log_score", skill.log_score},
                                              {"brier_score", skill.brier_score}};
    }
  return json;
}

SuiteJson scores_json(const Leaderboard& board, const PooledScores& scores) {
  SuiteJson rates = SuiteJson::object(), passed = SuiteJson::object();
  for (const RateRow& row : rate_rows())
    if (has_number(board, row.of))
      rates[row.name] = rate_json(scores.rates.of(row));
  for (const LeaderboardTask task : kLeaderboardTasks)
    passed[std::string(to_string(task))] = passes(scores, task);
  SuiteJson shares = SuiteJson::object();
  const std::vector<std::string_view> known = leaderboard_rates();
  for (std::size_t i = 0; i < scores.shares_of_ceiling.size(); ++i)
    if (!std::isnan(scores.shares_of_ceiling[i]))
      shares[std::string(known[i])] = scores.shares_of_ceiling[i];
  SuiteJson json{{"cells", scores.cells},
                 {"answering_cells", scores.answering_cells},
                 {"reason", proper_utf8(scores.reason)},
                 {"too_many_false_alarms", scores.too_many_false_alarms()},
                 {"answers_in_part", scores.answers_in_part()},
                 {"passes", passed},
                 {"shares_of_ceiling", shares},
                 {"rates", rates}};
  if (board.in_worlds())
    for (const char* const name : {"repair_gain_share", "repair_gain_share_05"})
      json["estimates"][name] = estimate_json(scores.estimates[name]);
  if (scores.reliability.count() > 0) {
    for (const std::string_view name : probability_scores())
      json["estimates"][std::string(name)] = estimate_json(scores.estimates[name]);
    json["reliability"] = reliability_json(board, scores.reliability);
  }
  if (scores.confusions.total() > 0)
    json["confusions"] = confusions_json(scores.confusions);
  return json;
}

SuiteJson along(const Leaderboard& board, const std::vector<SuiteAxis>& axis,
                const std::vector<PooledScores>& scores) {
  SuiteJson json = SuiteJson::object();
  for (std::size_t i = 0; i < axis.size(); ++i)
    json[axis[i].name] = scores_json(board, scores[i]);
  return json;
}

/// Lists the ranks; null if a method has no rank.
SuiteJson ranking_json(const Leaderboard& board) {
  SuiteJson json = SuiteJson::array();
  const auto rank = [](const std::optional<int>& place) {
    return place ? SuiteJson(*place) : SuiteJson(nullptr);
  };
  for (const RankedMethod& each : ranking(board))
    json.push_back({{"method", board.methods[each.method]},
                    {kRankingSource, rank(each.source)},
                    {kRankingRepair, rank(each.repair)}});
  return json;
}

/// Returns the standing of each own method; only the sentence if it cannot be ranked.
SuiteJson standing_json(const Leaderboard& board) {
  SuiteJson json = SuiteJson::object();
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    if (!board.is_own(method))
      continue;
    const std::optional<Standing> standing = standing_of(board, method);
    SuiteJson& of_method = json[board.methods[method]];
    of_method["says"] = words_text(standing_sentence(board, method, standing));
    if (!standing)
      continue;
    SuiteJson duels = SuiteJson::array();
    for (const BoardDuel& duel : standing->duels)
      duels.push_back({{"method", board.methods[duel.other]},
                       {"difference", duel.difference.value},
                       {"lower", duel.difference.interval.lower},
                       {"upper", duel.difference.interval.upper},
                       {"p_holm", duel.p_holm},
                       {"loops", duel.loops}});
    of_method.update({{"rate", standing->rate},
                      {"place", standing->place},
                      {"of", standing->duels.size() + 1},
                      {"beats", standing->won()},
                      {"loses_to", standing->lost()},
                      {"duels", duels}});
  }
  return json;
}

/// Returns the ranks of questions_section(), by rate and method.
SuiteJson questions_json(const Leaderboard& board) {
  SuiteJson json = SuiteJson::object();
  for (const std::string_view rate : question_rates())
    for (std::size_t method = 0; method < board.methods.size(); ++method)
      if (const std::optional<int> rank = question_rank(board, method, rate))
        json[std::string(rate)][board.methods[method]] = *rank;
  return json;
}

/// Returns the numbers of information_section().
SuiteJson information_json(const Leaderboard& board) {
  SuiteJson json = SuiteJson::array();
  for (const InformationPair& pair : information_pairs(board))
    for (const std::string_view name : information_rates()) {
      const RateRow& row = row_of(rate_rows(), name);
      const BoardDuel duel = board_duel(board, row, pair.with, pair.without);
      if (duel.loops > 0)
        json.push_back({{"method", pair.method},
                        {"rate", name},
                        {"without", board.overall[pair.without].rates.of(row).value},
                        {"with", board.overall[pair.with].rates.of(row).value},
                        {"difference", duel.difference.value},
                        {"lower", duel.difference.interval.lower},
                        {"upper", duel.difference.interval.upper},
                        {"loops", duel.loops}});
    }
  return json;
}

/// Returns the delays and false alarms of each method on the moving windows of a cell.
SuiteJson delays_json(const Leaderboard& board, const CellScores& cell) {
  SuiteJson json{{"time_unit", cell.time_unit}, {"methods", SuiteJson::object()}};
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    for (const char* const name : {"detection_delay", "false_alarms_a_day"})
      json["methods"][board.methods[method]][name] = estimate_json(cell.methods[method].estimates[name]);
  return json;
}

SuiteJson cells_json(const Leaderboard& board) {
  SuiteJson cells = SuiteJson::array();
  for (const CellScores& cell : board.cells) {
    cells.push_back({{"plant", board.plants[cell.plant].name},
                     {"family", board.families[cell.family].name},
                     {"seed", cell.seed},
                     {"experiments", cell.experiments},
                     {"failed", cell.failed},
                     {"infeasible", cell.infeasible},
                     {"trouble", proper_utf8(cell.trouble)}});
    if (cell.monitored && cell.trouble.empty())
      cells.back()["delays"] = delays_json(board, cell);
  }
  return cells;
}

}  // namespace

std::string leaderboard_json(const Leaderboard& board) {
  SuiteJson methods = SuiteJson::array(), meanings = SuiteJson::object(), nobody = SuiteJson::object();
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    methods.push_back({{"name", board.methods[method]},
                       {"all", scores_json(board, board.overall[method])},
                       {"families", along(board, board.families, board.by_family[method])},
                       {"plants", along(board, board.plants, board.by_plant[method])}});
  for (const RateRow& row : rate_rows())
    if (has_number(board, row.of))
      meanings[row.name] = row.meaning;
  SuiteJson headings = SuiteJson::object(), columns = SuiteJson::array();
  for (const MethodNumber& number : method_numbers())
    headings[number.name] = number.heading;
  for (const BoardColumn& column : board_columns(board))
    columns.push_back(column.name);
  for (const LeaderboardTask task : kLeaderboardTasks)
    nobody[std::string(to_string(task))] = passed_by_nobody(board, task);
  SuiteJson json{{"suite", board.suite},
                 {"version", board.version},
                 {"title", proper_utf8(board.title)},
                 {"seed", board.seed},
                 {"mpmbench_version", board.program},
                 {"confidence", board.confidence},
                 {"plants", axis_json(board.plants)},
                 {"families", axis_json(board.families)},
                 {"rates", meanings},
                 {"headings", headings},
                 {"columns", columns},
                 {"passed_by_nobody", nobody},
                 {"cells", cells_json(board)},
                 {"methods", methods}};
  if (board.in_worlds()) {
    json["ranking"] = ranking_json(board);
    json["questions"] = questions_json(board);
  }
  if (const auto frequencies = source_frequencies(board); frequencies && !stating_methods(board).empty())
    json["forecast"] = forecast_json(board, *frequencies);
  if (!information_pairs(board).empty())
    json["information"] = information_json(board);
  if (!board.finished_by.empty())
    json["finished_by"] = board.finished_by;
  if (!board.own.empty()) {
    json["own"] = board.own;
    json["standing"] = standing_json(board);
  }
  return json_text(json, 1);
}

}  // namespace mpm
