#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/nonlinear_model.hpp"
#include "plants/plant.hpp"

namespace mpm {

/// A plant that somebody else simulates (ForeignModel), in deviations from the operating point of its nominal
/// parameters, like DeviationPlant.
///
/// The plant counts as at rest if the inputs were held for ForeignOptions::settle, and no output moved by
/// more than the tolerance over the last tenth of it. A parameter that cannot change while the model runs has
/// its changed value from the start: the plant then rests at its own steady state.
class ForeignPlant final : public Plant {
 public:
  /// Errors: InputError as ForeignModel::load(), for a sample time that is not > 0, for a changed parameter
  /// that the model does not have, and for an onset > 0 if a changed parameter cannot change while the model
  /// runs.
  ForeignPlant(const NonlinearModel& model, double sample_time, const std::vector<ParameterChange>& changes,
               Eigen::Index onset);

  Eigen::Index output_count() const override { return model_.foreign->output_count(); }
  Eigen::Index input_count() const override { return model_.operating_input.size(); }
  double sample_time() const override { return sample_time_; }
  /// Throws NoSteadyState also if the simulation fails on the way.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) override;
  const Eigen::VectorXd& output() const override { return output_; }
  PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;
  std::string failure() const override { return failure_; }

 private:
  Eigen::VectorXd at_rest(ForeignSimulation& simulation, const Eigen::VectorXd& input) const;
  void settle(const Eigen::VectorXd& input);

  NonlinearModel model_;
  double sample_time_;
  Eigen::Index onset_, sample_ = 0;
  Eigen::VectorXd nominal_, at_start_, changed_;  ///< parameters; changed_ from the onset on
  std::unique_ptr<ForeignSimulation> simulation_;
  Eigen::VectorXd operating_output_, output_;
  std::string failure_;
};

}  // namespace mpm
