#include "plants/nonlinear/ode_plant.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

OdePlant::OdePlant(std::shared_ptr<const OdeSystem> system, double sample_time, const OdeOptions& options,
                   std::shared_ptr<const OdeSystem> at_rest, Eigen::Index onset)
    : system_(std::move(system)),
      at_rest_(at_rest ? std::move(at_rest) : system_),
      sample_time_(sample_time),
      onset_(onset),
      integrator_(system_, options) {
  if (at_rest_->state_count() != system_->state_count() || at_rest_->input_count() != system_->input_count())
    throw InputError("system at rest",
                     fmt::format("{} states and {} inputs", at_rest_->state_count(), at_rest_->input_count()),
                     fmt::format("{} and {}, as the plant", system_->state_count(), system_->input_count()));
  if (!(sample_time_ > 0 && std::isfinite(sample_time_)))
    throw InputError("sample time", fmt::to_string(sample_time_), "> 0");
  if (onset_ < 0)
    throw InputError("onset of a change of the plant", fmt::to_string(onset_), "0 samples or more");
  if (onset_ > 0)
    before_.emplace(at_rest_, options);
  input_.setZero(system_->input_count());
  output_.setZero(system_->output_count());
  set_state(Eigen::VectorXd::Zero(system_->state_count()));
}

void OdePlant::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  if (steady_input.size() != input_count())
    throw InputError("number of plant inputs", fmt::format("{}", steady_input.size()),
                     fmt::format("{}", input_count()));
  if (!steady_input.allFinite())
    throw InputError("steady plant input", "a number that is not finite", "finite numbers");
  input_ = steady_input;
  sample_ = 0;
  const Eigen::VectorXd x = at_rest_->steady_state(input_);
  if (!x.allFinite())
    throw NoSteadyState("steady state of the plant", "a number that is not finite", "finite numbers");
  set_state(x);
}

PlantStatus OdePlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  OdeIntegrator& now = is_before_onset() ? *before_ : integrator_;
  const OdeStatus status = now.advance(input, sample_time_);
  input_ = input;
  ++sample_;
  if (before_ && sample_ == onset_)
    integrator_.reset(before_->state());
  measure();
  return status == OdeStatus::ok ? PlantStatus::ok : PlantStatus::failed;
}

void OdePlant::set_state(const Eigen::Ref<const Eigen::VectorXd>& x) {
  (is_before_onset() ? *before_ : integrator_).reset(x);
  measure();
}

void OdePlant::measure() {
  (is_before_onset() ? *at_rest_ : *system_).output(integrator().state(), input_, output_);
}

}  // namespace mpm
