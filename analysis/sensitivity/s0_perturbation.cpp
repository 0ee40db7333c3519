#include "analysis/sensitivity/s0_perturbation.hpp"

#include <algorithm>
#include <utility>

#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"

namespace mpm {
namespace {

bool is_looked_at(const Study& study, Eigen::Index cv) {
  const std::vector<Eigen::Index>& cvs = study.s0_perturbation.cvs;
  return cvs.empty() || std::find(cvs.begin(), cvs.end(), cv) != cvs.end();
}

/// Returns Ivar_diag with each of the models.
Eigen::VectorXd variance_indices(const std::vector<Eigen::RowVectorXd>& models,
                                 const Eigen::Ref<const Eigen::RowVectorXd>& y,
                                 const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) {
  Eigen::VectorXd index(static_cast<Eigen::Index>(models.size()));
  for (Eigen::Index m = 0; m < index.size(); ++m)
    index(m) = variance_index(
        y.transpose(), diagonal_nominal_output(models[static_cast<std::size_t>(m)], y, y_sim).transpose());
  return index;
}

}  // namespace

std::vector<DiagonalFit> diagonal_fits(const NominalSensitivity& sensitivity, double sample_time) {
  std::vector<DiagonalFit> fits;
  for (std::size_t a = 0; a < sensitivity.active.size(); ++a) {
    const Eigen::Index cv = sensitivity.active[a].cv;
    const Eigen::MatrixXd& response = sensitivity.step_response[a];
    // With fewer than 3 samples there is nothing to fit: two samples determine the two parameters.
    fits.push_back(
        {cv, response.cols() < 3 ? SecondOrderFit{} : fit_second_order(response.row(cv), sample_time)});
  }
  return fits;
}

S0Perturbation::S0Perturbation(const Study& study, const NominalSensitivity& sensitivity) {
  if (study.s0_perturbation.multipliers.empty())
    return;
  const double Ts = study.controller.sample_time;
  const std::vector<DiagonalFit> fits = diagonal_fits(sensitivity, Ts);
  for (std::size_t a = 0; a < fits.size(); ++a) {
    const auto& [cv, fit] = fits[a];
    if (fit.status != FitStatus::ok || !is_looked_at(study, cv))
      continue;
    const Eigen::RowVectorXd T0 = sensitivity.step_response[a].row(cv);
    const auto [tau, xi] = fit.model;
    const Eigen::RowVectorXd T = second_order_response({tau, xi}, Ts, T0.size());
    Models models{cv, {}, {}};
    // The difference is computed first: for a multiplier of 1 it is zero, and T0 + 0 is T0 to the last bit.
    for (const double m : study.s0_perturbation.multipliers) {
      models.time_constant.emplace_back(T0 + (second_order_response({m * tau, xi}, Ts, T0.size()) - T));
      models.damping.emplace_back(T0 + (second_order_response({tau, m * xi}, Ts, T0.size()) - T));
    }
    models_.push_back(std::move(models));
  }
}

PerturbedIvar S0Perturbation::ivar_diag(Eigen::Index cv, const Eigen::Ref<const Eigen::RowVectorXd>& y,
                                        const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) const {
  for (const Models& models : models_)
    if (models.cv == cv)
      return {variance_indices(models.time_constant, y, y_sim), variance_indices(models.damping, y, y_sim)};
  return {};
}

}  // namespace mpm
