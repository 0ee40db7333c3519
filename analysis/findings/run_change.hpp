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

/// Whether two runs are paired, and over which experiments. They are paired if the seed and the variables of
/// the studies are the same, and if they have experiments in common, each with the same fault in both runs.
struct RunPairing {
  std::string obstacle = {};    ///< why the runs are not paired, as a clause; empty: they are
  std::int64_t loops = 0;       ///< experiments in common; 0 if not paired
  std::int64_t same_loops = 0;  ///< of these: with the same end and the same Ivar_basis, bit for bit

  bool paired() const { return obstacle.empty(); }
};

RunPairing pair_runs(const StudyRun& before, const StudyRun& now);

/// How a rate of a method changed. For paired runs only the common loops count.
struct RateChange {
  const RateRow* row;
  Rate before, now;            ///< each over all loops that it counts in that run
  PairedCounts counts;         ///< of paired runs: over the loops that it counts in both
  ShareDifference difference;  ///< of paired runs: of `counts`; else of `before` and `now`, as independent
  double p_holm = 1.0;         ///< difference.p corrected for all rates of the method; NaN where p is
};

/// One question about an answer. Its result may differ between the two runs.
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

/// How a number changed over paired loops that have it in both runs. A number that each CV has is averaged
/// over the CVs of an experiment, because they are not independent samples.
struct NumberChange {
  std::string label;  ///< with the marks of plot labels: "I_{MPM}"
  std::int64_t experiments = 0;
  std::int64_t same = 0;     ///< experiments in which none of its values changed
  SampleSummary difference;  ///< now - before, over experiments
  double largest = 0.0;      ///< the change of a single value that is largest in magnitude, with its sign
  std::int64_t index = -1;   ///< the experiment with this change; -1: none changed
};

/// What changed of one method that both runs have.
struct MethodChange {
  std::string name;
  std::size_t before, now;              ///< its places in the assessments of each record
  std::vector<RateChange> rates;        ///< the rates that count a loop in at least one run
  std::vector<VerdictChange> verdicts;  ///< the questions that were judged; empty for unpaired runs
  std::vector<NumberChange> numbers;    ///< empty for unpaired runs

  /// Whether a verdict or a number of the method changed in some paired loop.
  bool changed() const;
};

/// Compares all methods that both runs have, in the order of the second run. Goes through the records once.
std::vector<MethodChange> method_changes(const StudyRun& before, const StudyRun& now,
                                         const RunPairing& pairing);

/// The same for paired runs, without rates and numbers, which take longer.
std::vector<MethodChange> verdict_changes(const StudyRun& before, const StudyRun& now);

}  // namespace mpm
