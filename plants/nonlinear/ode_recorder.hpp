#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/ode_integrator.hpp"
#include "plants/nonlinear/ode_system.hpp"
#include "plants/output_sampling.hpp"
#include "plants/plant.hpp"

namespace mpm {

/// A nonlinear plant as a historian samples it: output i at sample k is the value at the time (k - delay_i)
/// Ts, or the mean over the sample time that ends there. The integrator computes the means, as states q' =
/// g(x, u) beside x, so that they are as exact as x.
class OdeRecorder final : public Plant {
 public:
  /// Takes the arguments of OdePlant and is at the same states. `delay` has one number of [0, 1) for each
  /// output. Errors: InputError as OdePlant, or for delays of another number or out of range.
  OdeRecorder(const std::shared_ptr<const OdeSystem>& system, double sample_time, const OdeOptions& options,
              const std::shared_ptr<const OdeSystem>& at_rest, Eigen::Index onset, OutputSampling sampling,
              const Eigen::Ref<const Eigen::VectorXd>& delay);

  Eigen::Index output_count() const override { return output_.size(); }
  Eigen::Index input_count() const override { return system_->input_count(); }
  double sample_time() const override { return sample_time_; }
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  bool is_before_onset() const { return sample_ < onset_; }
  /// Returns the outputs at the end of a segment, or their integrals since the sample began.
  const Eigen::VectorXd& read(const OdeSystem& system, const OdeIntegrator& integrator,
                              const Eigen::Ref<const Eigen::VectorXd>& input);

  std::shared_ptr<const OdeSystem> system_, at_rest_;  ///< with integrals if means are recorded
  double sample_time_;
  Eigen::Index onset_, sample_ = 0;
  OutputSampling sampling_;
  Eigen::VectorXd delay_;      ///< samples
  std::vector<double> times_;  ///< parts of a sample at which an output is read, ascending, the last one 1
  OdeIntegrator integrator_;
  std::optional<OdeIntegrator> before_;  ///< for `at_rest`; only if the onset is after the first sample
  Eigen::VectorXd read_, output_;
  Eigen::VectorXd last_part_;  ///< integrals from the last reading of each output to the end of its sample
};

}  // namespace mpm
