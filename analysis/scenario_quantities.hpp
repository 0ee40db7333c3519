#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/basis_case.hpp"
#include "analysis/distribution_indicators.hpp"

namespace mpm {

/// Everything that a table of the thesis has of one loop, by name and CV.
///
/// | name | quantity |
/// |------|----------|
/// | ivar, ivar_diag | (3.24), (4.14) or (6.7), (6.8), see Diagnosis |
/// | ivar_basis | variance of y over that of the basis case (6.22) |
/// | sse | square root of the sum of the squared simulation errors (4.17) |
/// | squared_error | that sum itself, which tables 4.3 and 4.5 to 4.12 have (docs/reproduction.md) |
/// | sqr | sum over the samples of |y_basis - y0| (3.31) |
/// | i_mpm, co_dkts, inclination_skn, ... | those of distribution_columns() |
class ScenarioQuantities {
 public:
  /// Runs the loop of `draw`. `study` and `basis` must outlive this; the basis case must have status ok.
  ScenarioQuantities(const Study& study, const BasisCase& basis, const ExperimentDraw& draw,
                     const QpSolverFactory& factory);

  ControlStatus status() const { return loop_.status; }

  /// The quantity of one CV; NaN when the loop did not run to its end. Errors: InputError for a name that is
  /// none of names().
  double value(const std::string& name, Eigen::Index cv);

  /// The names of the table above.
  static std::vector<std::string> names();

 private:
  const DistributionIndicators& indicators(Eigen::Index cv);

  const Study& study_;
  Trajectory loop_;
  NominalOutputs nominal_;
  std::map<std::string, Eigen::VectorXd> by_cv_;
  std::map<Eigen::Index, DistributionIndicators> indicators_;
};

}  // namespace mpm
