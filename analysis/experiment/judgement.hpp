#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "base/enum_words.hpp"

// What is right and what is wrong: the one place where the answer of a method is compared with the truth.

namespace mpm {

/// The result of one question about an answer.
enum class Correctness : std::int8_t {
  not_judged,  ///< the question does not arise: no verdict, or the experiment is outside of the population
  wrong,
  right,
};

template <>
inline constexpr auto kWords<Correctness> = word_list("not judged", "wrong", "right");

/// The answer of a method on a named scenario, compared with the truth CV by CV.
struct CvJudgement {
  std::vector<Eigen::Index> found;         ///< affected CVs that are flagged
  std::vector<Eigen::Index> missed;        ///< affected CVs that are not flagged
  std::vector<Eigen::Index> false_alarms;  ///< other CVs that are flagged
  /// Found CVs with one sort of fault for which the method names another source. With both sorts on a CV,
  /// either is right.
  std::vector<Eigen::Index> wrong_source;
  bool judged_source = false;  ///< some found CV has exactly one sort of fault

  bool located() const { return missed.empty() && false_alarms.empty(); }
  bool right() const { return located() && wrong_source.empty(); }
};

/// The answer of a method on one experiment against the truth.
///
/// | member           | question                                  | of experiments with a verdict    |
/// |------------------|-------------------------------------------|----------------------------------|
/// | predicted_cv     | is the worst CV the affected one          | flagged, a fault of one CV       |
/// | predicted_source | is its source the right one               | in_source_population(), one fault |
/// | channel          | is the mismatched channel among the named | with one mismatch, of an MV      |
/// | parameter        | are channel and parameter the named ones  | as channel                       |
/// | size             | is the true size in its interval          | parameter is right               |
/// | candidate        | is the named signal the cause             | flagged, a logged signal drives  |
/// |                  |                                           | the disturbance                  |
/// | cvs              | is every CV judged rightly                | named scenarios                  |
///
/// In a loop that is not flagged, no channel and no mismatch is named.
struct Judgement {
  Correctness predicted_cv = Correctness::not_judged;
  Correctness predicted_source = Correctness::not_judged;
  Correctness channel = Correctness::not_judged;
  Correctness parameter = Correctness::not_judged;
  Correctness size = Correctness::not_judged;
  Correctness candidate = Correctness::not_judged;
  /// The distance |size - true size| relative to the true deviation from the model (from 1 for a factor, from
  /// 0 for a shift), if the parameter is right: 1 is no better than the model. NaN otherwise.
  double size_error = kNaN;
  std::optional<CvJudgement> cvs;
  bool flagged = false;                ///< the loop is flagged
  bool flagged_without_fault = false;  ///< the loop is flagged and has no fault

  /// Is the place of the fault right? Judged by every CV of a named scenario, by the worst CV otherwise.
  Correctness location() const;
  /// Is the source of the fault right? Judged in the same way.
  Correctness source() const;
  /// Is the answer wrong: is the loop of a random experiment flagged without a fault, or with a wrong CV or
  /// source, or is a CV of a named scenario judged wrongly?
  bool wrong() const;
};

/// Judges the answer of a method. Without a verdict no question is judged. Throws nothing.
Judgement judge(const Study& study, const ExperimentRecord& record, const AssessmentRecord& assessment);

/// The truth about the impact of a fault: some Ivar_basis (6.22), the variance of a CV over that in the same
/// loop without the fault, lies outside the band of impact of the study. In a world it is
/// FaultCost::has_impact(). It does not depend on any method.
bool has_impact(const DiagnosisOptions& options, const ExperimentRecord& record);

/// Does the answer count in the rates of the source of a fault? Those that flag the loop do, or all with a
/// verdict (diagnosis.source_population).
bool in_source_population(const Study& study, const AssessmentRecord& assessment);

/// The source that the answer gives for the whole loop: that of the located CV of a flagged loop. None if the
/// loop is not flagged, the answer has no source, or the method names no sources.
FaultSource named_source(const AssessmentRecord& assessment);

/// Is this the source of a fault of this kind? For a fault that is neither mismatch nor disturbance, both
/// `other` and `none` are right.
bool names_source(ExperimentKind fault, FaultSource named);

/// True when the answer distinguishes the fault from the others (mismatch, disturbance, both, other). The
/// loop must have a fault. An answer that says nothing is not right. For a fault that is neither mismatch nor
/// disturbance, the right answer is a flagged loop with the source `other` or, from a method that has no word
/// for it, without a source.
bool tells_fault(const ExperimentRecord& record, const AssessmentRecord& assessment);

/// The loops that a method should flag; it should flag no others.
enum class FlagTruth : std::int8_t {
  fault = 0,   ///< those with a fault: the task of a monitor of the model
  impact = 1,  ///< those with a fault that has an impact: the task of a monitor of the performance
};

template <>
inline constexpr auto kWords<FlagTruth> = word_list("fault", "impact");

/// Is the loop of this experiment to be flagged?
bool to_be_flagged(const Study& study, const ExperimentRecord& record, FlagTruth truth);

}  // namespace mpm
