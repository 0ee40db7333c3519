#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/findings/gate.hpp"
#include "analysis/findings/judgement_changes.hpp"
#include "results/archive/campaign.hpp"
#include "results/gates/gate_file.hpp"
#include "scenarios/files/study_differences.hpp"

namespace mpm {

/// How the judgements of one question differ between a run and its baseline.
struct BaselineChanges {
  std::string name;   ///< in the names of gates: "located", "METHOD.located"
  std::string title;  ///< for people: "source recognised"
  JudgementChanges changes;
};

/// How the verdicts on the experiments of a run differ from those of its baseline.
struct BaselineComparison {
  std::string path;                     ///< of the baseline
  std::string run_by;                   ///< "mpmbench 1.0 (revision), solver auto"
  std::vector<StudyDifference> edited;  ///< keys of the study that have other values
  std::vector<BaselineChanges> questions;

  /// The changes that a gate on the baseline is about; null for any other gate.
  const BaselineChanges* of(const GateResult& result) const;
};

/// What the gates say of a run.
struct GateCheck {
  std::string name;   ///< of the study or suite
  std::string title;  ///< for people, in lines; empty: nothing to say
  std::vector<std::pair<std::string, std::string>> properties;  ///< by whom and how it was run
  std::vector<GateResult> results =
      {};  ///< gates that every run has, then those of the file, then [baseline]
  std::optional<BaselineComparison> baseline = {};
  InconclusivePolicy inconclusive = InconclusivePolicy::fail;
  double confidence = 0.0;  ///< of the intervals

  /// Does this one stop the run? A failed one does, an inconclusive one under InconclusivePolicy::fail.
  bool stops(const GateResult& result) const;
  bool passed() const;
};

/// The findings that a gate can be put on: those that every run of this study has, without values; and those
/// of this campaign, which has more where some loop gives them a value, such as `unstable`.
std::vector<Finding> gate_findings(const Study& study);
std::vector<Finding> gate_findings(const Campaign& campaign);

/// A gate that no file names, on a number of so many experiments.
GateResult judge_number(const std::string& name, const std::string& meaning, double value, std::int64_t count,
                        double minimum, double maximum);

/// Judges the gates of the file, which are on these findings, and those of its baseline, after the `results`
/// that are there.
GateCheck judge_gates(GateCheck run, const GateFile& file, const std::vector<Finding>& findings);

/// Judges a campaign. Beside the gates of the file, every campaign has the gates `self_check` (the basis case
/// is healthy), `experiments` (at least minimum_experiments) and `failed` (at most maximum_failed). With
/// [baseline], which `baseline` must then be, it also has `baseline.located.p_worse` (at least the
/// significance), `baseline.located.lost` (at most maximum_lost) and the same of `source_recognised`. Each
/// run is judged by its own study.
///
/// Errors: InputError unless the baseline can be paired with the campaign (pair_runs()) and has all of its
/// experiments, and a method that diagnoses has assessed both.
GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline = nullptr);

}  // namespace mpm
