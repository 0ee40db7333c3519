#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/literature/high_order_arx.hpp"
#include "analysis/methods/literature/noise_model.hpp"

namespace mpm {

/// How an assessment of the model quality ended.
enum class ModelQualityStatus : std::int8_t {
  ok = 0,
  error_free = 1,  ///< the prediction errors of some CV are 0 to rounding: it has no index
};

/// Options of `model_quality`.
struct ModelQualityOptions {
  HighOrderArxOptions arx;
  /// Divides the sums of squares of e^d by n - p instead of n, with p the number of fitted coefficients.
  /// Without this correction the index of a perfect model is about sqrt(1 - p/n).
  bool correct_for_parameters = false;

  /// @throws InputError for invalid options of the ARX model
  void validate() const;
};

/// The model quality indices of one record (Sun, Qin, Singhal and Megan 2013).
///
/// | symbol        | member         | shape | equation                                             |
/// |---------------|----------------|-------|------------------------------------------------------|
/// | sum e^d_i^2   | disturbance    | ny    | sums over k = first_sample ... N-1, unit of CV squared |
/// | sum e^p_i^2   | prediction     | ny    | the same samples                                     |
/// | iMQI_i        | imqi           | ny    | sqrt(sum e^d_i^2 / sum e^p_i^2)                (4.3) |
/// | MQI           | mqi            |       | sum_i Q_i sum e^d_i^2 / sum_i Q_i sum e^p_i^2  (2.4), (4.2) |
///
/// Of (2.4) and (4.3) only the second has a root, so iMQI_i^2 is the MQI of CV i alone. NaN stands for an
/// index of errors that are 0, and for the MQI if there are no weights (a range MPC has none).
///
/// Both indices are 1 for a perfect model, and less for a model whose errors can be predicted. They can
/// exceed 1 through sampling, or if the references do not explain the loop.
struct ModelQuality {
  ModelQualityStatus status = ModelQualityStatus::ok;
  double mqi = 0.0;
  Eigen::VectorXd imqi, disturbance, prediction;
  Eigen::Index first_sample = 0;
  std::vector<Eigen::Index> orders;      ///< MO1 of each CV
  std::vector<Eigen::Index> parameters;  ///< of each CV
};

/// Compares the disturbance innovations of a closed loop, estimated from its references and outputs (2.1),
/// with the errors of its model's one-step predictions (2.2), (2.3), over the same samples.
///
/// | symbol | name   | shape  | meaning                                                 |
/// |--------|--------|--------|---------------------------------------------------------|
/// | y      | y      | ny x N | measured CVs                                            |
/// | r      | r      | nr x N | setpoints and other signals that act from outside       |
/// | G_0 u  | y_sim  | ny x N | the model's output with the plant's inputs              |
/// | Q_y    | weight | ny     | weights of the CVs in the controller, 0 or more         |
/// | G_d0   | G_d0   | ny     | disturbance models                                      |
///
/// @throws InputError for shapes that do not agree, a weight below 0 or not finite, and as
///   `identify_high_order_arx`
ModelQuality model_quality(const Eigen::Ref<const Eigen::MatrixXd>& y,
                           const Eigen::Ref<const Eigen::MatrixXd>& r,
                           const Eigen::Ref<const Eigen::MatrixXd>& y_sim,
                           const Eigen::Ref<const Eigen::VectorXd>& weight,
                           const std::vector<NoiseModel>& G_d0, const ModelQualityOptions& options = {});

}  // namespace mpm
