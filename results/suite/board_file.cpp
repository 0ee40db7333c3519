#include "results/suite/board_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/clustered_rate.hpp"
#include "analysis/study_files/resolved_study.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system/foreign_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

using BoardJson = nlohmann::ordered_json;

constexpr const char* kBoardEnding = ".board.json";
constexpr const char* kFormat = "mpmbench board 1";
constexpr auto kReplace = BoardJson::error_handler_t::replace;  // what is no UTF-8
constexpr std::size_t kLongestWord = 2000;                      // bytes of a name or a reason
constexpr const char* kRepairGains[] = {kRankingRepair.data(), "repair_gain_share"};
constexpr const char* kDelays[] = {"detection_delay", "false_alarms_a_day"};

/// The study of a cell with every default, so that it is the same in another version of the program only if
/// it means the same.
std::string study_digest(const SuiteCell& cell) {
  const std::string text = resolved_study(cell.study);
  return sha256(std::as_bytes(std::span(text)));
}

std::size_t place_of_estimate(std::string_view name) {
  const auto infos = method_estimate_infos();
  return static_cast<std::size_t>(
      std::find_if(infos.begin(), infos.end(),
                   [name](const MethodEstimateInfo& info) { return info.name == name; }) -
      infos.begin());
}

// What is written.

/// To four digits; what JSON has no number for is a word.
BoardJson rounded(double value) {
  if (std::isnan(value))
    return nullptr;
  if (std::isinf(value))
    return value > 0 ? "Infinity" : "-Infinity";
  return std::stod(fmt::format("{:.4g}", value));
}

/// [sum, number of values] of each world.
BoardJson clusters_json(const Estimate& estimate) {
  BoardJson clusters = BoardJson::array();
  for (const ClusterSum& cluster : estimate.clusters)
    clusters.push_back({rounded(cluster.sum), cluster.count});
  return clusters;
}

BoardJson scores_json(const CellScores& cell, const MethodScores& scores) {
  BoardJson json{{"outcomes", scores.outcomes}};
  if (scores.scope.at_05)
    json["at_05"] = true;
  if (scores.scope.at_chosen)
    json["at_chosen"] = true;
  if (!scores.reason.empty())
    json["reason"] = proper_utf8(scores.reason);
  for (const char* const name : kRepairGains)
    if (const Estimate gain = scores.estimate(name); gain.count > 0)
      json[name] = clusters_json(gain);
  if (cell.monitored)
    for (const char* const name : kDelays)
      if (const Estimate found = scores.estimate(name); found.count > 0)
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
  json["truths"] = cell.truths;
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

// What is read.

/// A value of the file, and where it stands.
class BoardEntry {
 public:
  BoardEntry(const BoardJson& value, std::string place) : value_(value), place_(std::move(place)) {}

  [[noreturn]] void refuse(const std::string& allowed) const {
    throw InputError(place_,
                     value_.is_structured() ? fmt::format("{} of {}", value_.type_name(), value_.size())
                                            : foreign_text(value_.dump(-1, ' ', true, kReplace), kShownBytes),
                     allowed);
  }

  void require_keys(const std::vector<std::string>& known) const {
    if (!value_.is_object())
      refuse("an object");
    for (const auto& item : value_.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        throw InputError(place_, fmt::format("the unknown key '{}'", foreign_text(item.key(), kShownBytes)),
                         fmt::format("{}", fmt::join(known, ", ")));
  }
  bool has(const char* key) const { return value_.contains(key); }
  BoardEntry at(const std::string& key) const {
    if (!value_.is_object() || !value_.contains(key))
      throw InputError(place_, fmt::format("no '{}'", foreign_text(key, kShownBytes)), "an object with it");
    return {value_.at(key), fmt::format("{}: {}", place_, key)};
  }
  std::vector<BoardEntry> list() const {
    if (!value_.is_array())
      refuse("a list");
    std::vector<BoardEntry> entries;
    for (std::size_t i = 0; i < value_.size(); ++i)
      entries.emplace_back(value_[i], fmt::format("{}[{}]", place_, i));
    return entries;
  }
  std::string text() const {
    if (!value_.is_string() || value_.get_ref<const std::string&>().size() > kLongestWord)
      refuse(fmt::format("a text of at most {} bytes", kLongestWord));
    return foreign_text(value_.get<std::string>(), kLongestWord);
  }
  bool flag() const {
    if (!value_.is_boolean())
      refuse("true or false");
    return value_.get<bool>();
  }
  std::int64_t whole(std::int64_t least = 0) const {
    constexpr std::int64_t kMost = std::int64_t{1} << 53U;
    if (!value_.is_number_integer() || (value_.is_number_unsigned() && value_.get<std::uint64_t>() > kMost) ||
        value_.get<std::int64_t>() < least || value_.get<std::int64_t>() > kMost)
      refuse(fmt::format("a whole number from {} on", least));
    return value_.get<std::int64_t>();
  }
  /// As rounded() writes it.
  double number() const {
    if (value_.is_null())
      return kNaN;
    if (value_ == "Infinity" || value_ == "-Infinity")
      return (value_ == "Infinity" ? 1 : -1) * std::numeric_limits<double>::infinity();
    if (!value_.is_number() || !std::isfinite(value_.get<double>()))
      refuse("a number, null, \"Infinity\" or \"-Infinity\"");
    return value_.get<double>();
  }
  /// One letter a loop, each of which `is_known`.
  std::string letters(const std::function<bool(char)>& is_known, const char* what) const {
    if (!value_.is_string())
      refuse("a text with a letter for each loop");
    auto letters = value_.get<std::string>();
    for (std::size_t i = 0; i < letters.size(); ++i)
      if (letters[i] != kNoLoop && !is_known(letters[i]))
        throw InputError(fmt::format("{}, loop {}", place_, i),
                         fmt::format("'{}'", foreign_text(letters.substr(i, 1), kShownBytes)),
                         fmt::format("{}, or '{}'", what, kNoLoop));
    return letters;
  }
  void require(bool holds, const std::string& allowed) const {
    if (!holds)
      refuse(allowed);
  }

 private:
  const BoardJson& value_;
  std::string place_;
};

Estimate gain_in(const BoardEntry& entry, double confidence) {
  std::vector<ClusterSum> clusters;
  for (const BoardEntry& cluster : entry.list()) {
    const std::vector<BoardEntry> pair = cluster.list();
    cluster.require(pair.size() == 2, "a sum and the number of its values");
    const double sum = pair[0].number();
    const std::int64_t count = pair[1].whole();
    // Each value is a share between 0 and 1; sums are rounded.
    pair[0].require(sum >= 0 && sum <= static_cast<double>(count) * 1.001,
                    fmt::format("a sum of {} shares between 0 and 1", count));
    clusters.push_back({sum, count});
  }
  return clustered_mean(std::move(clusters), confidence);
}

Estimate delay_in(const BoardEntry& entry) {
  const std::vector<BoardEntry> parts = entry.list();
  entry.require(parts.size() == 4, "a value, both ends of its interval, and the number of loops");
  return {parts[0].number(), {parts[1].number(), parts[2].number()}, parts[3].whole()};
}

MethodScores scores_in(const BoardEntry& entry, const CellScores& cell, OutcomeScope scope,
                       double confidence) {
  entry.require_keys(
      {"outcomes", "at_05", "at_chosen", "reason", kRepairGains[0], kRepairGains[1], kDelays[0], kDelays[1]});
  scope.at_05 = entry.has("at_05") && entry.at("at_05").flag();
  scope.at_chosen = entry.has("at_chosen") && entry.at("at_chosen").flag();
  scope.in_worlds = cell.in_worlds;
  const std::string outcomes = entry.at("outcomes")
                                   .letters([](char letter) { return loop_outcome(letter).has_value(); },
                                            "a letter that an outcome has");
  entry.at("outcomes")
      .require(outcomes.size() == cell.truths.size(),
               fmt::format("{} letters, one for each loop", cell.truths.size()));
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    entry.at("outcomes")
        .require(cell.truths[i] != kNoLoop || outcomes[i] == kNoLoop,
                 fmt::format("'{}' of loop {}, which nobody has seen", kNoLoop, i));
  MethodScores scores = scores_of_outcomes(cell, outcomes, scope);
  if (entry.has("reason"))
    scores.reason = entry.at("reason").text();
  for (const char* const name : kRepairGains)
    if (entry.has(name))
      scores.estimates[place_of_estimate(name)] = gain_in(entry.at(name), confidence);
  for (const char* const name : kDelays)
    if (entry.has(name))
      scores.estimates[place_of_estimate(name)] = delay_in(entry.at(name));
  return scores;
}

struct BoardMethod {
  std::string name;
  OutcomeScope scope;
};

std::vector<BoardMethod> methods_in(const BoardEntry& entry) {
  std::vector<BoardMethod> methods;
  for (const BoardEntry& method : entry.list()) {
    method.require_keys({"name", "cv", "source"});
    const std::string name = method.at("name").text();
    method.at("name").require(std::none_of(methods.begin(), methods.end(),
                                           [&](const BoardMethod& each) { return each.name == name; }),
                              "each method once");
    methods.push_back(
        {name, {.locates_cvs = method.at("cv").flag(), .tells_sources = method.at("source").flag()}});
  }
  entry.require(!methods.empty(), "at least one method");
  return methods;
}

void read_loops(const BoardEntry& entry, CellScores& cell) {
  cell.truths = entry.at("truths").letters([](char letter) { return fault_truth(letter).has_value(); },
                                           "a letter that a truth has");
  entry.at("truths").require(static_cast<std::int64_t>(cell.truths.size()) <= cell.experiments,
                             fmt::format("at most {} letters, one for each experiment", cell.experiments));
  constexpr int kMostWorlds = 1'000'000;
  for (const BoardEntry& world : entry.at("worlds").list()) {
    const std::int64_t number = world.whole(-1);
    world.require(number < kMostWorlds, fmt::format("a world below {}", kMostWorlds));
    cell.worlds.push_back(static_cast<int>(number));
  }
  entry.at("worlds").require(cell.worlds.size() == cell.truths.size(),
                             fmt::format("{} worlds, one for each loop", cell.truths.size()));
}

CellScores cell_in(const BoardEntry& entry, const SuiteCell& of, const std::vector<BoardMethod>& methods) {
  const std::string digest = study_digest(of);
  entry.at("study").require(
      entry.at("study").text() == digest,
      fmt::format("{}, the SHA-256 of the study that this program has for the cell: the board is of another "
                  "suite or another version of the program",
                  digest));
  CellScores cell{.plant = of.plant,
                  .family = of.family,
                  .seed = of.study.seed,
                  .time_unit = of.study.plant.time_unit,
                  .monitored = of.study.monitoring.has_value(),
                  .in_worlds = of.study.world.has_value(),
                  .experiments = entry.at("experiments").whole(),
                  .failed = entry.at("failed").whole(),
                  .infeasible = entry.at("infeasible").whole()};
  if (entry.has("trouble")) {
    cell.trouble = entry.at("trouble").text();
    return cell;
  }
  read_loops(entry, cell);
  std::vector<std::string> names;
  for (const BoardMethod& method : methods)
    names.push_back(method.name);
  entry.at("methods").require_keys(names);
  for (const BoardMethod& method : methods)
    cell.methods.push_back(
        scores_in(entry.at("methods").at(method.name), cell, method.scope, of.study.aggregate.confidence));
  return cell;
}

/// Of the whole suite or of a part of it, the cell of these names; null where it was left out.
const SuiteCell* cell_of(const Suite& suite, const std::string& plant, const std::string& family) {
  const auto found = std::find_if(suite.cells.begin(), suite.cells.end(), [&](const SuiteCell& cell) {
    return suite.plants[cell.plant].name == plant && suite.families[cell.family].name == family;
  });
  return found == suite.cells.end() ? nullptr : &*found;
}

BoardJson board_json(const std::filesystem::path& path) {
  BoardJson json = BoardJson::parse(foreign_content(path, "the board of a suite"), nullptr, false);
  if (json.is_discarded())
    throw InputError(path.string(), "no JSON", "the board that `mpmbench suite` writes");
  return json;
}

FinishedBoard board_in(const BoardEntry& entry, const Suite& suite) {
  entry.require_keys(
      {"format", "suite", "version", "seed", "mpmbench_version", "revision", "methods", "cells"});
  const auto same = [&entry](const char* key, const std::string& expected) {
    entry.at(key).require(entry.at(key).text() == expected, fmt::format("\"{}\"", expected));
  };
  same("format", kFormat);
  same("suite", suite.name);
  same("version", suite.version);
  entry.at("seed").require(static_cast<std::uint64_t>(entry.at("seed").whole()) == suite.seed,
                           fmt::to_string(suite.seed));
  FinishedBoard board{entry.at("mpmbench_version").text(), entry.at("revision").text()};
  const std::vector<BoardMethod> methods = methods_in(entry.at("methods"));
  for (const BoardMethod& method : methods)
    board.methods.push_back(method.name);
  for (const BoardEntry& cell : entry.at("cells").list()) {
    cell.require_keys({"plant", "family", "study", "experiments", "failed", "infeasible", "trouble", "truths",
                       "worlds", "methods"});
    const SuiteCell* const of = cell_of(suite, cell.at("plant").text(), cell.at("family").text());
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
                       {"revision", revision}};
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
  const BoardEntry entry(json, path.string());
  return {entry.at("suite").text(), static_cast<std::uint64_t>(entry.at("seed").whole())};
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
