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
  /// At the state zero, with the input zero. `at_rest` is the system whose steady states reset() takes, for a
  /// plant that becomes another one `onset` samples after it; none: `system`. Errors: InputError when there
  /// is no system, the two have not the same numbers of states and inputs, the sample time is not positive,
  /// the onset is negative or an option is out of range.
  OdePlant(std::shared_ptr<const OdeSystem> system, double sample_time, const OdeOptions& options = {},
           std::shared_ptr<const OdeSystem> at_rest = nullptr, Eigen::Index onset = 0);

  Eigen::Index output_count() const override { return system_->output_count(); }
  Eigen::Index input_count() const override { return system_->input_count(); }
  double sample_time() const override { return sample_time_; }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }

  /// Besides a wrong size, an input that is not finite is refused with InputError.
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

  const Eigen::VectorXd& state() const { return integrator().state(); }
  /// Goes on from the state `x`, with the output that it has under the last input (zero at first). Errors:
  /// InputError for a wrong size or a number that is not finite.
  void set_state(const Eigen::Ref<const Eigen::VectorXd>& x);

 private:
  bool is_before_onset() const { return sample_ < onset_; }
  const OdeIntegrator& integrator() const { return is_before_onset() ? *before_ : integrator_; }
  void measure();

  std::shared_ptr<const OdeSystem> system_, at_rest_;
  double sample_time_;
  Eigen::Index onset_, sample_ = 0;  ///< of reset()
  OdeIntegrator integrator_;
  std::optional<OdeIntegrator> before_;  ///< of `at_rest`; only with an onset after the first sample
  Eigen::VectorXd input_, output_;
};

}  // namespace mpm
