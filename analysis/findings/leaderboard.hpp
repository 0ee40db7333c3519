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

/// The confidence level of the intervals, unless a reader asks for another one.
inline constexpr double kBoardConfidence = 0.95;

/// How often a method was right on some loops.
struct MethodScores {
  std::string reason;       ///< why the first loop without a verdict has none; empty: all loops have one
  std::int64_t failed = 0;  ///< loops on which it was asked and failed
  Rates rates = Rates();
  /// Over several cells, only the means that keep their clusters and the calibration error have a value:
  /// medians cannot be pooled.
  Estimates estimates = {};
  /// For one cell: the answer of the method on each loop (MethodRates::outcomes), and what decides which
  /// rates it can have.
  LoopOutcomes outcomes = {};
  OutcomeScope scope = {};
  Reliability reliability = {};  ///< of the probabilities that it states, if it states any

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
  std::string trouble = {};    ///< why the cell could not be run; empty: it was run
  std::int64_t experiments = 0;
  std::int64_t failed = 0;
  std::int64_t infeasible = 0;
  LoopTruths truths = {};                  ///< of its loops, as in StudyFindings
  std::vector<int> worlds = {};            ///< of its loops, as in StudyFindings
  std::vector<MethodScores> methods = {};  ///< in the order of the leaderboard; empty if the cell was not run
};

/// The scores of a cell that was run.
CellScores cell_scores(const SuiteCell& cell, const StudyFindings& findings);

/// Computes the scores that follow from the outcomes of a method on the loops of `cell`. `cell` has the truth
/// of the loop of each outcome. The estimates stay without values.
MethodScores scores_of_outcomes(const CellScores& cell, LoopOutcomes outcomes, const OutcomeScope& scope);

/// The scores of a method over all cells of a family or of a plant. Hits and loops of the cells are added up,
/// so that each loop counts once. Wilson's interval is computed from the sums.
struct PooledScores : MethodScores {
  std::size_t cells = 0;            ///< that were run
  std::size_t answering_cells = 0;  ///< cells in which it gave a verdict on some loop
  /// Each of leaderboard_rates() divided by that of the reference on the same cells; NaN if the method's rate
  /// counts no loop, if the reference has no hit, or if low is good. Empty without a reference: it was not
  /// run, or it does not count in the family.
  std::vector<double> shares_of_ceiling = {};
  SourceConfusions confusions = {};  ///< of the cells with OutcomeScope::is_told
  /// Whether it gave a verdict on some loops, but on a smaller share than kFewestAnswers. Its rates then
  /// cover fewer loops than those of the others.
  bool answers_in_part() const;
  /// Whether the whole interval of its false alarms on healthy loops lies above kMostFalseAlarms.
  bool too_many_false_alarms() const;
};

inline constexpr double kMostFalseAlarms = 0.05;

/// The method that knows the distributions of a study: a reference in the families that draw only what it
/// knows (SuiteAxis::has_reference). It does not count in other families, nor by plant, nor overall.
inline constexpr std::string_view kReferenceMethod = "ceiling";

/// The task of a method.
enum class LeaderboardTask { detection, location, source };

template <>
inline constexpr auto kWords<LeaderboardTask> = word_list("detection", "location", "source");
inline constexpr auto kLeaderboardTasks = enumerators<LeaderboardTask>();

/// A method passes a task if it gives a verdict on 90 % of the loops (kFewestAnswers), is right on 80 % of
/// the loops that the task looks at (kPassingShare), and flags few healthy loops (kPassingFalseAlarms):
///
/// | task      | 80 % of                                                       | and          |
/// |-----------|---------------------------------------------------------------|--------------|
/// | detection | the loops with a fault that has an impact are flagged         | at most 10 % |
/// | location  | the flagged loops with one affected CV have it named          | of the healthy loops |
/// | source    | all loops with a fault, verdict or not, have the right source | are flagged  |
///
/// The values themselves are compared with the limits, not their intervals. A rate that counts no loop passes
/// no task: the family has no such loop, or the method does not give such an answer.
bool passes(const PooledScores& scores, LeaderboardTask task);

inline constexpr double kPassingShare = 0.8;
inline constexpr double kPassingFalseAlarms = 0.1;

/// The rates that a leaderboard has by family and by plant, in the order in which people read them.
std::vector<std::string_view> leaderboard_rates();

/// The numbers by which the methods of a suite of worlds are ranked, at equal false alarms: at the threshold
/// that is calibrated for 5 % false alarms.
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
  std::vector<std::string> own = {};  ///< those of `methods` that the board marks as the reader's own
  std::string finished_by = {};  ///< "mpmbench 1.0 (revision)": ran the other methods; empty: this program
  std::vector<CellScores> cells = {};                     ///< with places in `plants` and `families` above
  std::vector<std::vector<PooledScores>> by_family = {};  ///< [method][family]
  std::vector<std::vector<PooledScores>> by_plant = {};   ///< [method][plant]
  std::vector<PooledScores> overall = {};                 ///< [method]

  /// Whether all loops take place in worlds drawn at random: at least one cell was run, and every cell that
  /// was run has CellScores::in_worlds.
  bool in_worlds() const;
  bool is_own(std::size_t method) const;
};

/// Whether the method answers the question of this rate. It does not if the rate counts no loop. It does not
/// answer kRankingSource if it names only mismatches or only disturbances: it is right about one of the two
/// in no loop, and about the other in some loop.
bool answers(const Leaderboard& board, std::size_t method, std::string_view rate);

/// The rank of the method among those that answer the question, 1 for the best; none if it does not answer
/// it.
std::optional<int> question_rank(const Leaderboard& board, std::size_t method, std::string_view rate);

/// The ranks of a method among the others, over all families of a suite of worlds.
struct RankedMethod {
  std::size_t method;              ///< place in Leaderboard::methods
  std::optional<int> source = {};  ///< question_rank() of kRankingSource
  std::optional<int> repair = {};  ///< rank by kRankingRepair; none: it names no channels
};

/// Returns all methods of a suite of worlds except the reference, in the order of their rank by
/// kRankingSource. The methods without this rank follow, in the order of their rank by kRankingRepair. Equal
/// values have the same rank. Empty for a suite without worlds.
std::vector<RankedMethod> ranking(const Leaderboard& board);

/// Whether the reference was run on a family in which it counts.
bool has_reference(const Leaderboard& board);

/// Returns the families in which no method except the reference passes the task.
std::vector<std::string> passed_by_nobody(const Leaderboard& board, LeaderboardTask task);

/// Pools the cells of a suite. `cells` are cells of `suite`, in any number and order. `methods` are the
/// methods of each cell that was run, in the order of CellScores::methods.
Leaderboard make_leaderboard(const Suite& suite, const std::vector<std::string>& methods,
                             const std::string& program, std::vector<CellScores> cells,
                             double confidence = kBoardConfidence);

}  // namespace mpm
