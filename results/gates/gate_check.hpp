#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/findings/gate.hpp"
#include "analysis/findings/judgement_changes.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/study_files/study_differences.hpp"
#include "base/non_finite.hpp"
#include "results/archive/campaign.hpp"
#include "results/gates/gate_file.hpp"

namespace mpm {

/// How the judgements of one question differ between a run and its baseline.
struct BaselineChanges {
  std::string name;   ///< in the names of gates: "located", "METHOD.located"
  std::string title;  ///< for people: "source recognised"
  JudgementChanges changes;
  /// McNemarTest::p_worse, corrected by Holm for the questions on which some verdict changed. A question on
  /// which none did cannot fail, and does not count (Tarone 1990, "A modified Bonferroni method for discrete
  /// data", Biometrics 46, 515-522).
  double p_worse = 1.0;

  bool changed() const { return !changes.lost.empty() || !changes.gained.empty(); }
};

/// How the verdicts on the experiments of a run differ from those of its baseline.
struct BaselineComparison {
  std::string path;                             ///< of the baseline
  std::string run_by;                           ///< "mpmbench 1.0 (revision), solver auto"
  std::vector<StudyDifference> edited;          ///< campaign_differences(); none of a suite
  std::vector<std::string> not_compared = {};   ///< methods that only one of the two has
  std::vector<BaselineChanges> questions = {};  ///< by correct_questions()

  /// The changes that a gate on the baseline is about; null for any other gate.
  const BaselineChanges* of(const GateResult& result) const;
};

/// What the gates say about a run.
struct GateCheck {
  std::string name;   ///< of the study or suite
  std::string title;  ///< for people, in lines; empty: nothing to say
  std::vector<std::pair<std::string, std::string>> properties;  ///< by whom and how it was run
  std::vector<GateResult> results =
      {};  ///< gates that every run has, then those of the file, then [baseline]
  std::optional<BaselineComparison> baseline = {};
  InconclusivePolicy inconclusive = InconclusivePolicy::fail;
  double confidence = 0.0;   ///< of the intervals
  std::string created = {};  ///< when it was run, ISO 8601, UTC; empty: not known
  double seconds = kNaN;     ///< that the run took; NaN: not known

  /// Does this one stop the run? A failed one does, an inconclusive one under InconclusivePolicy::fail.
  bool stops(const GateResult& result) const;
  bool passed() const;
};

/// The findings that a gate can be put on: those that every run of this study has, without values; and those
/// of this campaign, which has more where some loop gives them a value, such as `unstable`.
std::vector<Finding> gate_findings(const Study& study);
std::vector<Finding> gate_findings(const Campaign& campaign);

/// Sets BaselineChanges::p_worse of each.
std::vector<BaselineChanges> correct_questions(std::vector<BaselineChanges> questions);

/// The gate `answered.METHOD` that no file names: a method from outside has answered at least the share
/// `minimum` of the loops on which it was asked. None where it was asked on none.
std::optional<GateResult> judge_answers(const std::string& method, const VerdictFailures& failures,
                                        double minimum);

/// A gate that no file names, on a number of so many experiments.
GateResult judge_number(const std::string& name, const std::string& meaning, double value, std::int64_t count,
                        double minimum, double maximum);

/// Judges the gates of the file, which are on these findings, and those of its baseline, after the `results`
/// that are there.
GateCheck judge_gates(GateCheck run, const GateFile& file, const std::vector<Finding>& findings);

/// Judges a campaign. Beside the gates of the file, every campaign has the gates `self_check` (the basis case
/// is healthy), `experiments` (at least minimum_experiments), `failed` (at most maximum_failed), and
/// `answered.METHOD` (judge_answers()) for each method with an origin. With [baseline], which `baseline` must
/// then be, it also has, for each method of both and each of verdict_questions() that was judged,
/// `baseline.METHOD.QUESTION.p_worse` (at least the significance) and `baseline.METHOD.QUESTION.lost` (at
/// most maximum_lost). Two questions of the method that diagnoses have names from before there were others:
/// `baseline.located` and `baseline.source_recognised`. Each run is judged by its own study.
///
/// Errors: InputError unless the baseline can be paired with the campaign (pair_runs()), has all of its
/// experiments, and has a method in common with it.
GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline = nullptr);

}  // namespace mpm
