#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/statistics/variance.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/closed_loop.hpp"
#include "scenarios/signals.hpp"

namespace mpm {
namespace {

constexpr double kLeastNominalShare = 0.1;

/// Who can simulate the controller to find S0 can simulate the nominal loop itself. With G0 the model and
/// e = y - y_sim the simulation errors of the record,
///
///   y0      = output of the controller on G0, under the recorded measured disturbances, without noise
///   y0_diag = the same for CV i when the recorded errors e_j of all other CVs are added to the outputs of G0
///   Ivar = var y / (var y0 + v),   Ivar_diag = var y_i / (var y0_diag,i + v_i),   v = var y_b - var y0_b
///
/// as (3.24) and (4.14) have them, but exact where limits are left and reached again, where no linear S0 is:
/// with the errors of all CVs added the loop gives y back. y holds noise and y0 none; v, what noise adds to
/// the variance, is that of the basis case y_b of the same controller, so that only the variance of the
/// benchmark is known of it (NoiseVariance has other choices). A loop is simulated for y0, and where some
/// Ivar lies outside the band of impact one for each CV. Gaps of e are closed along straight lines. Of a
/// window the record is simulated from its start, once for all windows.
class Counterfactual final : public AssessmentMethod {
 public:
  explicit Counterfactual(const AssessmentContext& context)
      : study_(context.study),
        factory_(context.factory),
        y_set_(setpoints(context.study)),
        dither_(dither(context.study)),
        loops_(static_cast<std::size_t>(context.study.cv_count()) + 1) {
    const Eigen::MatrixXd y_basis = gaps_closed(recorded_basis(context));
    const SetpointTrajectories centres = variance_centres(study_, 0, y_basis.cols());
    const Trajectory& nominal =
        simulated(0, context.basis.trajectory.d, Eigen::MatrixXd::Zero(y_basis.rows(), y_basis.cols()));
    if (nominal.status == ControlStatus::ok)
      noise_ = noise_variance(variances(y_basis, centres), variances(nominal.y, centres));
  }

  Assessment assess(const AssessedLoop& loop) override {
    if (noise_.size() == 0)
      return Assessment::failed("the controller does not run on its own model without noise");
    const AssessedLoop& whole = loop.from_start();
    const Eigen::MatrixXd e = gaps_closed(whole.y - whole.y_sim);
    const Eigen::MatrixXd y = loop.y_sim + loop.in_window(e);
    const Trajectory& nominal = simulated(0, whole.d, Eigen::MatrixXd::Zero(e.rows(), e.cols()));
    if (nominal.status != ControlStatus::ok)
      return Assessment::failed("the controller does not run on its own model under these disturbances");
    const Eigen::VectorXd ivar = indices(loop, y, nominal);
    Assessment assessment;
    assessment.score = 0.0;
    for (const double index : ivar) {
      assessment.score = std::max(assessment.score, distance(index));
      assessment.flagged = assessment.flagged || study_.diagnosis.has_impact(index);
    }
    for (Eigen::Index cv = 0; cv < ivar.size(); ++cv) {
      const double ivar_diag = assessment.flagged ? diagonal_index(loop, y, e, cv) : kNaN;
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
  /// v of each CV from the variances of the benchmark and of the same loop without noise.
  Eigen::VectorXd noise_variance(const Eigen::VectorXd& noisy, const Eigen::VectorXd& quiet) const {
    switch (study_.assessment.counterfactual.noise) {
      case NoiseVariance::difference:
        return noisy - quiet;
      case NoiseVariance::positive:
        return (noisy - quiet).cwiseMax(0.0);
      case NoiseVariance::none:
        break;
    }
    return Eigen::VectorXd::Zero(noisy.size());
  }

  /// A loop that was simulated, with what it was simulated under.
  struct Simulated {
    Eigen::MatrixXd d, errors;
    Trajectory loop;
  };

  /// The loop of the controller on its model under the disturbances `d`, with `errors` added to the outputs.
  /// Each place keeps its last one: windows of a record ask for the same, and so do all records whose
  /// disturbances are those of the study.
  const Trajectory& simulated(std::size_t place, const Eigen::MatrixXd& d, const Eigen::MatrixXd& errors) {
    Simulated& kept = loops_[place];
    if (kept.loop.y.size() == 0 || kept.d != d || kept.errors != errors) {
      const LoopSignals signals{.d = d,
                                .noise = Eigen::MatrixXd::Zero(errors.rows(), errors.cols()),
                                .y_d = errors,
                                .y_set = y_set_,
                                .dither = dither_};
      kept = {d, errors, run_closed_loop(study_, study_.plant.G, signals, factory_)};
    }
    return kept.loop;
  }

  /// var y / (var y0 + v) of each CV, ny.
  Eigen::VectorXd indices(const AssessedLoop& loop, const Eigen::MatrixXd& y,
                          const Trajectory& nominal) const {
    const SetpointTrajectories centres = variance_centres(study_, loop.first, loop.samples());
    const Eigen::ArrayXd of_nominal = variance_indices(y, loop.in_window(nominal.y), centres);
    // A v below 0 can outweigh a y0 that hardly moves: the nominal variance is not taken for less than a
    // tenth of its own.
    const Eigen::ArrayXd inverse = of_nominal.inverse() + noise_.array() / variances(y, centres).array();
    return inverse.max(kLeastNominalShare * of_nominal.inverse()).inverse();
  }

  /// Ivar_diag of one CV; NaN when its loop does not run to its end.
  double diagonal_index(const AssessedLoop& loop, const Eigen::MatrixXd& y, const Eigen::MatrixXd& e,
                        Eigen::Index cv) {
    Eigen::MatrixXd others = e;
    others.row(cv).setZero();
    const Trajectory& nominal = simulated(static_cast<std::size_t>(cv) + 1, loop.from_start().d, others);
    return nominal.status == ControlStatus::ok ? indices(loop, y, nominal)(cv) : kNaN;
  }

  /// Of a variance index from 1, as the study measures it to locate a CV.
  double distance(double ivar) const { return distance_from_one(ivar, study_.diagnosis.location_distance); }

  const Study& study_;
  QpSolverFactory factory_;
  Eigen::MatrixXd y_set_, dither_;
  std::vector<Simulated> loops_;  ///< y0, then y0_diag of each CV
  Eigen::VectorXd noise_;         ///< v of each CV; empty when the basis case cannot be simulated
};

}  // namespace

AssessmentMethodInfo counterfactual_method() {
  return {
      {.name = "counterfactual",
       .title = "counterfactual nominal output",
       .verdict = "a modelling error has an impact: Ivar of some CV against the simulated nominal loop lies "
                  "outside the band of impact",
       .requirements = {.complete_record = false},
       .locates_cvs = true,
       .numbers = {{.name = "ivar",
                    .meaning = "var y / (var y0 + v), y0 of the simulated nominal loop, v of noise",
                    .estimates_ivar_basis = true},
                   {.name = "ivar_diag", .meaning = "var y / (var y0_diag + v), of flagged loops"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Counterfactual>(context); }};
}

}  // namespace mpm
