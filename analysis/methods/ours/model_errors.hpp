#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// One error that a channel of the model may have: normal about none.
struct ChannelError {
  Eigen::Index input;  ///< of the channel: an MV or an MD
  MismatchParameter parameter;
  double deviation;  ///< of the factor about 1, or of the shift of the dead time about 0
};

/// The possible errors of the model of a CV in a plant that has no fault.
struct ModelErrorPrior {
  std::vector<ChannelError> channels;
  double bias = 0.0;  ///< standard deviation of a constant, in those of the noise
};

/// Errors of gain, time constant and dead time of every channel of a CV, each of the relative size `share`.
/// The error of a dead time shorter than a sample is this share of a sample.
ModelErrorPrior relative_errors(const Study& study, Eigen::Index cv, double share, double bias);

/// The errors of gain, time constant and dead time that the worlds of the study draw, as normal ones of their
/// variance; none without worlds. Further lags and the background are not among them.
ModelErrorPrior drawn_errors(const Study& study, Eigen::Index cv);

/// The inputs of the model, (nu + nd) x N.
Eigen::MatrixXd model_inputs(const AssessedLoop& loop);

/// The model of one CV with the small errors that every model has, as a healthy record shows them. With delta
/// the errors, S the slopes of the output of the model by them, c a constant and n the noise, the simulation
/// error is
///
///   e = S delta + W eta + c + n,    delta ~ N(0, D^2),    eta ~ N(0, wander^2),    c ~ N(0, bias^2),
///
/// in closed loop, too, because S of a sample is made of inputs before it. W are errors of the gains that
/// wander along the record, as those of a nonlinear plant do: the response of each channel times a polygon in
/// time with free corners. The benchmark gives the sizes of n and eta by their marginal likelihood, and delta
/// a mean, with which the model is corrected, and a covariance. eta differs from record to record.
class ModelErrors {
 public:
  /// `e` (N) are the simulation errors of the benchmark, NaN where there is no sample, `inputs` (nu + nd x N)
  /// with `initial` (nu + nd) before them what moved the model. The noise is that which is `known`, or is
  /// learnt with a deviation of `least` or more. The errors are those of a model whose channels all have a
  /// dead time that is longer by `late` >= 0, in the time unit of the plant. Throws InputError for fewer than
  /// kFewestNoiseSamples samples.
  ModelErrors(const Study& study, Eigen::Index cv, const ModelErrorPrior& prior,
              const Eigen::Ref<const Eigen::RowVectorXd>& e, const Eigen::Ref<const Eigen::MatrixXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& initial, double least,
              const std::optional<BaseNoise>& known = {}, double late = 0.0);
  /// Of a model without errors, under this noise.
  ModelErrors(const Study& study, Eigen::Index cv, const BaseNoise& noise);

  /// 1 x (nu + nd): the model of the CV, corrected by the mean of the errors.
  const TransferMatrix& model() const { return model_; }
  /// The same without what is `late` of it: the rows of a record may be, the plant is not. No dead time is
  /// below 0.
  TransferMatrix plant() const;
  const BaseNoise& noise() const { return noise_.best; }
  const NoisePosterior& noises() const { return noise_; }
  /// Does the benchmark speak against a model without errors? It does where errors wander, or where the
  /// score test of delta = 0 rejects: b = S' R^-1 e, with the noise and the constant taken out of both, is
  /// N(0, S' R^-1 S) without errors, and b' (S' R^-1 S)^-1 b chi squared.
  bool rejects_exact_model() const { return wanders() || exact_p_ < kRejectsExact; }
  /// Whether errors change along a healthy record, as those of a nonlinear plant do.
  bool wanders() const { return wander_ > 0.0; }
  /// Whether the benchmark shows more than a background beside the errors, so that these may be others than
  /// are looked for.
  bool are_doubtful() const { return wanders() || slow_part(noise_.best) > kMostBackground; }
  /// Of the errors, without the constant.
  Eigen::Index count() const { return mean_.size(); }
  /// The model with errors out of their posterior, of `z` ~ N(0, I) of the size count().
  TransferMatrix drawn(const Eigen::Ref<const Eigen::VectorXd>& z) const;

  /// The corrected simulation error of a record, N.
  Eigen::RowVectorXd correction(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// D S of a record and below it wander W, in CV units.
  Eigen::MatrixXd slopes(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// The same where a channel has this mismatch, from the slopes without it. Further rows below stay as they
  /// are.
  Eigen::MatrixXd slopes(Eigen::MatrixXd without, const Mismatch& mismatch,
                         const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// What is still unknown, q x N in standard deviations of the noise: the error of the corrected model is
  /// Z' z + n, z ~ N(0, I). Further rows of `slopes`, in CV units, are unknown as well. Directions that no
  /// record can tell from none are left out.
  Eigen::MatrixXd directions(const Eigen::Ref<const Eigen::MatrixXd>& slopes) const;

 private:
  static constexpr double kMostBackground = 1.0;  ///< slow part of the noise over the white one
  static constexpr double kRejectsExact = 1e-4;   ///< p-value below which an exact model is rejected

  /// The response to a change of one channel: of an error, over one standard deviation to either side.
  struct Slope {
    Eigen::Index input;
    DiscreteChannel above, below;
    double scale;  ///< of their difference

    Eigen::RowVectorXd response(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  };

  Slope slope_of(const TransferMatrix& model, const ChannelError& error) const;
  /// The noise, and whether errors vary in time, from the residual of the mean in a healthy record. `unknown`
  /// are the rows that explain a part of it.
  void learn_noise(const Eigen::Ref<const Eigen::RowVectorXd>& left, const Eigen::MatrixXd& unknown,
                   const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                   const Eigen::Ref<const Eigen::VectorXd>& initial, double least);
  /// Rows of gains that wander: of each channel its response times a hat of each corner.
  Eigen::MatrixXd wandering(const TransferMatrix& model, const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                            const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// The model with these errors, in their standard deviations.
  TransferMatrix with_errors(const Eigen::Ref<const Eigen::VectorXd>& z) const;
  void take(TransferMatrix model);

  double sample_time_, bias_ = 0.0;
  double wander_ = 0.0;      ///< deviation of each gain at a corner; 0: none wanders
  Eigen::Index corner_ = 1;  ///< samples between corners
  std::vector<ChannelError> errors_;
  TransferMatrix nominal_, late_, model_;  ///< 1 x (nu + nd): as it is, late, and corrected
  Eigen::VectorXd mean_;                   ///< of the errors, over their D
  NoisePosterior noise_;
  Eigen::MatrixXd factor_;  ///< p x p: factor factor' is the covariance of the errors over their D
  double exact_p_ = 1.0;    ///< p-value of a model without errors
  std::vector<Slope> slopes_, corrected_;  ///< of each error; of each channel that is corrected
};

/// The model of all CVs with its errors, as the benchmark of a loop shows them. The clock of the record may
/// be another one than that of the model: models are tried whose outputs are half a sample or a sample early
/// or late, the same for all CVs, and the most probable one is corrected. No model is early, since dead times
/// end at 0: of CVs that are early by up to m samples, row k is compared with the model m samples later, and
/// the model is late by the rest.
class LearntModel final : public ModelCorrection {
 public:
  /// Priors of relative_errors(). Throws InputError as ModelErrors.
  LearntModel(const Study& study, const Eigen::Ref<const Eigen::VectorXd>& initial_u,
              const AssessedLoop& benchmark, double share, double bias);

  const ModelErrors& of(Eigen::Index cv) const { return cvs_[static_cast<std::size_t>(cv)]; }
  /// By how much the outputs of the record are late, in the time unit of the plant; below 0: early.
  double late() const { return late_; }
  /// errors_in_window() with the rows of the CV at the samples of the model.
  Eigen::RowVectorXd errors(const AssessedLoop& loop, Eigen::Index cv) const;
  /// errors() of the CV in the record less their correction, and below them what is still unknown of the
  /// model but for what wanders, (1 + q) x N in CV units: row 0 is Z' z and noise, z ~ N(0, I).
  Eigen::MatrixXd series(const AssessedLoop& loop, Eigen::Index cv) const;
  /// The first CV whose benchmark rejects an exact model, which one of another clock does; none if no
  /// benchmark does.
  std::optional<Eigen::Index> rejects_exact_model() const;
  /// The same from the samples of the benchmark for whose position `uses` is true; none if they are too few.
  std::optional<ModelErrors> of_part(const Study& study, const AssessedLoop& benchmark, Eigen::Index cv,
                                     const std::function<bool(Eigen::Index)>& uses) const;
  /// The plant without a fault, as far as the benchmark shows it: ModelErrors::plant() of all CVs, without
  /// washouts. Its outputs are of the time of the inputs; rows of the record are later by late().
  TransferMatrix plant() const;
  /// By the mean of the errors, and by the most probable rest given the loop.
  std::shared_ptr<const AssessedLoop> corrected(const AssessedLoop& loop) const override;

 private:
  Eigen::MatrixXd explained(const AssessedLoop& loop) const;

  static constexpr double kSpeaksForLate = 6.0;  ///< gain of log L

  std::vector<ModelErrors> errors_of(const Study& study, const AssessedLoop& benchmark, Eigen::Index early,
                                     double late) const;

  double share_, bias_, late_ = 0.0;
  Eigen::Index early_ = 0;  ///< m
  Eigen::VectorXd initial_;
  std::vector<ModelErrors> cvs_;
};

/// y - y_sim of a CV over the whole record, NaN outside of the window, where a sample is an outlier, and
/// where y stands as if a bad value were kept (without_standstills()). Rows of y that are `early` by some
/// samples are shifted back.
Eigen::RowVectorXd errors_in_window(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index early = 0);

/// The deviation below which the simulation errors of a CV are rounding of its outputs.
double least_noise(const Eigen::Ref<const Eigen::RowVectorXd>& y_sim);

}  // namespace mpm
