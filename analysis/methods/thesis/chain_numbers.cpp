#include "analysis/methods/thesis/chain_numbers.hpp"

#include <string>
#include <utility>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

using ChainRows = std::vector<Row<Diagnosis>>;
using ScenarioRows = std::vector<Row<CvDiagnosis>>;

ChainRows on_each_cv(const ScenarioRows& rows, Eigen::Index cvs) {
  ChainRows list;
  for (const Row<CvDiagnosis>& row : rows)
    list.push_back(of_each<Diagnosis>(row, "cv", static_cast<std::size_t>(cvs), &Diagnosis::cvs));
  return list;
}

/// Appends the further rows to `rows`.
void append(const ChainRows& further, ChainRows& rows) {
  rows.insert(rows.end(), further.begin(), further.end());
}

std::vector<AssessmentNumberInfo> infos(const ChainRows& rows) {
  std::vector<AssessmentNumberInfo> list;
  for (const Row<Diagnosis>& row : rows) {
    const NumberScope scope = row.dimensions.empty()       ? NumberScope::loop
                              : row.dimensions.size() == 1 ? NumberScope::cv
                                                           : NumberScope::cv_lag;
    list.emplace_back(row.text, scope,
                      row.text.name == "ivar"    ? NumberFinding::regression
                      : row.text.heading.empty() ? NumberFinding::none
                                                 : NumberFinding::summary);
  }
  return list;
}

}  // namespace

bool diagnoses(const AssessmentForm& form) {
  return form.find("i_mpm") != nullptr;
}

ChainRows chain_rows(Eigen::Index cvs) {
  ChainRows rows;
  const auto of_each_cv = [&](NumberText text, Eigen::VectorXd Diagnosis::*member) {
    rows.push_back(vector_row<Diagnosis>(std::move(text), "cv", cvs, member));
  };
  const auto of_loop = [&](NumberText text, auto... lens) {
    rows.push_back(member_row<double, Diagnosis>(std::move(text), path(lens...)));
  };
  using M = MpmIndicator;
  const auto indicator = &Diagnosis::indicator;
  const auto alone = &Diagnosis::alone;
  const std::string both = "; NaN unless the experiment has both faults";
  of_each_cv({"ivar", "Ivar = var y / var y0 (3.24, 6.7)"}, &Diagnosis::ivar);
  of_each_cv({"ivar_diag", "Ivar_diag = var y / var y0_diag (4.14, 6.8)"}, &Diagnosis::ivar_diag);
  of_loop({.name = "location_margin",
           .meaning = "distance of Ivar_diag of the located CV from 1, less that of the CV with the next "
                      "largest distance",
           .heading = "location margin"},
          &Diagnosis::location_margin);
  of_loop({"co_dkts", "mean correlation of the differenced moving kurtosis (6.13)"}, indicator, &M::co_dkts);
  of_loop({"co_dskn", "mean correlation of the differenced moving skewness (6.14)"}, indicator, &M::co_dskn);
  of_loop({.name = "i_mpm",
           .meaning = "I_MPM = max(co_dkts, co_dskn) of the located CV (6.15)",
           .heading = "I_{MPM}"},
          indicator, &M::i_mpm);
  of_loop({"co_kts", "mean correlation of the moving kurtosis (5.15)"}, indicator, &M::co_kts);
  of_loop({"co_skn", "mean correlation of the moving skewness (5.15)"}, indicator, &M::co_skn);
  of_loop({"windows_scanned", "number of moving-window lengths"}, indicator, &M::scanned);
  of_loop({"windows_used", "number of window lengths behind the weakest of the means"}, indicator, &M::used);
  of_loop({"ivar_diag_mpm_alone", "Ivar_diag of the affected CV with the mismatch alone" + both}, alone,
          &FaultsAlone::ivar_diag_mpm);
  of_loop({"ivar_diag_ud_alone", "Ivar_diag of the affected CV with the disturbance alone" + both}, alone,
          &FaultsAlone::ivar_diag_ud);
  of_loop({"dominance_mpm", "share of the mismatch in Ivar_diag (6.23)" + both}, alone,
          &FaultsAlone::dominance_mpm);
  return rows;
}

ScenarioRows scenario_rows(Eigen::Index lags) {
  ScenarioRows rows;
  const auto add = [&rows](const auto& of_part) { rows.insert(rows.end(), of_part.begin(), of_part.end()); };
  const auto distribution = &CvDiagnosis::distribution;
  const auto windows = [&](const char* name, const char* meaning, int MpmIndicator::*count) {
    rows.push_back(member_row<double, CvDiagnosis>({name, meaning},
                                                   path(distribution, &DistributionIndicators::mpm, count)));
  };
  const auto acf_curve = [&](const std::string& of, AcfFeatures AcfComparison::*record) {
    rows.push_back(vector_row<CvDiagnosis>(
        {"acf_" + of, "autocorrelation of " + of + " about the setpoint of a CV that has one"}, "lag", lags,
        path(&CvDiagnosis::acf, record, &AcfFeatures::values)));
  };
  rows.push_back(member_row<double>({"sse", "SSE = norm of y_sim - y (4.17), in the unit of the CV"},
                                    &CvDiagnosis::sse));
  windows("windows_scanned", "number of moving-window lengths", &MpmIndicator::scanned);
  windows("windows_used", "number of window lengths behind the weakest of the means", &MpmIndicator::used);
  add(of_part<CvDiagnosis>(distribution_rows(), distribution));
  add(of_part<CvDiagnosis>(scatter_rows(), distribution));
  add(of_part<CvDiagnosis>(acf_rows(), &CvDiagnosis::acf));
  acf_curve("y", &AcfComparison::y);
  acf_curve("y0", &AcfComparison::y0);
  acf_curve("y0_diag", &AcfComparison::y0_diag);
  for (Row<CvDiagnosis>& row : rows)
    row.text.name = "cv_" + row.text.name;
  return rows;
}

ChainRows diagnosis_rows(const Study& study) {
  ChainRows rows = chain_rows(study.cv_count());
  if (study.names_scenarios())
    append(on_each_cv(scenario_rows(lag_count(study)), study.cv_count()), rows);
  return rows;
}

std::vector<AssessmentNumberInfo> chain_number_infos() {
  return infos(chain_rows(1));
}

std::vector<AssessmentNumberInfo> scenario_number_infos() {
  return infos(on_each_cv(scenario_rows(1), 1));
}

std::vector<AssessmentNumber> chain_numbers(const Diagnosis& diagnosis) {
  ChainRows rows = chain_rows(diagnosis.ivar.size());
  if (!diagnosis.cvs.empty())
    append(on_each_cv(scenario_rows(diagnosis.cvs.front().acf.y.values.size()), diagnosis.ivar.size()), rows);
  std::vector<AssessmentNumber> list;
  for (const Row<Diagnosis>& row : rows) {
    const bool of_loop = row.shape.empty(), of_lags = row.shape.size() == 2;
    const auto lags = static_cast<Eigen::Index>(of_lags ? row.shape.back() : 1);
    Eigen::Index place = 0;
    for (const double number : numbers_of(row, diagnosis)) {
      list.push_back({row.text.name, number, of_loop ? -1 : place / lags, of_lags ? place % lags : -1});
      ++place;
    }
  }
  return list;
}

CvDiagnosis cv_diagnosis(const AssessmentRecord& said, Eigen::Index cv) {
  CvDiagnosis found;
  found.flagged = said.flags(cv);
  found.source = said.source_on(cv);
  for (const Row<CvDiagnosis>& row : scenario_rows(said.values("cv_acf_y").cols()))
    if (const NumberPlace* const place = said.answered() ? said.form->find(row.text.name) : nullptr)
      put_numbers(row, found, said.numbers.data() + place->first + cv * place->columns);
  return found;
}

double total_simulation_error(const AssessmentRecord& said) {
  const Eigen::VectorXd sse = said.values("cv_sse").reshaped();
  double total = sse.size() == 0 ? kNaN : 0.0;
  for (const double of_cv : sse)
    total += of_cv;
  return total;
}

}  // namespace mpm
