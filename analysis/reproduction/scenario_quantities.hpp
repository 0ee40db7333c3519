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

/// Everything that a table of the thesis has of one loop, by name, CV and MV.
///
/// | name | quantity |
/// |------|----------|
/// | ivar, ivar_diag | (3.24), (4.14) or (6.7), (6.8), see Diagnosis |
/// | ivar_basis | variance of y over that of the basis case (6.22) |
/// | sse | square root of the sum of the squared simulation errors (4.17) |
/// | squared_error | that sum itself, which tables 4.3 and 4.5 to 4.12 have (docs/reproduction.md) |
/// | sqr | sum over the samples of |y_basis - y0| (3.31) |
/// | i_mpm, co_dkts, inclination_skn, ... | those of distribution_columns() |
/// | rpn_frequency, rpn_maximum | where the RPN (4.16) of the study is largest, rad/time, and how large |
/// | rpn_lowest_peak | local maximum of the RPN with the lowest frequency, rad/time |
/// | rga_diagonal | of a CV: magnitude of its diagonal entry of the RGA at rpn_frequency |
/// | METHOD.loop_flagged, METHOD.flagged | 1 when the method flags the loop, the CV; 0 when it does not |
/// | METHOD.channel_flagged | 1 when the method flags the channel, 0 when it does not |
/// | METHOD.NUMBER | a number of the method, AssessmentMethodInfo::numbers |
class ScenarioQuantities {
 public:
  /// Runs the loop of `draw`. `study` and `basis` must outlive this; the basis case must have status ok.
  /// `benchmark` is that of the methods that need one.
  ScenarioQuantities(const Study& study, const BasisCase& basis, const ExperimentDraw& draw,
                     const QpSolverFactory& factory, std::optional<AssessedLoop> benchmark);
  ScenarioQuantities(const ScenarioQuantities&) = delete;
  ScenarioQuantities& operator=(const ScenarioQuantities&) = delete;

  ControlStatus status() const { return loop_.status; }

  /// The quantity of one CV or channel; NaN when the loop did not run to its end, or the method says nothing.
  /// Errors: InputError for a name that is none of known().
  double value(const std::string& name, Eigen::Index cv, Eigen::Index mv = -1);

  /// The names of the table above.
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
  std::optional<AssessedLoop> assessed_;  ///< none until a method looks at the loop
  std::map<std::string, Assessment> assessments_;
};

}  // namespace mpm
