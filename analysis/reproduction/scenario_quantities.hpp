#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "analysis/study_files/thesis_table.hpp"

namespace mpm {

/// Every quantity of one loop that a table of the thesis has, by name, CV and MV.
///
/// | name | quantity |
/// |------|----------|
/// | ivar, ivar_diag | (3.24), (4.14) or (6.7), (6.8), see Diagnosis |
/// | ivar_basis | variance of y over that of the basis case (6.22) |
/// | sse | square root of the sum of the squared simulation errors (4.17) |
/// | squared_error | the sum itself, used in tables 4.3 and 4.5 to 4.12 (docs/reproduction.md) |
/// | sqr | sum over the samples of |y_basis - y0| (3.31) |
/// | i_mpm, co_dkts, inclination_skn, ... | the indicators of distribution_rows() |
/// | rpn_frequency, rpn_maximum | frequency of the largest RPN (4.16) of the study, rad/time, and this RPN |
/// | rpn_lowest_peak | frequency of the first local maximum of the RPN, rad/time |
/// | rga_diagonal | magnitude of the diagonal entry of a CV in the RGA at rpn_frequency |
/// | METHOD.loop_flagged, METHOD.flagged | 1 if the method flags the loop or the CV, respectively, else 0 |
/// | METHOD.channel_flagged | 1 if the method flags the channel, else 0 |
/// | METHOD.NUMBER | a number of the method, AssessmentMethodInfo::numbers |
class ScenarioQuantities {
 public:
  /// Runs the loop of `draw`. `study` and `basis` must outlive this object; the basis case must have status
  /// ok. `benchmark` is for the methods that need one.
  ScenarioQuantities(const Study& study, const BasisCase& basis, const ExperimentDraw& draw,
                     const QpSolverFactory& factory, std::optional<AssessedLoop> benchmark);
  ScenarioQuantities(const ScenarioQuantities&) = delete;
  ScenarioQuantities& operator=(const ScenarioQuantities&) = delete;

  ControlStatus status() const { return loop_.status; }

  /// Returns the quantity of one CV or channel; NaN if the loop did not run to its end, or if the method says
  /// nothing. Errors: InputError for a name that is not among known().
  double value(const std::string& name, Eigen::Index cv, Eigen::Index mv = -1);

  /// Returns the quantities of the table above.
  static const std::vector<TableQuantity>& known();

 private:
  const std::vector<CvDiagnosis>& cvs();
  const LoopInteraction& interaction();
  double relative_gain(Eigen::Index cv);
  const Assessment& assessment(const std::string& method);
  double method_value(const std::string& method, std::string_view name, Eigen::Index cv, Eigen::Index mv);

  Trajectory loop_;
  AssessmentContext context_;
  NominalOutputs nominal_;
  DiagnosisChain chain_;
  Diagnosis diagnosis_;
  std::map<std::string, Eigen::VectorXd> by_cv_;
  std::optional<LoopInteraction> interaction_;
  std::optional<AssessedLoop> assessed_;  ///< none until a method assesses the loop
  std::map<std::string, Assessment> assessments_;
};

}  // namespace mpm
