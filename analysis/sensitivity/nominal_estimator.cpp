#include "analysis/sensitivity/nominal_estimator.hpp"

#include <set>
#include <utility>

#include "plants/analyser.hpp"

namespace mpm {
namespace {

/// Copies the columns of `of` at which `structures` has this structure to `to`.
void copy_columns(const std::vector<ControlStructure>& structures, const ControlStructure& structure,
                  const Eigen::MatrixXd& of, Eigen::MatrixXd& to) {
  for (std::size_t k = 0; k < structures.size(); ++k)
    if (structures[k] == structure)
      to.col(static_cast<Eigen::Index>(k)) = of.col(static_cast<Eigen::Index>(k));
}

}  // namespace

NominalEstimator::NominalEstimator(const Study& study, const OperatingPoint& point,
                                   const NominalSensitivity& sensitivity, QpSolverFactory factory)
    : study_(study), point_(point), sensitivity_(sensitivity), factory_(std::move(factory)) {}

const NominalSensitivity& NominalEstimator::sensitivity_of(const ControlStructure& structure) {
  const auto found = by_structure_.find(structure);
  if (found != by_structure_.end())
    return found->second;
  OperatingPoint point = point_;
  point.active = structure.active;
  point.fixed_mvs = structure.fixed_mvs;
  return by_structure_.emplace(structure, nominal_sensitivity(study_, point, factory_)).first->second;
}

Eigen::MatrixXd NominalEstimator::simulated(const Trajectory& loop) const {
  const Eigen::MatrixXd y_sim = simulated_output(study_.plant.G, study_.controller.sample_time, point_.u,
                                                 loop.u, as_taken(study_.controller.md_analysers, loop.d));
  return as_shown(study_.controller.analysers, y_sim, y_sim.col(0));
}

NominalOutputs NominalEstimator::estimate(const Trajectory& loop) {
  return estimate(loop, simulated(loop));
}

NominalOutputs NominalEstimator::estimate(const Trajectory& loop, const Eigen::MatrixXd& y_sim) {
  if (study_.sensitivity.structure == SensitivityStructure::operating_point)
    return nominal_outputs(sensitivity_, loop.y, y_sim);
  const std::vector<ControlStructure> structures = control_structures(study_, loop, y_sim);
  NominalOutputs result{y_sim, y_sim, y_sim};
  for (const ControlStructure& structure : std::set(structures.begin(), structures.end())) {
    const NominalSensitivity& sensitivity = sensitivity_of(structure);
    if (study_.sensitivity.switching == SensitivitySwitching::output) {
      const NominalOutputs all = nominal_outputs(sensitivity, loop.y, y_sim);
      copy_columns(structures, structure, all.y0, result.y0);
      copy_columns(structures, structure, all.y0_diag, result.y0_diag);
    } else {
      Eigen::MatrixXd y_then = y_sim;  // no error unless the loop has this structure
      copy_columns(structures, structure, loop.y, y_then);
      const NominalOutputs part = nominal_outputs(sensitivity, y_then, y_sim);
      result.y0 += part.y0 - y_sim;
      result.y0_diag += part.y0_diag - y_sim;
    }
  }
  return result;
}

}  // namespace mpm
