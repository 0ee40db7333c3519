#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/closed_loop.hpp"
#include "scenarios/signals.hpp"

namespace mpm {
namespace {

/// Who can simulate the controller to find S0 can simulate the nominal loop itself. With G0 the model and
/// e = y - y_sim the simulation errors of the record,
///
///   y0      = output of the controller on G0, under the recorded measured disturbances, without noise
///   y0_diag = the same for CV i when the recorded errors e_j of all other CVs are added to the outputs of G0
///   Ivar = var y / (var y0 + v),   Ivar_diag = var y_i / (var y0_diag,i + v_i),   v = var y_b - var y0_b
///
/// as (3.24) and (4.14) have them, but exact where limits are left and reached again, where no linear S0 is:
/// with the errors of all CVs added the loop gives y back. y holds noise and y0 none; v, what noise adds to
/// the variance, is that of the basis case y_b of the same controller, so that only the size of the noise is
/// known of it. A loop is simulated for y0, and where some Ivar lies outside the band of impact one for each
/// CV.
class Counterfactual final : public AssessmentMethod {
 public:
  explicit Counterfactual(const AssessmentContext& context)
      : study_(context.study),
        factory_(context.factory),
        y_set_(setpoints(context.study)),
        dither_(dither(context.study)),
        y_basis_(recorded_basis(context)) {
    const Trajectory nominal =
        simulated(context.basis.trajectory.d, Eigen::MatrixXd::Zero(y_basis_.rows(), y_basis_.cols()));
    if (nominal.status == ControlStatus::ok)
      noise_share_ =
          (1.0 - basis_variance_indices(study_, y_basis_, nominal.y).array().inverse()).cwiseMax(0.0);
  }

  Assessment assess(const AssessedLoop& loop) override {
    if (noise_share_.size() == 0)
      return Assessment::failed("the controller does not run on its own model without noise");
    const Eigen::MatrixXd e = loop.y - loop.y_sim;
    const Trajectory nominal = simulated(loop.d, Eigen::MatrixXd::Zero(e.rows(), e.cols()));
    if (nominal.status != ControlStatus::ok)
      return Assessment::failed("the controller does not run on its own model under these disturbances");
    const Eigen::VectorXd ivar = indices(loop, nominal);
    Assessment assessment;
    assessment.score = 0.0;
    for (const double index : ivar) {
      assessment.score = std::max(assessment.score, distance(index));
      assessment.flagged = assessment.flagged || study_.diagnosis.has_impact(index);
    }
    for (Eigen::Index cv = 0; cv < ivar.size(); ++cv) {
      const double ivar_diag = assessment.flagged ? diagonal_index(loop, e, cv) : kNaN;
      CvAssessment said;
      if (!std::isnan(ivar_diag))
        said = {study_.diagnosis.has_impact(ivar_diag), distance(ivar_diag)};
      assessment.cvs.push_back(said);
      assessment.numbers.push_back({"ivar", ivar(cv), cv});
      assessment.numbers.push_back({"ivar_diag", ivar_diag, cv});
    }
    return assessment;
  }

 private:
  /// The loop of the controller on its model under the disturbances `d`, with `errors` added to the outputs.
  Trajectory simulated(const Eigen::MatrixXd& d, const Eigen::MatrixXd& errors) const {
    const LoopSignals signals{.d = d,
                              .noise = Eigen::MatrixXd::Zero(errors.rows(), errors.cols()),
                              .y_d = errors,
                              .y_set = y_set_,
                              .dither = dither_};
    return run_closed_loop(study_, study_.plant.G, signals, factory_);
  }

  /// var y / (var y0 + v) of each CV, ny. With v = share var y_b its inverse is
  /// var y0 / var y + share var y_b / var y.
  Eigen::VectorXd indices(const AssessedLoop& loop, const Trajectory& nominal) const {
    const Eigen::ArrayXd of_nominal = basis_variance_indices(study_, loop.y, nominal.y);
    const Eigen::ArrayXd of_basis = basis_variance_indices(study_, loop.y, y_basis_);
    return (of_nominal.inverse() + noise_share_ * of_basis.inverse()).inverse();
  }

  /// Ivar_diag of one CV; NaN when its loop does not run to its end.
  double diagonal_index(const AssessedLoop& loop, const Eigen::MatrixXd& e, Eigen::Index cv) const {
    Eigen::MatrixXd others = e;
    others.row(cv).setZero();
    const Trajectory nominal = simulated(loop.d, others);
    return nominal.status == ControlStatus::ok ? indices(loop, nominal)(cv) : kNaN;
  }

  /// Of a variance index from 1, as the study measures it to locate a CV.
  double distance(double ivar) const { return distance_from_one(ivar, study_.diagnosis.location_distance); }

  const Study& study_;
  QpSolverFactory factory_;
  Eigen::MatrixXd y_set_, dither_;
  Eigen::MatrixXd y_basis_;
  Eigen::ArrayXd noise_share_;  ///< v / var y_b of each CV; empty when the basis case cannot be simulated
};

}  // namespace

AssessmentMethodInfo counterfactual_method() {
  return {
      {.name = "counterfactual",
       .title = "counterfactual nominal output",
       .verdict = "a modelling error has an impact: Ivar of some CV against the simulated nominal loop lies "
                  "outside the band of impact",
       .requirements = {},
       .locates_cvs = true,
       .numbers = {{.name = "ivar",
                    .meaning = "var y / (var y0 + v), y0 of the simulated nominal loop, v of noise",
                    .estimates_ivar_basis = true},
                   {.name = "ivar_diag", .meaning = "var y / (var y0_diag + v), of flagged loops"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Counterfactual>(context); }};
}

}  // namespace mpm
