#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/findings/gate.hpp"
#include "analysis/findings/judgement_changes.hpp"
#include "results/archive/campaign.hpp"
#include "results/gates/gate_file.hpp"

namespace mpm {

/// How the judgements of one question differ between a campaign and its baseline.
struct BaselineChanges {
  const char* name;   ///< in the names of gates: "located"
  const char* title;  ///< for people: "source recognised"
  JudgementChanges changes;
};

/// How the verdicts of the chain on the experiments of a campaign differ from those of its baseline.
struct BaselineComparison {
  std::string archive;
  CampaignInfo info;  ///< of the baseline
  std::vector<BaselineChanges> questions;

  /// The changes that a gate on the baseline is about; null for any other gate.
  const BaselineChanges* of(const GateResult& result) const;
};

/// What the gates say of a campaign.
struct GateCheck {
  std::vector<GateResult>
      results;  ///< gates that every campaign has, then those of the file, then [baseline]
  std::optional<BaselineComparison> baseline;
  InconclusivePolicy inconclusive = InconclusivePolicy::fail;
  double confidence = 0.0;  ///< of the intervals

  /// Does this one stop the campaign? A failed one does, an inconclusive one under InconclusivePolicy::fail.
  bool stops(const GateResult& result) const;
  bool passed() const;
};

/// The findings that a gate can be put on: those of a run of this study, and of this campaign. Without
/// values: the names and forms matter.
std::vector<Finding> gate_findings(const Study& study);
std::vector<Finding> gate_findings(const Campaign& campaign);

/// Judges a campaign. Beside the gates of the file, every campaign has the gates `self_check` (the basis case
/// is healthy), `experiments` (at least minimum_experiments) and `failed` (at most maximum_failed). With
/// [baseline], which `baseline` must then be, it also has `baseline.located.p_worse` (at least the
/// significance), `baseline.located.lost` (at most maximum_lost) and the same of `source_recognised`.
///
/// Errors: InputError unless the baseline has the same study and seed, and the experiments of the campaign.
GateCheck check_gates(const Campaign& campaign, const GateFile& file, const Campaign* baseline = nullptr);

}  // namespace mpm
