#include "results/suite/board_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_file.hpp"
#include "analysis/statistics/clustered_rate.hpp"
#include "analysis/study_files/resolved_study.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/sha256.hpp"
#include "base/system/foreign_text.hpp"
#include "base/system/json_entry.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/suite/board_letters.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

using BoardJson = nlohmann::ordered_json;

constexpr const char* kBoardEnding = ".board.json";
constexpr const char* kFormat = "mpmbench board 1";
constexpr auto kReplace = BoardJson::error_handler_t::replace;  // for bytes that are not UTF-8
constexpr std::int64_t kMostLoops = 100'000;                    // in a cell
constexpr std::int64_t kTextsOfQuestions = 5;                   // all facts except LoopOutcome::told

/// Means of shares, which the file stores as sums over each world.
struct KeptMean {
  const char* name;
  /// Tells whether the loop can have such a share.
  bool (*counts)(const FaultTruth& truth, const LoopOutcome& said);
};
constexpr KeptMean kMeans[] = {
    {kRankingRepair.data(), [](const FaultTruth& truth, const LoopOutcome&) { return truth.impact; }},
    {"repair_gain_share", [](const FaultTruth& truth, const LoopOutcome&) { return truth.impact; }},
    {"log_score", [](const FaultTruth&, const LoopOutcome& said) { return said.answered; }},
    {"brier_score", [](const FaultTruth&, const LoopOutcome& said) { return said.answered; }}};
constexpr const char* kReliability = "reliability";
constexpr const char* kDelays[] = {"detection_delay", "false_alarms_a_day"};

/// Returns a digest of the study of a cell, with every default written out. Two versions of the program give
/// the same digest exactly if the study means the same: a key that was added later counts only where it is
/// used.
std::string study_digest(const SuiteCell& cell) {
  const std::string text = lasting_text(cell.study);
  return sha256(std::as_bytes(std::span(text)));
}

/// Returns the key of text number `text` of the outcomes: "outcomes", "outcomes_2", ...
std::string outcome_key(std::size_t text) {
  return text == 0 ? "outcomes" : fmt::format("outcomes_{}", text + 1);
}

constexpr std::pair<const char*, bool OutcomeScope::*> kThresholdFlags[] = {
    {"at_05", &OutcomeScope::at_05},
    {"at_chosen", &OutcomeScope::at_chosen},
    {"at_01", &OutcomeScope::at_01},
    {"at_not_mpm", &OutcomeScope::at_not_mpm}};

// Writing.

/// Rounds to four digits. A value that JSON cannot write as a number becomes a word or null.
BoardJson rounded(double value) {
  if (std::isnan(value))
    return nullptr;
  if (std::isinf(value))
    return value > 0 ? "Infinity" : "-Infinity";
  return std::stod(fmt::format("{:.4g}", value));
}

/// Writes [sum, number of values] for each world.
BoardJson clusters_json(const Estimate& estimate) {
  BoardJson clusters = BoardJson::array();
  for (const ClusterSum& cluster : estimate.clusters)
    clusters.push_back({rounded(cluster.sum), cluster.count});
  return clusters;
}

/// Returns how many texts of outcomes are known for every method. A method read from an older file has fewer.
std::size_t known_texts(const Leaderboard& board) {
  std::size_t texts = outcome_text_count();
  for (const CellScores& cell : board.cells)
    for (const MethodScores& scores : cell.methods)
      texts = scores.scope.is_told    ? texts
              : scores.scope.is_whole ? std::min<std::size_t>(texts, kTextsOfQuestions)
                                      : 1;
  return texts;
}

BoardJson scores_json(const CellScores& cell, const MethodScores& scores) {
  BoardJson json;
  const std::vector<std::string> texts = outcome_letters(scores.outcomes);
  for (std::size_t text = 0; text < texts.size(); ++text)
    if (text == 0 || texts[text].find_first_not_of("A-") != std::string::npos)
      json[outcome_key(text)] = texts[text];
  for (const auto& [key, flag] : kThresholdFlags)
    if (scores.scope.*flag)
      json[key] = true;
  if (scores.failed > 0)
    json["failed"] = scores.failed;
  if (!scores.reason.empty())
    json["reason"] = proper_utf8(scores.reason);
  for (const KeptMean& mean : kMeans)
    if (const Estimate& found = scores.estimates[mean.name]; found.count > 0)
      json[mean.name] = clusters_json(found);
  if (scores.reliability.count() > 0)
    for (const Reliability::Bin& bin : scores.reliability.bins())
      json[kReliability].push_back({rounded(bin.stated), bin.count, bin.right});
  if (cell.monitored)
    for (const char* const name : kDelays)
      if (const Estimate& found = scores.estimates[name]; found.count > 0)
        json[name] = {rounded(found.value), rounded(found.interval.lower), rounded(found.interval.upper),
                      found.count};
  return json;
}

BoardJson cell_json(const Leaderboard& board, const CellScores& cell, const SuiteCell& of) {
  BoardJson json{{"plant", board.plants[cell.plant].name},
                 {"family", board.families[cell.family].name},
                 {"study", study_digest(of)},
                 {"experiments", cell.experiments},
                 {"failed", cell.failed},
                 {"infeasible", cell.infeasible}};
  if (!cell.trouble.empty()) {
    json["trouble"] = proper_utf8(cell.trouble);
    return json;
  }
  json["truths"] = truth_letters(cell.truths);
  json["worlds"] = cell.worlds;
  json["methods"] = BoardJson::object();
  for (std::size_t method = 0; method < board.methods.size(); ++method)
    json["methods"][board.methods[method]] = scores_json(cell, cell.methods[method]);
  return json;
}

BoardJson methods_json(const Leaderboard& board) {
  BoardJson methods = BoardJson::array();
  for (std::size_t method = 0; method < board.methods.size(); ++method) {
    const auto tells = [&](bool OutcomeScope::*what) {
      return std::any_of(board.cells.begin(), board.cells.end(), [&](const CellScores& cell) {
        return cell.trouble.empty() && cell.methods[method].scope.*what;
      });
    };
    methods.push_back({{"name", board.methods[method]},
                       {"cv", tells(&OutcomeScope::locates_cvs)},
                       {"source", tells(&OutcomeScope::tells_sources)}});
  }
  return methods;
}

// Reading.

/// Returns printable ASCII, for terminals, pages and tables.
std::string words_in(const JsonEntry& entry) {
  return foreign_text(entry.text(), JsonEntry::kMostText);
}

/// Reads a value that rounded() wrote.
double rounded_in(const JsonEntry& entry) {
  if (entry.json().is_null())
    return kNaN;
  if (entry.json() == "Infinity" || entry.json() == "-Infinity")
    return entry.json() == "Infinity" ? kInfinity : -kInfinity;
  entry.require(entry.json().is_number(), "a number, null, \"Infinity\" or \"-Infinity\"");
  return entry.number();
}

/// Reads one letter for each of `loops` loops.
std::string letters_in(const JsonEntry& entry, std::size_t loops) {
  entry.require(entry.json().is_string() && entry.json().get_ref<const std::string&>().size() == loops,
                fmt::format("a text of {} letters, one for each loop", loops));
  return entry.json().get<std::string>();
}

[[noreturn]] void refuse_letter(const JsonEntry& entry, std::size_t loop, char letter, const char* what) {
  throw InputError(fmt::format("{}, loop {}", entry.place(), loop),
                   fmt::format("'{}'", foreign_text(std::string(1, letter), kShownBytes)),
                   fmt::format("{}, or '{}'", what, kNoLoop));
}

/// What the suite draws for the loops of a cell: their whole truth, except for what they cost.
struct DrawnLoops {
  std::vector<FaultTruth> truths = {};  ///< without `impact`
  std::vector<int> worlds = {};
};

DrawnLoops drawn_loops(const Study& study, std::int64_t experiments) {
  DrawnLoops drawn;
  for (std::int64_t i = 0; i < experiments; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    drawn.truths.push_back({.kind = draw.kind,
                            .one_cv = !is_faultless(draw.kind) && draw.true_cv() >= 0,
                            .about = draw.other ? told_source(*draw.other) : ToldSource::other});
    drawn.worlds.push_back(draw.world);
  }
  return drawn;
}

/// Reads [sum, number of values] for each world.
Estimate mean_in(const JsonEntry& entry, const KeptMean& mean, const CellScores& cell,
                 const LoopOutcomes& outcomes, double confidence) {
  std::vector<std::int64_t> most;  // in each world: the loops that may have a share
  for (std::size_t i = 0; i < cell.truths.size(); ++i) {
    const auto world = static_cast<std::size_t>(std::int64_t{cell.worlds[i]} + 1);
    most.resize(std::max(most.size(), world + 1));
    most[world] += cell.truths[i] && outcomes[i] && mean.counts(*cell.truths[i], *outcomes[i]) ? 1 : 0;
  }
  const std::vector<JsonEntry> list = entry.list();
  entry.require(list.size() <= most.size(), fmt::format("at most {}, one for each world", most.size()));
  std::vector<ClusterSum> clusters;
  for (const JsonEntry& cluster : list) {
    const std::vector<JsonEntry> pair = cluster.list();
    cluster.require(pair.size() == 2, "a sum and the number of its values");
    const std::int64_t count = pair[1].whole(0, most[clusters.size()]);
    // Each value is a share between 0 and 1; sums are rounded.
    const double sum = pair[0].number(0.0, static_cast<double>(count) * 1.001);
    clusters.push_back({sum, count});
  }
  return clustered_mean(std::move(clusters), confidence);
}

/// Reads [sum of the stated probabilities, number of loops, how many of them are right] for each bin. The
/// bins have `loops` loops together.
Reliability reliability_in(const JsonEntry& entry, std::int64_t loops) {
  const std::vector<JsonEntry> list = entry.list();
  entry.require(list.size() == Reliability::kBins, fmt::format("{} bins", Reliability::kBins));
  constexpr double kRounding = 1.001;
  std::array<Reliability::Bin, Reliability::kBins> bins{};
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const std::vector<JsonEntry> parts = list[i].list();
    list[i].require(parts.size() == 3, "a sum, the number of its loops, and how many of them are right");
    Reliability::Bin& bin = bins[i];
    bin.count = parts[1].whole(0, loops);
    bin.right = parts[2].whole(0, bin.count);
    const double lower = static_cast<double>(bin.count) * static_cast<double>(i) / Reliability::kBins,
                 upper = lower + static_cast<double>(bin.count) / Reliability::kBins;
    bin.stated = parts[0].number(lower / kRounding, upper * kRounding);
  }
  Reliability reliability(bins);
  entry.require(reliability.count() == loops, fmt::format("{} loops, those of log_score", loops));
  return reliability;
}

/// Reads the delay in a cell in which methods watch moving windows.
Estimate delay_in(const JsonEntry& entry, const Study& study, std::size_t loops) {
  entry.require(study.monitoring.has_value(), "nothing: the cell has no moving windows");
  const std::vector<JsonEntry> parts = entry.list();
  entry.require(parts.size() == 4, "a value, both ends of its interval, and the number of loops");
  const std::int64_t most =
      static_cast<std::int64_t>(loops) * study.monitoring->count(study.simulation.samples);
  Estimate delay{rounded_in(parts[0]), {rounded_in(parts[1]), rounded_in(parts[2])}, parts[3].whole(1, most)};
  parts[0].require(delay.value >= 0.0, "a number from 0 on, or \"Infinity\"");
  const auto& [lower, upper] = delay.interval;
  entry.require(!(lower < 0.0) && !(lower > delay.value) && !(upper < delay.value),
                "an interval that holds the value");
  return delay;
}

/// Reads what a method with this scope said about the loops of a cell.
LoopOutcomes outcomes_in(const JsonEntry& entry, const CellScores& cell, const OutcomeScope& scope) {
  const std::size_t loops = cell.truths.size(), count = outcome_text_count();
  std::vector<std::string> texts{letters_in(entry.at(outcome_key(0)), loops)};
  for (std::size_t text = 1; text < count; ++text)
    texts.push_back(entry.has(outcome_key(text)) ? letters_in(entry.at(outcome_key(text)), loops)
                                                 : std::string(loops, 'A'));
  LoopOutcomes outcomes;
  for (std::size_t loop = 0; loop < loops; ++loop) {
    std::string letters;
    for (const std::string& text : texts)
      letters += text[loop] == kNoLoop ? "" : text.substr(loop, 1);
    if (texts[0][loop] == kNoLoop) {
      outcomes.emplace_back();
      continue;
    }
    const std::optional<LoopOutcome> outcome = loop_outcome(letters);
    if (!outcome || letters.size() != count || !cell.truths[loop] ||
        !is_possible(*outcome, *cell.truths[loop], scope))
      refuse_letter(entry.at(outcome_key(0)), loop, texts[0][loop],
                    "letters of an outcome that such a method can have on such a loop");
    outcomes.push_back(outcome);
  }
  return outcomes;
}

MethodScores scores_in(const JsonEntry& entry, const CellScores& cell, const Study& study, OutcomeScope scope,
                       std::size_t texts) {
  std::vector<std::string> keys{"failed", "reason", kReliability, kDelays[0], kDelays[1]};
  for (const KeptMean& mean : kMeans)
    keys.emplace_back(mean.name);
  for (std::size_t text = 0; text < texts; ++text)
    keys.push_back(outcome_key(text));
  for (const auto& [key, flag] : kThresholdFlags) {
    keys.emplace_back(key);
    if (entry.has(key)) {
      scope.*flag = entry.at(key).flag();
      entry.at(key).require(!(scope.*flag) || study.calibration, "false: the study has no calibration");
    }
  }
  entry.require_keys(keys);
  scope.in_worlds = cell.in_worlds;
  scope.chosen_is_05 = study.calibration && study.calibration->false_alarms == 0.05;
  const LoopOutcomes outcomes = outcomes_in(entry, cell, scope);
  MethodScores scores = scores_of_outcomes(cell, outcomes, scope);
  if (entry.has("failed"))
    scores.failed = entry.at("failed").whole(0, std::count(outcomes.begin(), outcomes.end(), LoopOutcome{}));
  if (entry.has("reason"))
    scores.reason = words_in(entry.at("reason"));
  for (const KeptMean& mean : kMeans)
    if (entry.has(mean.name))
      scores.estimates[mean.name] =
          mean_in(entry.at(mean.name), mean, cell, outcomes, study.aggregate.confidence);
  if (entry.has(kReliability))
    scores.reliability = reliability_in(entry.at(kReliability), scores.estimates["log_score"].count);
  for (const char* const name : kDelays)
    if (entry.has(name))
      scores.estimates[name] = delay_in(entry.at(name), study, cell.truths.size());
  return scores;
}

struct BoardMethod {
  std::string name;
  OutcomeScope scope;
  std::size_t texts;  ///< how many texts its outcomes have
};

/// `texts`: how many texts the file has for each method.
std::vector<BoardMethod> methods_in(const JsonEntry& entry, std::int64_t texts) {
  std::vector<BoardMethod> methods;
  for (const JsonEntry& method : entry.list()) {
    method.require_keys({"name", "cv", "source"});
    const std::string name = method.at("name").text();
    method.at("name").require(is_answering_name(name), kMethodNameRule);
    method.at("name").require(std::none_of(methods.begin(), methods.end(),
                                           [&](const BoardMethod& each) { return each.name == name; }),
                              "each method once");
    methods.push_back({name,
                       {.locates_cvs = method.at("cv").flag(),
                        .tells_sources = method.at("source").flag(),
                        .is_whole = texts >= kTextsOfQuestions,
                        .is_told = texts > kTextsOfQuestions},
                       static_cast<std::size_t>(texts)});
  }
  entry.require(!methods.empty(), "at least one method");
  return methods;
}

/// Reads the loops, which must be those that the suite draws.
void read_loops(const JsonEntry& entry, const DrawnLoops& drawn, CellScores& cell) {
  const std::size_t loops = drawn.truths.size();
  const std::string letters = letters_in(entry.at("truths"), loops);
  for (std::size_t loop = 0; loop < loops; ++loop) {
    std::optional<FaultTruth> truth = fault_truth(letters[loop]);
    if (letters[loop] != kNoLoop &&
        !(truth && truth->kind == drawn.truths[loop].kind && truth->one_cv == drawn.truths[loop].one_cv))
      refuse_letter(entry.at("truths"), loop, letters[loop],
                    "a letter of the fault that the suite draws for the loop");
    if (truth)
      truth->about = drawn.truths[loop].about;
    cell.truths.push_back(truth);
  }
  const auto unseen = std::count(cell.truths.begin(), cell.truths.end(), std::nullopt);
  entry.at("failed").require(
      cell.failed + cell.infeasible <= unseen,
      fmt::format("with `infeasible` at most {}, the loops that nobody has seen", unseen));
  const std::vector<JsonEntry> worlds = entry.at("worlds").list();
  entry.at("worlds").require(worlds.size() == loops, fmt::format("{} worlds, one for each loop", loops));
  for (std::size_t i = 0; i < loops; ++i)
    worlds[i].require(worlds[i].whole(-1) == drawn.worlds[i],
                      fmt::format("{}, the world of this loop", drawn.worlds[i]));
  cell.worlds = drawn.worlds;
}

/// Reads the number of experiments of a run: all of the suite, or the first ones of the cell. It is 0 for a
/// cell that could not be run.
std::int64_t experiments_in(const JsonEntry& entry, const Study& study, bool was_run) {
  const std::int64_t most = study.names_scenarios() ? study.experiment_count() : kMostLoops;
  const std::int64_t experiments = entry.at("experiments").whole(0, was_run ? most : 0);
  for (const char* const key : {"failed", "infeasible"})
    entry.at(key).whole(0, experiments);
  if (was_run)
    entry.at("truths").require(entry.at("truths").json().is_string() &&
                                   entry.at("truths").json().get_ref<const std::string&>().size() ==
                                       static_cast<std::size_t>(experiments),
                               fmt::format("a text of {} letters, one for each experiment", experiments));
  return experiments;
}

CellScores cell_in(const JsonEntry& entry, const SuiteCell& of, const std::vector<BoardMethod>& methods) {
  const std::string digest = study_digest(of);
  entry.at("study").require(
      entry.at("study").text() == digest,
      fmt::format("{}, the SHA-256 of the study that this program has for the cell: the board is of another "
                  "suite or another version of the program",
                  digest));
  const bool was_run = !entry.has("trouble");
  CellScores cell{.plant = of.plant,
                  .family = of.family,
                  .seed = of.study.seed,
                  .time_unit = of.study.plant.time_unit,
                  .monitored = of.study.monitoring.has_value(),
                  .in_worlds = of.study.world.has_value(),
                  .experiments = experiments_in(entry, of.study, was_run),
                  .failed = entry.at("failed").whole(),
                  .infeasible = entry.at("infeasible").whole()};
  if (!was_run) {
    cell.trouble = words_in(entry.at("trouble"));
    entry.at("trouble").require(!cell.trouble.empty(), "why the cell could not be run");
    return cell;
  }
  read_loops(entry, drawn_loops(of.study, cell.experiments), cell);
  std::vector<std::string> names;
  for (const BoardMethod& method : methods)
    names.push_back(method.name);
  entry.at("methods").require_keys(names);
  for (const BoardMethod& method : methods)
    cell.methods.push_back(
        scores_in(entry.at("methods").at(method.name), cell, of.study, method.scope, method.texts));
  return cell;
}

/// Returns the cell with these names, in the whole suite or a part of it; null if it was left out.
const SuiteCell* cell_of(const Suite& suite, const std::string& plant, const std::string& family) {
  const auto found = std::find_if(suite.cells.begin(), suite.cells.end(), [&](const SuiteCell& cell) {
    return suite.plants[cell.plant].name == plant && suite.families[cell.family].name == family;
  });
  return found == suite.cells.end() ? nullptr : &*found;
}

/// Returns the position of a name, which the suite must have.
std::size_t axis_place(const std::vector<SuiteAxis>& axis, const JsonEntry& name) {
  std::vector<std::string> names;
  for (const SuiteAxis& each : axis)
    names.push_back(each.name);
  const auto found = std::find(names.begin(), names.end(), name.text());
  name.require(found != names.end(), fmt::format("{}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

/// Returns the cell that an entry is about; null if this part of the suite leaves its plant or family out.
const SuiteCell* cell_of(const Suite& suite, const JsonEntry& entry) {
  const std::size_t plant = axis_place(suite.plants, entry.at("plant")),
                    family = axis_place(suite.families, entry.at("family"));
  const auto has = [&suite](auto same) { return std::any_of(suite.cells.begin(), suite.cells.end(), same); };
  const SuiteCell* const found = cell_of(suite, suite.plants[plant].name, suite.families[family].name);
  entry.at("family").require(
      found != nullptr || !has([=](const SuiteCell& cell) { return cell.plant == plant; }) ||
          !has([=](const SuiteCell& cell) { return cell.family == family; }),
      fmt::format("a family in which the suite has the plant {}", suite.plants[plant].name));
  return found;
}

BoardJson board_json(const std::filesystem::path& path) {
  return parsed_json(foreign_content(path, "the board of a suite"), path.string(),
                     "the board that `mpmbench suite` writes");
}

FinishedBoard board_in(const JsonEntry& entry, const Suite& suite) {
  entry.require_keys({"format", "suite", "version", "seed", "mpmbench_version", "revision", "outcome_texts",
                      "methods", "cells"});
  const auto same = [&entry](const char* key, const std::string& expected) {
    entry.at(key).require(entry.at(key).text() == expected, fmt::format("\"{}\"", expected));
  };
  same("format", kFormat);
  same("suite", suite.name);
  same("version", suite.version);
  entry.at("seed").require(static_cast<std::uint64_t>(entry.at("seed").whole()) == suite.seed,
                           fmt::to_string(suite.seed));
  FinishedBoard board{words_in(entry.at("mpmbench_version")), words_in(entry.at("revision"))};
  const std::int64_t texts =
      entry.has("outcome_texts")
          ? entry.at("outcome_texts").whole(1, static_cast<std::int64_t>(outcome_text_count()))
          : 1;
  const std::vector<BoardMethod> methods = methods_in(entry.at("methods"), texts);
  for (const BoardMethod& method : methods)
    board.methods.push_back(method.name);
  for (const JsonEntry& cell : entry.at("cells").list()) {
    cell.require_keys({"plant", "family", "study", "experiments", "failed", "infeasible", "trouble", "truths",
                       "worlds", "methods"});
    const SuiteCell* const of = cell_of(suite, cell);
    if (of == nullptr)
      continue;
    cell.at("family").require(std::none_of(board.cells.begin(), board.cells.end(),
                                           [of](const CellScores& each) {
                                             return each.plant == of->plant && each.family == of->family;
                                           }),
                              "each cell once");
    board.cells.push_back(cell_in(cell, *of, methods));
  }
  return board;
}

}  // namespace

std::string board_file_name(const Suite& suite) {
  return suite.name + kBoardEnding;
}

std::string board_text(const Suite& suite, const Leaderboard& board, const std::string& revision) {
  const BoardJson head{{"format", kFormat},
                       {"suite", board.suite},
                       {"version", board.version},
                       {"seed", board.seed},
                       {"mpmbench_version", board.program},
                       {"revision", revision},
                       {"outcome_texts", known_texts(board)}};
  std::string text = "{\n";
  for (const auto& [key, value] : head.items())
    text += fmt::format("\"{}\": {},\n", key, value.dump());
  const auto add_lines = [&text](const char* key, const std::vector<std::string>& lines) {
    text += fmt::format("\"{}\": [\n{}\n]", key, fmt::join(lines, ",\n"));
  };
  std::vector<std::string> methods, cells;
  for (const BoardJson& method : methods_json(board))
    methods.push_back(method.dump());
  for (const CellScores& cell : board.cells)
    cells.push_back(
        cell_json(board, cell,
                  *cell_of(suite, board.plants[cell.plant].name, board.families[cell.family].name))
            .dump());
  add_lines("methods", methods);
  text += ",\n";
  add_lines("cells", cells);
  return text + "\n}\n";
}

std::filesystem::path finished_board_path(const Suite& suite) {
  std::filesystem::path path = suite.path;
  return path.replace_extension(kBoardEnding);
}

std::optional<std::filesystem::path> find_board(const std::filesystem::path& path) {
  const auto is_board = [](const std::filesystem::path& file) {
    return file.filename().string().ends_with(kBoardEnding);
  };
  if (is_board(path))
    return path;
  std::optional<std::filesystem::path> found;
  std::error_code no_folder;
  for (const auto& entry : std::filesystem::directory_iterator(path, no_folder))
    if (is_board(entry.path())) {
      if (found)
        throw InputError(path.string(), "boards of several suites", "the board of one of them");
      found = entry.path();
    }
  return found;
}

BoardHeading board_heading(const std::filesystem::path& path) {
  const BoardJson json = board_json(path);
  const JsonEntry entry(json, path.string());
  return {words_in(entry.at("suite")), static_cast<std::uint64_t>(entry.at("seed").whole())};
}

FinishedBoard read_board(const std::filesystem::path& path, const Suite& suite) {
  const BoardJson json = board_json(path);
  return board_in({json, path.string()}, suite);
}

Leaderboard leaderboard_of(const Suite& suite, FinishedBoard finished) {
  Leaderboard board = make_leaderboard(suite, finished.methods, finished.program, std::move(finished.cells));
  board.finished_by = finished.runner();
  return board;
}

}  // namespace mpm
