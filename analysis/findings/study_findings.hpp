#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "analysis/findings/calibration.hpp"
#include "analysis/findings/endings.hpp"
#include "analysis/findings/false_alarms.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/findings/kind_findings.hpp"
#include "analysis/findings/method_pairs.hpp"
#include "analysis/findings/method_rates.hpp"
#include "analysis/findings/s0_perturbation_curves.hpp"

namespace mpm {

/// The findings of a study about one method.
struct MethodFindings {
  std::shared_ptr<const AssessmentForm> form;
  std::vector<KindFindings> kinds;        ///< the kinds with a fault that the study has
  std::vector<FalseAlarms> false_alarms;  ///< empty without healthy experiments and bad tunings
  MethodRates rates;                      ///< over all loops, as methods are compared

  const std::string& name() const { return form->method().name; }
};

/// All that a study reports, computed once, each number with its uncertainty.
struct StudyFindings : Endings {
  std::int64_t assessed = 0;  ///< loops that some method has looked at
  /// The truth of each record in their order (none if no method assessed it), and its world (draw.world).
  LoopTruths truths;
  std::vector<int> worlds;
  std::vector<MethodFindings> methods;      ///< in the order of the study
  std::vector<MethodPair> pairs;            ///< of all methods
  std::vector<DominanceBin> dominance;      ///< of the chain; empty without experiments of both faults
  std::optional<SourceCurve> source_curve;  ///< of the chain; none without experiments of both kinds
  /// Of the chain: CV located and source recognised, over the experiments of all kinds; loops without a fault
  /// that are flagged; named scenarios whose every CV is judged correctly.
  Rate located, source_recognised, false_alarm, right_scenarios;
  std::optional<S0Changes> s0_changes;  ///< of the chain; none in a study that does not perturb S0
  /// The table of all of the above: first the numbers of the study, of the chain by kind, and of loops in
  /// which model and plant agree; then those of the other methods by kind; then the comparison of all
  /// methods.
  std::vector<Finding> rows;

  /// The findings of the method of this name; null if the study has no such method.
  const MethodFindings* of(std::string_view method) const;
  /// The findings of the method that diagnoses (diagnoses()); null if there is none.
  const MethodFindings* chain() const;
};

/// Computes the findings of a study from `records`, which need not be all of its experiments. Goes through
/// the records once; their order changes at most the last bits. Each record has an assessment of each of
/// `forms`, in their order. Each loop of the calibration has a score of each, in the same order. The
/// calibration has loops only in a study that asks for them.
StudyFindings study_findings(const Study& study, const AssessmentForms& forms, const RecordRange& records,
                             const Calibration& calibration = {});

/// The names of all findings that a study of this plant can have, with any experiments and all methods.
std::vector<std::string> finding_names(Study study);

/// Throws InputError if a number is reported under a name that no finding has.
void check_reported(const Study& study);

}  // namespace mpm
