#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "scenarios/loop/closed_loop.hpp"

namespace mpm {

/// The variance that noise adds to a CV, for the method `counterfactual`: v of Ivar = var y / (var y0 + v).
/// With var y_b that of the benchmark and var y0_b that of the same loop simulated without noise,
enum class NoiseVariance : std::int8_t {
  difference = 0,  ///< v = var y_b - var y0_b, which may be negative: noise also keeps CVs off their limits
  positive = 1,    ///< v = max(0, var y_b - var y0_b): noise that adds to the variance or does nothing
  none = 2,        ///< v = 0
};

/// Options of the method `counterfactual`, analysis/methods/ours/counterfactual_method.
struct CounterfactualOptions {
  NoiseVariance noise = NoiseVariance::difference;

  bool operator==(const CounterfactualOptions&) const = default;
};

/// Simulates the nominal loop itself, instead of filtering by S0. With the model G0 and the simulation
/// errors e = y - y_sim of the record,
///
///   y0      = output of the controller on G0, under the recorded measured disturbances, without noise
///   y0_diag = the same for CV i when the recorded errors e_j of all other CVs are added to the outputs of G0
///   Ivar = var y / (var y0 + v),   Ivar_diag = var y_i / (var y0_diag,i + v_i),   v = var y_b - var y0_b
///
/// The G0 that stands for the plant is corrected by what the benchmark shows of its errors (learnt_model()).
/// The equations are those of (3.24) and (4.14), but exact also if the loop leaves limits and reaches them
/// again, for which no linear S0 exists: with the errors of all CVs added, the loop returns y. y contains
/// noise and y0 does not; v is what noise adds to the variance, taken from the basis case y_b of the same
/// controller (NoiseVariance has other choices). Gaps of e are filled by linear interpolation. For windows,
/// the record is simulated once from its start. If the rows of the record are late by l against the inputs
/// (LearntModel::late()), the loop is simulated without this delay, and its outputs are then made as late as
/// the rows of the record: with x the output of G0 alone, y0_diag(k) = x(k - l) + e(k), where e has acted in
/// the loop l earlier, in whole samples.
///
/// v comes from one realisation of the noise and of the excitation of the benchmark. A level that is free in
/// its range has a different variance in each record, and noise makes it smaller as often as larger. So, if
/// errors of the model and its noise are learnt, an Ivar outside of the band is checked again: the nominal
/// loop is simulated under kNoiseDraws draws of that noise. With m the mean of var y0 over them and s the
/// standard deviation of log var y0,
///
///   Ivar = var y / m,   c = s sqrt(1 + 1 / kNoiseDraws) t,   Ivar_diag = var y_i / var y0_diag,i
///
/// y0_diag has the first draw in CV i; t is the quantile of Student's distribution beyond which chance alone
/// takes some CV with the probability kChance. An impact needs |log Ivar| > c. The distance of Ivar from 1
/// counts as min(distance, a |log Ivar| / c), with a the distance of the edge of the band.
///
/// All methods under one context share one object (of_context()), and with it the loops that it has
/// simulated.
class CounterfactualLoop {
 public:
  /// The verdict of Ivar on a loop.
  struct Impact {
    /// Flagged if some Ivar lies outside the band of impact, with the number `ivar` of each CV and no verdict
    /// on single CVs; failed if the controller does not run on its own model.
    Assessment assessment = {};
    Eigen::VectorXd chance = {};  ///< c of each CV; 0: no draws
  };

  /// `context` must outlive it.
  explicit CounterfactualLoop(const AssessmentContext& context);

  /// The shared object of the context, in AssessmentContext::derived.
  static std::shared_ptr<CounterfactualLoop> of_context(const AssessmentContext& context);

  /// Simulates one closed loop, and kNoiseDraws more if an Ivar is outside of the band; none of them if the
  /// disturbances are those of the previous record.
  Impact impact(const AssessedLoop& loop);

  /// Ivar_diag of each CV, ny; NaN if its loop does not run to its end. Simulates one closed loop for each
  /// CV, derived from the record.
  Eigen::VectorXd ivar_diag(const AssessedLoop& loop, const Impact& impact) const;

  /// The verdict of Ivar_diag on each CV of a flagged loop; none if it is NaN. If all are NaN, no loop
  /// runs to its end under the errors of the others, and Ivar of `impact` decides.
  std::vector<CvAssessment> located(const Eigen::VectorXd& ivar_diag, const Impact& impact) const;

 private:
  static constexpr int kNoiseDraws = 16;
  static constexpr double kChance = 0.01;

  /// Ivar of each CV, and c, how far chance alone takes |log Ivar|.
  struct Indices {
    Eigen::VectorXd ivar, chance;
  };

  Eigen::VectorXd noise_of_benchmark(const AssessmentContext& context) const;
  Trajectory simulated(const Study& study, const Eigen::MatrixXd& d, const Eigen::MatrixXd& y_set,
                       const Eigen::MatrixXd& errors) const;
  const Trajectory& undisturbed(const AssessedLoop& whole);
  Eigen::MatrixXd disturbed_output(const AssessedLoop& whole, Eigen::Index cv, bool is_drawn) const;
  Eigen::VectorXd noise_variance(const Eigen::VectorXd& noisy, const Eigen::VectorXd& quiet) const;
  Eigen::VectorXd indices(const AssessedLoop& loop, const Eigen::MatrixXd& nominal,
                          const Eigen::Ref<const Eigen::VectorXd>& added) const;
  std::optional<Indices> indices_under_noise(const AssessedLoop& loop);
  const std::vector<Eigen::MatrixXd>& outputs_under_noise(const Eigen::MatrixXd& d);
  Eigen::MatrixXd drawn_noise_of(Eigen::Index samples, int draw) const;
  bool outside(const Eigen::VectorXd& ivar) const;
  bool has_impact(double ivar, double chance) const;
  double distance(double ivar, double chance) const;

  const Study& study_;
  std::shared_ptr<const LearntModel> learnt_;
  TransferMatrix plant_;  ///< G0, or the plant as the benchmark shows it
  double late_;           ///< by how many samples rows of CVs are late; below 0: early
  QpSolverFactory factory_;
  Eigen::MatrixXd y_set_, dither_;
  Eigen::MatrixXd nominal_d_;             ///< disturbances under which `nominal_` was simulated
  Trajectory nominal_;                    ///< the loop of y0; empty before the first record
  Eigen::MatrixXd drawn_d_;               ///< disturbances under which `drawn_y_` was simulated
  std::vector<Eigen::MatrixXd> drawn_y_;  ///< y0 under each draw; empty if one does not run to its end
  Eigen::VectorXd noise_;                 ///< v of each CV; empty when the basis case cannot be simulated
};

}  // namespace mpm
