#include "analysis/indicators/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "analysis/indicators/simulation_error.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// Returns the window length of the ellipses (5.3.1): the prediction horizon, or the nearest length that fits
/// the record.
int one_window(const Study& study, Eigen::Index samples) {
  const auto longest = static_cast<int>(samples - kFewestCorrelatedPairs);
  return std::clamp(static_cast<int>(study.controller.prediction_horizon), kShortestWindow,
                    std::max(kShortestWindow, longest));
}

}  // namespace

SetpointTrajectories variance_centres(const Study& study, Eigen::Index first, Eigen::Index samples) {
  const Eigen::MatrixXd y_set = setpoints(study);
  if (y_set.size() == 0 || study.diagnosis.variance_centre == VarianceCentre::mean)
    return {};
  SetpointTrajectories trajectories(static_cast<std::size_t>(study.cv_count()));
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (study.controller.has_setpoint(cv))
      trajectories[static_cast<std::size_t>(cv)] = y_set.row(cv).segment(first, samples).transpose();
  return trajectories;
}

double distance_from_one(double ivar, LocationDistance distance) {
  return distance == LocationDistance::linear ? std::abs(ivar - 1.0) : std::abs(std::log(ivar));
}

Eigen::Index farthest_from_one(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag,
                               LocationDistance distance) {
  Eigen::Index farthest = -1;
  double largest = -1.0;
  for (Eigen::Index i = 0; i < ivar_diag.size(); ++i) {
    const double away = distance_from_one(ivar_diag(i), distance);
    if (away > largest) {
      largest = away;
      farthest = i;
    }
  }
  return farthest;
}

double location_margin(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance) {
  std::vector<double> away;
  for (const double ivar : ivar_diag)
    if (!std::isnan(ivar))
      away.push_back(distance_from_one(ivar, distance));
  if (away.size() < 2)
    return std::numeric_limits<double>::quiet_NaN();
  std::partial_sort(away.begin(), away.begin() + 2, away.end(), std::greater<>());
  return away[0] - away[1];
}

Eigen::VectorXd basis_variance_indices(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                       const Eigen::Ref<const Eigen::MatrixXd>& y_basis) {
  return variance_indices(y, y_basis, variance_centres(study, 0, study.simulation.samples));
}

DiagnosisChain::DiagnosisChain(const Study& study) : DiagnosisChain(study, 0, study.simulation.samples) {}

DiagnosisChain::DiagnosisChain(const Study& study, Eigen::Index first, Eigen::Index samples)
    : options_(study.diagnosis),
      mpm_threshold_(mpm_threshold(study)),
      every_cv_(study.names_scenarios()),
      y_set_(variance_centres(study, first, samples)),
      windows_(window_scan(study)),
      scanner_(samples),
      window_(one_window(study, samples)),
      distribution_scanner_(samples) {}

Diagnosis DiagnosisChain::diagnose(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                   const NominalOutputs& nominal) {
  Diagnosis diagnosis;
  diagnosis.ivar = variance_indices(y, nominal.y0, y_set_);
  diagnosis.ivar_diag = variance_indices(y, nominal.y0_diag, y_set_);
  diagnosis.impactful = (diagnosis.ivar.array() < options_.impact_lower).any() ||
                        (diagnosis.ivar.array() > options_.impact_upper).any();
  if (every_cv_)
    diagnosis.cvs = diagnose_each(y, nominal, diagnosis.ivar_diag);
  diagnosis.predicted_cv = farthest_from_one(diagnosis.ivar_diag, options_.location_distance);
  diagnosis.location_margin = mpm::location_margin(diagnosis.ivar_diag, options_.location_distance);
  if (diagnosis.predicted_cv < 0)
    return diagnosis;
  diagnosis.indicator = indicator_of(diagnosis.predicted_cv, y, nominal);
  diagnosis.predicted_source = source_of(diagnosis.indicator);
  return diagnosis;
}

AcfComparison DiagnosisChain::compare(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                      const NominalOutputs& nominal) const {
  std::optional<Eigen::VectorXd> y_set;
  if (!y_set_.empty())
    y_set = y_set_[static_cast<std::size_t>(cv)];
  return compare_autocorrelations(y.row(cv).transpose(), nominal.y0.row(cv).transpose(),
                                  nominal.y0_diag.row(cv).transpose(), y_set);
}

std::vector<CvDiagnosis> DiagnosisChain::diagnose_each(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                                       const NominalOutputs& nominal,
                                                       const Eigen::Ref<const Eigen::VectorXd>& ivar_diag) {
  const Eigen::VectorXd sse = simulation_errors(y, nominal.y_sim);
  std::vector<CvDiagnosis> cvs;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    CvDiagnosis of_cv;
    of_cv.flagged = options_.has_impact(ivar_diag(cv));
    of_cv.distribution =
        distribution_scanner_.compute(y.row(cv).transpose(), nominal.y0.row(cv).transpose(),
                                      nominal.y0_diag.row(cv).transpose(), windows_, window_);
    of_cv.acf = compare(cv, y, nominal);
    of_cv.source = of_cv.flagged ? source_of(of_cv.distribution.mpm) : FaultSource::none;
    of_cv.sse = sse(cv);
    cvs.push_back(of_cv);
  }
  return cvs;
}

MpmIndicator DiagnosisChain::indicator_of(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                          const NominalOutputs& nominal) {
  const Eigen::VectorXd y0_diag = nominal.y0_diag.row(cv);
  const Eigen::VectorXd e0_diag = y0_diag - y.row(cv).transpose();  // (6.9)
  return scanner_.scan(y0_diag, e0_diag, windows_);
}

FaultSource DiagnosisChain::source_of(const MpmIndicator& indicator) const {
  if (std::isnan(indicator.i_mpm))
    return FaultSource::none;
  return indicator.i_mpm > mpm_threshold_ ? FaultSource::mpm : FaultSource::ud;
}

}  // namespace mpm
