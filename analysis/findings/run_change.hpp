#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/calibration.hpp"
#include "analysis/findings/judgement_changes.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/statistics/sample_summary.hpp"
#include "analysis/statistics/share_difference.hpp"

// What changed from one run to another, experiment by experiment where both ran the same ones.

namespace mpm {

/// One of two runs that are compared. It must outlive the comparison.
struct StudyRun {
  const Study& study;
  const AssessmentForms& forms;
  RecordRange records;
  const Calibration& calibration;
};

/// Which experiments of two runs are the same. Runs are paired when seed and variables of the studies are the
/// same, they have experiments in common, and in each of these the same is wrong.
struct RunPairing {
  std::string obstacle = {};    ///< why the runs are not paired, as a clause; empty: they are
  std::int64_t loops = 0;       ///< experiments in common; none when not paired
  std::int64_t same_loops = 0;  ///< of these: the same end and the same Ivar_basis, bit for bit

  bool paired() const { return obstacle.empty(); }
};

RunPairing pair_runs(const StudyRun& before, const StudyRun& now);

/// How a rate of a method changed. For paired runs only the common loops count.
struct RateChange {
  const RateRow* row;
  Rate before, now;            ///< each over all loops that it counts in this run
  PairedCounts counts;         ///< of paired runs: over the loops that it counts in both
  ShareDifference difference;  ///< over these; of unpaired runs: of `before` and `now` as independent
  double p_holm = 1.0;         ///< difference.p corrected for all rates of the method; NaN where p is
};

/// One question to an answer that may come to something else in the other run.
struct VerdictQuestion {
  const char* key;      ///< in names of gates: "flag_impact"
  const char* name;     ///< for people: "flag, impact"
  const char* meaning;  ///< when the answer is right
  Correctness (*ask)(const Study&, const ExperimentRecord&, const AssessmentRecord&);
};

/// Every question once, in the order in which people read them.
std::span<const VerdictQuestion> verdict_questions();

/// How the answers to one question changed over paired loops.
struct VerdictChange {
  const VerdictQuestion* question;
  JudgementChanges changes = {};
  double p_holm = 1.0;  ///< two-sided, corrected for all questions of all methods
};

/// How a number changed over paired loops that have it in both runs. A number of CVs is the mean of an
/// experiment's CVs, for these are no independent samples.
struct NumberChange {
  std::string label;  ///< with the marks of plot labels: "I_{MPM}"
  std::int64_t experiments = 0;
  std::int64_t same = 0;     ///< experiments in which nothing of it changed
  SampleSummary difference;  ///< now - before, over experiments
  double largest = 0.0;      ///< change of a single value by absolute value, with its sign
  std::int64_t index = -1;   ///< the experiment with this change; -1: none changed
};

/// What changed of one method that both runs have.
struct MethodChange {
  std::string name;
  std::size_t before, now;              ///< its place in the assessments of each record
  std::vector<RateChange> rates;        ///< those that a loop was counted for in some run
  std::vector<VerdictChange> verdicts;  ///< those that were judged; empty for unpaired runs
  std::vector<NumberChange> numbers;    ///< empty for unpaired runs

  /// Something of it changed in some paired loop.
  bool changed() const;
};

/// All methods of both runs, in the order of the second. Goes through the records once.
std::vector<MethodChange> method_changes(const StudyRun& before, const StudyRun& now,
                                         const RunPairing& pairing);

/// The same for paired runs, without rates and numbers, which take longer.
std::vector<MethodChange> verdict_changes(const StudyRun& before, const StudyRun& now);

}  // namespace mpm
