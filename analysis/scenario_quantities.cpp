#include "analysis/scenario_quantities.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/nominal_estimator.hpp"
#include "analysis/simulation_error.hpp"
#include "plants/error.hpp"

namespace mpm {

ScenarioQuantities::ScenarioQuantities(const Study& study, const BasisCase& basis, const ExperimentDraw& draw,
                                       const QpSolverFactory& factory)
    : study_(study), loop_(simulate_experiment(study, draw, factory)) {
  if (loop_.status != ControlStatus::ok)
    return;
  nominal_ = NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(loop_);
  const Diagnosis diagnosis = DiagnosisChain(study).diagnose(loop_.y, nominal_, basis.trajectory.y);
  by_cv_["ivar"] = diagnosis.ivar;
  by_cv_["ivar_diag"] = diagnosis.ivar_diag;
  by_cv_["ivar_basis"] = diagnosis.ivar_basis;
  by_cv_["sse"] = simulation_errors(loop_.y, nominal_.y_sim);
  by_cv_["squared_error"] = by_cv_["sse"].cwiseAbs2();
  by_cv_["sqr"] = (basis.trajectory.y - nominal_.y0).cwiseAbs().rowwise().sum();
}

double ScenarioQuantities::value(const std::string& name, Eigen::Index cv) {
  const std::vector<std::string> known = names();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError("quantity", fmt::format("'{}'", name), fmt::format("{}", fmt::join(known, ", ")));
  if (loop_.status != ControlStatus::ok)
    return std::numeric_limits<double>::quiet_NaN();
  if (const auto found = by_cv_.find(name); found != by_cv_.end())
    return found->second(cv);
  for (const NumberColumn<DistributionIndicators>& column : distribution_columns())
    if (column.name == name)
      return column.value(indicators(cv));
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> ScenarioQuantities::names() {
  std::vector<std::string> names{"ivar", "ivar_diag", "ivar_basis", "sse", "squared_error", "sqr"};
  for (const NumberColumn<DistributionIndicators>& column : distribution_columns())
    names.push_back(column.name);
  return names;
}

const DistributionIndicators& ScenarioQuantities::indicators(Eigen::Index cv) {
  const auto found = indicators_.find(cv);
  if (found != indicators_.end())
    return found->second;
  DistributionScanner scanner(study_.simulation.samples);
  return indicators_
      .emplace(cv, scanner.compute(loop_.y.row(cv).transpose(), nominal_.y0.row(cv).transpose(),
                                   nominal_.y0_diag.row(cv).transpose(), window_scan(study_),
                                   study_.controller.prediction_horizon))
      .first->second;
}

}  // namespace mpm
