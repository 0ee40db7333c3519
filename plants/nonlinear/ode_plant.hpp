#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "plants/nonlinear/ode_integrator.hpp"
#include "plants/nonlinear/ode_system.hpp"
#include "plants/plant.hpp"

namespace mpm {

/// A nonlinear plant: an OdeSystem, integrated from sample to sample.
class OdePlant final : public Plant {
 public:
  /// Starts at the state zero, with the input zero. reset() takes the steady states of the system `at_rest`,
  /// which becomes `system` `onset` samples after the reset; without `at_rest` it is `system` from the start.
  /// Errors: InputError when there is no system, the two differ in their numbers of states or inputs, the
  /// sample time is not positive, the onset is negative or an option is out of range.
  OdePlant(std::shared_ptr<const OdeSystem> system, double sample_time, const OdeOptions& options = {},
           std::shared_ptr<const OdeSystem> at_rest = nullptr, Eigen::Index onset = 0);

  Eigen::Index output_count() const override { return system_->output_count(); }
  Eigen::Index input_count() const override { return system_->input_count(); }
  double sample_time() const override { return sample_time_; }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }

  /// Throws InputError for a wrong size, and for an input that is not finite.
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

  const Eigen::VectorXd& state() const { return integrator().state(); }
  /// Goes on from the state `x`, with the output that this state has under the last input (zero at first).
  /// Errors: InputError for a wrong size or a number that is not finite.
  void set_state(const Eigen::Ref<const Eigen::VectorXd>& x);

 private:
  bool is_before_onset() const { return sample_ < onset_; }
  const OdeIntegrator& integrator() const { return is_before_onset() ? *before_ : integrator_; }
  void measure();

  std::shared_ptr<const OdeSystem> system_, at_rest_;
  double sample_time_;
  Eigen::Index onset_, sample_ = 0;  ///< in samples since reset()
  OdeIntegrator integrator_;
  std::optional<OdeIntegrator> before_;  ///< for `at_rest`; only if the onset is after the first sample
  Eigen::VectorXd input_, output_;
};

}  // namespace mpm
