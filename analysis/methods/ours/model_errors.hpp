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

/// One error that a channel of the model may have, normally distributed about no error.
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

/// The errors of gain, time constant and dead time that the worlds of the study draw, as normal errors with
/// the same variance; none without worlds. Further lags and the background are not included.
ModelErrorPrior drawn_errors(const Study& study, Eigen::Index cv);

/// The inputs of the model, (nu + nd) x N.
Eigen::MatrixXd model_inputs(const AssessedLoop& loop);

/// The model of one CV with the small errors that every model has, as a healthy record shows them. With delta
/// the errors, S the slopes of the output of the model by them, c a constant and n the noise, the simulation
/// error is
///
///   e = S delta + W eta + c + n,    delta ~ N(0, D^2),    eta ~ N(0, wander^2),    c ~ N(0, bias^2),
///
/// which holds in closed loop, too, because S at a sample follows from inputs before it. W are errors of
/// gains that wander along the record, as those of a nonlinear plant do: the response of each channel times a
/// polygon in time with free corners. The benchmark gives the sizes of n and eta by their marginal
/// likelihood. It gives delta a mean, by which the model is corrected, and a covariance. eta differs from
/// record to record.
class ModelErrors {
 public:
  /// `e` (N) are the simulation errors of the benchmark, NaN where there is no sample. The model was moved by
  /// `inputs` (nu + nd x N), and by `initial` (nu + nd) before them. The noise is the `known` one, or it is
  /// learnt with a deviation of `least` or more. The errors are those of a model in which the dead time of
  /// every channel is longer by `late` >= 0, in the time unit of the plant. Throws InputError for fewer than
  /// kFewestNoiseSamples samples.
  ModelErrors(const Study& study, Eigen::Index cv, const ModelErrorPrior& prior,
              const Eigen::Ref<const Eigen::RowVectorXd>& e, const Eigen::Ref<const Eigen::MatrixXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& initial, double least,
              const std::optional<BaseNoise>& known = {}, double late = 0.0);
  /// A model without errors, under this noise.
  ModelErrors(const Study& study, Eigen::Index cv, const BaseNoise& noise);

  /// 1 x (nu + nd): the model of the CV, corrected by the mean of the errors.
  const TransferMatrix& model() const { return model_; }
  /// The same without the dead time `late`: the rows of a record may be late, but the plant is not. No dead
  /// time is below 0.
  TransferMatrix plant() const;
  const BaseNoise& noise() const { return noise_.best; }
  const NoisePosterior& noises() const { return noise_; }
  /// Whether the benchmark rejects a model without errors. It does if errors wander, or if the score test
  /// rejects delta = 0: without errors b = S' R^-1 e, with the noise and the constant taken out of both, is
  /// N(0, S' R^-1 S), and b' (S' R^-1 S)^-1 b is chi squared.
  bool rejects_exact_model() const { return wanders() || exact_p_ < kRejectsExact; }
  /// Whether errors change along a healthy record, as those of a nonlinear plant do.
  bool wanders() const { return wander_ > 0.0; }
  /// Whether the benchmark shows more than a background beside the errors, so that the true errors may not be
  /// those that are searched for.
  bool are_doubtful() const { return wanders() || slow_part(noise_.best) > kMostBackground; }
  /// The number of errors, without the constant.
  Eigen::Index count() const { return mean_.size(); }
  /// The model with errors drawn from their posterior, by a `z` ~ N(0, I) of the size count().
  TransferMatrix drawn(const Eigen::Ref<const Eigen::VectorXd>& z) const;

  /// The part of the simulation error of a record that the correction of the model explains, N.
  Eigen::RowVectorXd correction(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// D S of a record and below it wander W, in CV units.
  Eigen::MatrixXd slopes(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// The same if a channel has this mismatch, from the slopes `without` it. Further rows below stay as they
  /// are.
  Eigen::MatrixXd slopes(Eigen::MatrixXd without, const Mismatch& mismatch,
                         const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  /// The directions Z of what is still unknown, q x N in standard deviations of the noise: the error of the
  /// corrected model is Z' z + n, z ~ N(0, I). Further rows of `slopes`, in CV units, are unknown as well.
  /// Directions that no record can tell from zero are left out.
  Eigen::MatrixXd directions(const Eigen::Ref<const Eigen::MatrixXd>& slopes) const;

 private:
  static constexpr double kMostBackground = 1.0;  ///< slow part of the noise over the white one
  static constexpr double kRejectsExact = 1e-4;   ///< p-value below which an exact model is rejected

  /// The response to a change of one channel. For an error the change is one standard deviation to either
  /// side.
  struct Slope {
    Eigen::Index input;
    DiscreteChannel above, below;
    double scale;  ///< of their difference

    Eigen::RowVectorXd response(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                const Eigen::Ref<const Eigen::VectorXd>& initial) const;
  };

  Slope slope_of(const TransferMatrix& model, const ChannelError& error) const;
  /// Learns the noise, and whether errors vary in time, from the residual of the mean in a healthy record,
  /// `left`. `unknown` are the rows that explain a part of it.
  void learn_noise(const Eigen::Ref<const Eigen::RowVectorXd>& left, const Eigen::MatrixXd& unknown,
                   const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                   const Eigen::Ref<const Eigen::VectorXd>& initial, double least);
  /// Rows of gains that wander: for each channel and each corner, the response of the channel times a hat
  /// about the corner.
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
/// differ from that of the model. So models are tried whose outputs are half a sample or a sample early or
/// late, the same for all CVs, and the most probable one is corrected. No model is early, since dead times
/// end at 0: if CVs are early by up to m samples, row k is compared with the model m samples later, and the
/// model is late by the rest.
class LearntModel final : public ModelCorrection {
 public:
  /// The priors are those of relative_errors(). Throws InputError like ModelErrors.
  LearntModel(const Study& study, const Eigen::Ref<const Eigen::VectorXd>& initial_u,
              const AssessedLoop& benchmark, double share, double bias);

  const ModelErrors& of(Eigen::Index cv) const { return cvs_[static_cast<std::size_t>(cv)]; }
  /// By how much the outputs of the record are late, in the time unit of the plant; below 0: early.
  double late() const { return late_; }
  /// errors_in_window() with the rows of the CV at the samples of the model.
  Eigen::RowVectorXd errors(const AssessedLoop& loop, Eigen::Index cv) const;
  /// errors() of the CV in the record less their correction, and below them the directions Z of what is still
  /// unknown about the model, without those that wander, (1 + q) x N in CV units. Row 0 is Z' z and noise,
  /// with z ~ N(0, I).
  Eigen::MatrixXd series(const AssessedLoop& loop, Eigen::Index cv) const;
  /// The first CV whose benchmark rejects an exact model; none if no benchmark does. All do if the clock of
  /// the record differs.
  std::optional<Eigen::Index> rejects_exact_model() const;
  /// The errors of the CV from those samples of the benchmark for whose position `uses` is true; none if
  /// these are too few.
  std::optional<ModelErrors> of_part(const Study& study, const AssessedLoop& benchmark, Eigen::Index cv,
                                     const std::function<bool(Eigen::Index)>& uses) const;
  /// The plant without a fault, as far as the benchmark shows it: ModelErrors::plant() of all CVs, without
  /// washouts. Its outputs have the clock of the inputs; rows of the record are later by late().
  TransferMatrix plant() const;
  /// Corrects the loop by the mean of the errors, and by the rest that is most probable given the loop.
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
/// where y stands still as if a bad value were kept (without_standstills()). Rows of y that are `early` by
/// some samples are shifted back.
Eigen::RowVectorXd errors_in_window(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index early = 0);

/// The deviation below which the simulation errors of a CV are only the rounding of its outputs.
double least_noise(const Eigen::Ref<const Eigen::RowVectorXd>& y_sim);

}  // namespace mpm
