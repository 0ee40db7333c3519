#include "analysis/experiment/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenarios/loop/candidates.hpp"

namespace mpm {
namespace {

Correctness correctness(bool right) {
  return right ? Correctness::right : Correctness::wrong;
}

FaultSource source_on(const std::vector<AffectedCv>& affected, Eigen::Index cv) {
  const auto place =
      std::find_if(affected.begin(), affected.end(), [cv](const auto& each) { return each.cv == cv; });
  return place == affected.end() ? FaultSource::none : place->by;
}

CvJudgement judge_cvs(const ExperimentRecord& record, const AssessmentRecord& assessment) {
  CvJudgement judgement;
  const std::vector<AffectedCv> affected = record.draw.affected();
  const Eigen::MatrixXd flags = assessment.values("cv_flagged");
  for (Eigen::Index cv = 0; cv < flags.rows(); ++cv) {
    const bool flagged = flags(cv) == 1.0;
    const FaultSource truth = source_on(affected, cv);
    if (truth == FaultSource::none) {
      if (flagged)
        judgement.false_alarms.push_back(cv);
      continue;
    }
    (flagged ? judgement.found : judgement.missed).push_back(cv);
    if (!flagged || truth == FaultSource::mpm_ud || !assessment.form->method().tells_sources)
      continue;
    judgement.judged_source = true;
    if (assessment.number("cv_source", cv) != static_cast<double>(truth))
      judgement.wrong_source.push_back(cv);
  }
  return judgement;
}

/// The channel of the only mismatch, if it is a channel of an MV; none otherwise.
std::optional<Channel> mismatched_channel(const Study& study, const ExperimentDraw& draw) {
  if (draw.mismatches.size() != 1 || draw.mismatches[0].input >= study.mv_count())
    return std::nullopt;
  return Channel{draw.mismatches[0].cv, draw.mismatches[0].input};
}

/// The value of a parameter without a mismatch.
double without_mismatch(MismatchParameter parameter) {
  return parameter == MismatchParameter::gain || parameter == MismatchParameter::time_constant ||
                 parameter == MismatchParameter::sign
             ? 1.0
             : 0.0;
}

void judge_mismatch(const Mismatch& truth, const AssessmentRecord& assessment, Judgement& judgement) {
  const std::optional<NamedMismatch> named = assessment.named_mismatch();
  const bool right = assessment.flagged && named && named->channel == Channel{truth.cv, truth.input} &&
                     named->parameter == truth.parameter;
  judgement.parameter = correctness(right);
  if (!right || std::isnan(named->size))
    return;
  judgement.size = correctness(named->holds(truth.value));
  judgement.size_error =
      std::abs(named->size - truth.value) / std::abs(truth.value - without_mismatch(truth.parameter));
}

}  // namespace

Correctness Judgement::location() const {
  return cvs ? correctness(cvs->located()) : predicted_cv;
}

Correctness Judgement::source() const {
  if (!cvs)
    return predicted_source;
  return cvs->judged_source ? correctness(cvs->wrong_source.empty()) : Correctness::not_judged;
}

bool Judgement::wrong() const {
  if (cvs)
    return !cvs->right();
  return flagged && (flagged_without_fault || predicted_cv == Correctness::wrong ||
                     predicted_source == Correctness::wrong);
}

Judgement judge(const Study& study, const ExperimentRecord& record, const AssessmentRecord& assessment) {
  Judgement judgement;
  const ExperimentDraw& draw = record.draw;
  if (record.status != ExperimentStatus::ok || !assessment.answered())
    return judgement;
  const MethodDescription& method = assessment.form->method();
  const bool faulty = !is_faultless(draw.kind);
  const Eigen::Index true_cv = draw.true_cv();
  judgement.flagged = assessment.flagged;
  judgement.flagged_without_fault = assessment.flagged && !faulty;
  if (method.locates_cvs && assessment.flagged && faulty && true_cv >= 0)
    judgement.predicted_cv = correctness(assessment.predicted_cv == true_cv);
  const bool single = draw.kind == ExperimentKind::mpm || draw.kind == ExperimentKind::ud;
  if (method.tells_sources && single && in_source_population(study, assessment))
    judgement.predicted_source = correctness(assessment.predicted_source == source_of(draw.kind));
  const std::optional<Channel> channel = mismatched_channel(study, draw);
  if (method.names_channels && channel)
    judgement.channel = correctness(assessment.flagged && assessment.names(*channel));
  if (method.names_mismatches && channel)
    judge_mismatch(draw.mismatches[0], assessment, judgement);
  if (const Eigen::Index cause = true_candidate(study, draw);
      method.names_candidates && assessment.flagged && cause >= 0)
    judgement.candidate = correctness(assessment.number("named_candidate") == static_cast<double>(cause));
  if (draw.named && method.locates_cvs)
    judgement.cvs = judge_cvs(record, assessment);
  return judgement;
}

bool has_impact(const DiagnosisOptions& options, const ExperimentRecord& record) {
  if (record.cost)
    return record.cost->has_impact(options.impact_upper, options.impact);
  return std::any_of(record.ivar_basis.begin(), record.ivar_basis.end(),
                     [&](double ivar) { return options.has_impact(ivar); });
}

bool in_source_population(const Study& study, const AssessmentRecord& assessment) {
  return assessment.answered() &&
         (assessment.flagged || study.diagnosis.source_population == SourcePopulation::feasible);
}

FaultSource named_source(const AssessmentRecord& assessment) {
  return assessment.answered() && assessment.flagged ? assessment.predicted_source : FaultSource::none;
}

bool names_source(ExperimentKind fault, FaultSource named) {
  const FaultSource truth = source_of(fault);
  return named == truth || (truth == FaultSource::other && named == FaultSource::none);
}

bool tells_fault(const ExperimentRecord& record, const AssessmentRecord& assessment) {
  return assessment.answered() && assessment.flagged &&
         names_source(record.draw.kind, named_source(assessment));
}

bool to_be_flagged(const Study& study, const ExperimentRecord& record, FlagTruth truth) {
  return !is_faultless(record.draw.kind) &&
         (truth == FlagTruth::fault || has_impact(study.diagnosis, record));
}

}  // namespace mpm
