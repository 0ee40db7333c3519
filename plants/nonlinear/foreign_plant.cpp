#include "plants/nonlinear/foreign_plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// Place of a parameter of this name.
Eigen::Index place_of(const std::vector<NonlinearModel::Parameter>& parameters, const std::string& name) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const auto& each) { return each.name == name; });
  if (found == parameters.end())
    throw InputError("parameter of the plant", fmt::format("'{}'", name), "one that the study lists");
  return found - parameters.begin();
}

}  // namespace

ForeignPlant::ForeignPlant(const NonlinearModel& model, double sample_time,
                           const std::vector<ParameterChange>& changes, Eigen::Index onset)
    : model_(model),
      sample_time_(sample_time),
      onset_(onset),
      nominal_(static_cast<Eigen::Index>(model.parameters.size())) {
  if (!(sample_time_ > 0 && std::isfinite(sample_time_)))
    throw InputError("sample time", fmt::to_string(sample_time_), "> 0");
  model_.foreign->load();
  for (Eigen::Index i = 0; i < nominal_.size(); ++i)
    nominal_(i) = model_.parameters[static_cast<std::size_t>(i)].nominal;
  at_start_ = changed_ = nominal_;
  for (const ParameterChange& change : changes) {
    const Eigen::Index place = place_of(model_.parameters, change.name);
    changed_(place) = change.value;
    if (model_.foreign->is_tunable(static_cast<std::size_t>(place)))
      continue;
    if (onset_ > 0)
      throw InputError("onset of a change of the plant",
                       fmt::format("sample {} for '{}', which is fixed", onset_, change.name),
                       "0, or a parameter that the plant declares as tunable");
    at_start_(place) = change.value;
  }
  output_.setZero(output_count());
}

Eigen::VectorXd ForeignPlant::at_rest(ForeignSimulation& simulation, const Eigen::VectorXd& input) const {
  const ForeignOptions& options = model_.foreign->options();
  const auto samples = std::max<Eigen::Index>(static_cast<Eigen::Index>(options.settle / sample_time_), 2);
  const Eigen::Index near_end = samples - std::max<Eigen::Index>(samples / 10, 1);
  Eigen::VectorXd before, y;
  for (Eigen::Index k = 1; k <= samples; ++k) {
    y = simulation.step(input);
    if (k == near_end)
      before = y;
  }
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double move = std::abs(y(i) - before(i));
    if (!(move <= options.settle_tolerance * std::max(1.0, std::abs(y(i)))))
      throw NoSteadyState(fmt::format("output {} of the plant", i),
                          fmt::format("a move by {:.3g} in the last tenth of plant settle", move),
                          fmt::format("at most {:.3g} of max(1, |y|); settle longer, or with another "
                                      "settle_tolerance",
                                      options.settle_tolerance));
  }
  return y;
}

void ForeignPlant::settle(const Eigen::VectorXd& input) {
  const Eigen::VectorXd& operating = model_.operating_input;
  simulation_ = model_.foreign->simulation(sample_time_);
  simulation_->start(nominal_, operating);
  operating_output_ = at_rest(*simulation_, operating);
  Eigen::VectorXd y = operating_output_;
  if (at_start_ != nominal_) {
    simulation_->start(at_start_, input);
    y = at_rest(*simulation_, input);
  } else if (input != operating) {
    y = at_rest(*simulation_, input);
  }
  output_ = y - operating_output_;
}

void ForeignPlant::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  if (steady_input.size() != input_count())
    throw InputError("number of plant inputs", fmt::to_string(steady_input.size()),
                     fmt::to_string(input_count()));
  if (!steady_input.allFinite())
    throw InputError("steady plant input", "a number that is not finite", "finite numbers");
  sample_ = 0;
  try {
    settle(model_.operating_input + steady_input);
  } catch (const ForeignFailure& error) {
    const std::string file = model_.foreign->file().filename().string();
    throw NoSteadyState(file.empty() ? std::string("simulation of the plant at rest")
                                     : fmt::format("simulation of the plant ({}) at rest", file),
                        error.what(), "one that runs");
  }
}

PlantStatus ForeignPlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  if (input.size() != input_count())
    throw InputError("number of plant inputs", fmt::to_string(input.size()), fmt::to_string(input_count()));
  try {
    if (sample_ == onset_ && changed_ != at_start_)
      simulation_->change(changed_);
    output_ = simulation_->step(model_.operating_input + input) - operating_output_;
  } catch (const ForeignFailure& error) {
    failure_ = fmt::format("the simulation of the plant failed: {}", error.what());
    return PlantStatus::failed;
  }
  ++sample_;
  return PlantStatus::ok;
}

}  // namespace mpm
