#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/loop_outcome.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/source_confusions.hpp"
#include "analysis/findings/study_findings.hpp"
#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// Of the intervals, unless a reader asks for another one.
inline constexpr double kBoardConfidence = 0.95;

/// How often a method was right on some loops.
struct MethodScores {
  std::string reason;       ///< why there was no verdict on the first loop without one; empty: on every loop
  std::int64_t failed = 0;  ///< loops on which it was asked and failed
  Rates rates = Rates();
  /// For several cells there are only means that keep their clusters: medians cannot be added up.
  Estimates estimates = {};
  /// For one cell: its answer for each loop (MethodRates::outcomes), and the rates that these decide.
  LoopOutcomes outcomes = {};
  OutcomeScope scope = {};
  Reliability reliability = {};  ///< of the probabilities that it states, if it does

  const Rate& operator[](std::string_view rate) const { return rates[rate]; }
};

/// The results of one cell of a suite.
struct CellScores {
  std::size_t plant = 0;   ///< place in Suite::plants
  std::size_t family = 0;  ///< place in Suite::families
  std::uint64_t seed = 0;
  std::string time_unit = {};  ///< of the plant, and of its delays
  bool monitored = false;      ///< methods watched moving windows
  bool in_worlds = false;      ///< its loops take place in worlds drawn at random
  std::string trouble = {};    ///< why it could not be run; empty: it was
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  std::int64_t infeasible = 0;
  LoopTruths truths = {};                  ///< of its loops, as in StudyFindings
  std::vector<int> worlds = {};            ///< the same
  std::vector<MethodScores> methods = {};  ///< in the order of the leaderboard; empty in trouble
};

/// The scores of a cell that was run.
CellScores cell_scores(const SuiteCell& cell, const StudyFindings& findings);

/// The scores that the outcomes of a method on the loops of a cell decide, with the loops of `cell` for
/// truth, as many as outcomes; its estimates are of nothing.
MethodScores scores_of_outcomes(const CellScores& cell, LoopOutcomes outcomes, const OutcomeScope& scope);

/// A method on all cells of a family, or of a plant: hits and loops of the cells are added up, so that each
/// loop counts once, and Wilson's interval is taken of the sums.
struct PooledScores : MethodScores {
  std::size_t cells = 0;            ///< that were run
  std::size_t answering_cells = 0;  ///< on some loop of which it gave a verdict
  /// Each of leaderboard_rates() over that of the reference on the same cells; NaN where one of the two was
  /// not counted, and where low is good. Empty where there is no reference: it was not asked, or the family
  /// is not its own.
  std::vector<double> shares_of_ceiling = {};
  SourceConfusions confusions = {};  ///< of the cells of which its answers are kept
  /// It gave a verdict on fewer than kFewestAnswers of the loops, so its rates cover fewer loops than those
  /// of the others.
  bool answers_in_part() const;
  /// The whole interval of its false alarms on healthy loops lies above kMostFalseAlarms.
  bool too_many_false_alarms() const;
};

inline constexpr double kMostFalseAlarms = 0.05;

/// The method that knows the distributions of a study: a reference in the families that draw only what it
/// knows (SuiteAxis::has_reference). It is not counted elsewhere, nor over plants and families together.
inline constexpr std::string_view kReferenceMethod = "ceiling";

/// The task of a method.
enum class LeaderboardTask { detection, location, source };

template <>
inline constexpr auto kWords<LeaderboardTask> = word_list("detection", "location", "source");
inline constexpr auto kLeaderboardTasks = enumerators<LeaderboardTask>();

/// A task is passed by a method that gives a verdict on 90 % of the loops (kFewestAnswers) and is right on 80
/// % of those that the task looks at (kPassingShare):
///
/// | task      | 80 % of                                                       | and          |
/// |-----------|---------------------------------------------------------------|--------------|
/// | detection | the loops with a fault that has an impact are flagged         | at most 10 % |
/// | location  | the flagged loops with one affected CV have it named          | of the healthy loops |
/// | source    | the loops with a fault have the right source, all counted     | are flagged  |
///
/// The numbers themselves are held against the limits, not their intervals. A finding that does not exist,
/// because no loop of the family asks for it or the method does not name it, passes nothing.
bool passes(const PooledScores& scores, LeaderboardTask task);

inline constexpr double kPassingShare = 0.8;
inline constexpr double kPassingFalseAlarms = 0.1;

/// The rates that a leaderboard has by family and by plant, in the order in which people read them.
std::vector<std::string_view> leaderboard_rates();

/// What the methods of a suite of worlds are ranked by, at equal false alarms: at the threshold that is
/// calibrated for 5 % of them.
inline constexpr std::string_view kRankingSource = "source_05_impact";      ///< a rate
inline constexpr std::string_view kRankingRepair = "repair_gain_share_05";  ///< an estimate

/// All that a run of a suite found.
struct Leaderboard {
  std::string suite;
  std::string version;
  std::string title;
  std::uint64_t seed = 0;
  std::string program;  ///< version of the program
  double confidence = kBoardConfidence;
  std::vector<SuiteAxis> plants = {};    ///< with a cell, in the order of the suite
  std::vector<SuiteAxis> families = {};  ///< with a cell, in the order of the suite
  std::vector<std::string> methods = {};
  std::vector<std::string> own = {};   ///< of them: those that a reader looks for
  std::string finished_by = {};        ///< "mpmbench 1.0 (revision)": who ran the others; empty: this program
  std::vector<CellScores> cells = {};  ///< with places in `plants` and `families` above
  std::vector<std::vector<PooledScores>> by_family = {};  ///< [method][family]
  std::vector<std::vector<PooledScores>> by_plant = {};   ///< [method][plant]
  std::vector<PooledScores> overall = {};                 ///< [method]

  /// All loops take place in worlds drawn at random: there are cells that were run, and all of them do.
  bool in_worlds() const;
  bool is_own(std::size_t method) const;
};

/// Whether the method answers the question of this rate. It does not without a loop that counts, nor, for
/// kRankingSource, if it names only mismatches or only disturbances: the one in no loop, the other in some
/// loop.
bool answers(const Leaderboard& board, std::size_t method, std::string_view rate);

/// 1: the best of those that answer the question; none: it does not.
std::optional<int> question_rank(const Leaderboard& board, std::size_t method, std::string_view rate);

/// A method among the others, over all families of a suite of worlds.
struct RankedMethod {
  std::size_t method;              ///< place in Leaderboard::methods
  std::optional<int> source = {};  ///< question_rank() of kRankingSource
  std::optional<int> repair = {};  ///< the same; none: it names no channels
};

/// The methods of a suite of worlds but the reference, by kRankingSource, and those without it behind them by
/// kRankingRepair; empty for another suite. Equal values have the same rank.
std::vector<RankedMethod> ranking(const Leaderboard& board);

/// Whether the reference was run on a family in which it counts.
bool has_reference(const Leaderboard& board);

/// The families that no method passes.
std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task);

/// Pools the cells of a suite. `cells` are those of `suite`, in any number and order; `methods` those of each
/// cell that was run, in its order.
Leaderboard make_leaderboard(const Suite& suite, const std::vector<std::string>& methods,
                             const std::string& program, std::vector<CellScores> cells,
                             double confidence = kBoardConfidence);

}  // namespace mpm
