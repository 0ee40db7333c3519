#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/study_files/study_library.hpp"

namespace mpm::testing {

/// The form of the answers of one method on the loops of a study.
inline std::shared_ptr<const AssessmentForm> form_of(const Study& study, const std::string& method) {
  return assessment_forms(study, {method}).front();
}

/// That of the chain in the chapter 6 study.
inline const std::shared_ptr<const AssessmentForm>& chain_form() {
  static const auto form = form_of(find_study("chapter6"), "botelho");
  return form;
}

/// What the chain says of a loop with this diagnosis: the predicted CV has the largest score.
inline AssessmentRecord chain_says(std::shared_ptr<const AssessmentForm> form, const Diagnosis& diagnosis) {
  Assessment assessment;
  assessment.flagged = diagnosis.impactful;
  for (Eigen::Index cv = 0; cv < diagnosis.ivar.size(); ++cv) {
    const bool predicted = cv == diagnosis.predicted_cv;
    CvAssessment said{predicted && diagnosis.impactful, predicted ? 1.0 : 0.0,
                      predicted ? diagnosis.predicted_source : FaultSource::none};
    if (!diagnosis.cvs.empty()) {
      const CvDiagnosis& each = diagnosis.cvs[static_cast<std::size_t>(cv)];
      said.flagged = each.flagged;
      said.source = predicted ? diagnosis.predicted_source : each.source;
    }
    assessment.cvs.push_back(said);
  }
  assessment.numbers = chain_numbers(diagnosis);
  return kept(std::move(form), assessment);
}

/// The diagnosis that an answer of the chain tells of.
inline Diagnosis diagnosis_of(const AssessmentRecord& said) {
  Diagnosis diagnosis;
  if (!said.answered())
    return diagnosis;
  diagnosis.impactful = said.flagged;
  diagnosis.predicted_cv = said.predicted_cv;
  diagnosis.predicted_source = said.predicted_source;
  const Eigen::Index ny = said.values("ivar").rows();
  for (const Row<Diagnosis>& row : chain_rows(ny))
    put_numbers(row, diagnosis, said.numbers.data() + said.form->find(row.text.name)->first);
  for (Eigen::Index cv = 0; said.form->find("cv_sse") != nullptr && cv < ny; ++cv)
    diagnosis.cvs.push_back(cv_diagnosis(said, cv));
  return diagnosis;
}

/// An answer without numbers of its own: what is said of the loop, and of one CV when there is one.
inline AssessmentRecord verdict(std::shared_ptr<const AssessmentForm> form, bool flagged, double score = 0.0,
                                Eigen::Index cv = -1, FaultSource source = FaultSource::none) {
  Assessment assessment;
  assessment.flagged = flagged;
  assessment.score = score;
  AssessmentRecord record = kept(std::move(form), assessment);
  record.predicted_cv = cv;
  record.predicted_source = source;
  return record;
}

/// An experiment of the chapter 6 study, assessed by the chain: both indices 1 but for `cv`, which has Ivar 2
/// and is located.
inline ExperimentRecord made_up_record(std::int64_t index, ExperimentKind kind, Eigen::Index cv,
                                       double i_mpm) {
  ExperimentRecord record;
  record.draw.index = index;
  record.draw.kind = kind;
  if (kind != ExperimentKind::ud)
    record.draw.mismatches = {{cv, 0, MismatchParameter::gain, 0.5}};
  if (kind != ExperimentKind::mpm)
    record.draw.disturbances = {{cv, 1.0, 50.0}};
  record.status = ExperimentStatus::ok;
  Diagnosis d;
  d.ivar = d.ivar_diag = Eigen::VectorXd::Ones(7);
  d.ivar(cv) = d.ivar_diag(cv) = 2.0 + 0.1 * static_cast<double>(index);
  d.impactful = true;
  d.predicted_cv = cv;
  d.indicator.i_mpm = i_mpm;
  d.predicted_source = i_mpm > 0.1 ? FaultSource::mpm : FaultSource::ud;
  d.alone.dominance_mpm = kind == ExperimentKind::mpm_ud ? 0.8 : std::nan("");
  record.ivar_basis = (2.0 * d.ivar.array() + 1.0).matrix();  // an exact line of slope 2
  record.assessments = {chain_says(chain_form(), d)};
  return record;
}

/// The same without an answer: the experiment came to this end.
inline ExperimentRecord without_verdict(ExperimentRecord record, ExperimentStatus status) {
  record.status = status;
  record.ivar_basis.resize(0);
  for (AssessmentRecord& assessment : record.assessments) {
    const auto form = assessment.form;
    assessment = {};
    assessment.form = form;
  }
  return record;
}

}  // namespace mpm::testing
