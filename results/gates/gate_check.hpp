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

/// How the judgements on one question differ between a run and its baseline.
struct BaselineChanges {
  std::string name;   ///< as in names of gates: "located", "METHOD.located"
  std::string title;  ///< for people: "source recognised"
  JudgementChanges changes;
  /// McNemarTest::p_worse with the correction of Holm for all questions on which some verdict changed. A
  /// question without a change cannot fail and does not count (Tarone 1990, "A modified Bonferroni method for
  /// discrete data", Biometrics 46, 515-522).
  double p_worse = 1.0;

  bool changed() const { return !changes.lost.empty() || !changes.gained.empty(); }
};

/// How the verdicts on the experiments of a run differ from those of its baseline.
struct BaselineComparison {
  std::string path;                             ///< of the baseline
  std::string run_by;                           ///< "mpmbench 1.0 (revision), solver auto"
  std::vector<StudyDifference> edited;          ///< campaign_differences(); empty for a suite
  std::vector<std::string> not_compared = {};   ///< methods that only one of the two runs has
  std::vector<BaselineChanges> questions = {};  ///< after correct_questions()

  /// Returns the changes that a gate on the baseline is about; null for any other gate.
  const BaselineChanges* of(const GateResult& result) const;
};

/// What the gates say about a run.
struct GateCheck {
  std::string name;   ///< of the study or suite
  std::string title;  ///< for people, one or more lines; empty: nothing to say
  std::vector<std::pair<std::string, std::string>> properties;  ///< by whom and how it was run
  std::vector<GateResult> results =
      {};  ///< gates that every run has, then those of the file, then [baseline]
  std::optional<BaselineComparison> baseline = {};
  InconclusivePolicy inconclusive = InconclusivePolicy::fail;
  double confidence = 0.0;   ///< of the intervals
  std::string created = {};  ///< when it was run, ISO 8601, UTC; empty: not known
  double seconds = kNaN;     ///< that the run took, in seconds; NaN: not known

  /// Tells whether a gate stops the run: if it failed, or is inconclusive under InconclusivePolicy::fail.
  bool stops(const GateResult& result) const;
  bool passed() const;
};

/// Returns the findings that gates can be put on. For a study these are the findings of every run of it,
/// without values. A campaign has further ones if some loop gives them a value, such as `unstable`.
std::vector<Finding> gate_findings(const Study& study);
std::vector<Finding> gate_findings(const Campaign& campaign);

/// Sets BaselineChanges::p_worse of each question.
std::vector<BaselineChanges> correct_questions(std::vector<BaselineChanges> questions);

/// Judges the gate `answered.METHOD`, which no file names: a method from outside must have answered at least
/// the share `minimum` of the loops on which it was asked. Returns none if it was asked on no loop.
std::optional<GateResult> judge_answers(const std::string& method, const VerdictFailures& failures,
                                        double minimum);

/// Judges a gate that no file names, on a number that rests on `count` experiments.
GateResult judge_number(const std::string& name, const std::string& meaning, double value, std::int64_t count,
                        double minimum, double maximum);

/// Judges the gates of the file, which refer to `findings`, and those of its baseline. Appends them to the
/// results that `run` already has.
GateCheck judge_gates(GateCheck run, const GateFile& file, const std::vector<Finding>& findings);

/// Judges a campaign. Besides the gates of the file, every campaign has the gates `self_check` (the basis
/// case is healthy), `experiments` (at least minimum_experiments), `failed` (at most maximum_failed), and
/// `answered.METHOD` (judge_answers()) for each method with an origin. If the file has [baseline], `baseline`
/// must be that campaign. Then there are also, for each method of both and each of verdict_questions() that
/// was judged, `baseline.METHOD.QUESTION.p_worse` (at least the significance) and
/// `baseline.METHOD.QUESTION.lost` (at most maximum_lost). For the method that diagnoses, two questions keep
/// older names: `baseline.located` and `baseline.source_recognised`. Each run is judged by its own study.
///
/// Errors: InputError unless the baseline can be paired with the campaign (pair_runs()), has all of its
/// experiments, and has a method in common with it.
GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline = nullptr);

}  // namespace mpm
