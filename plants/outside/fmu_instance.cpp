#include "plants/outside/fmu_instance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "base/system/forked_service.hpp"

namespace mpm {

FmuSteps FmuSteps::of_sample(double sample, double longest) {
  constexpr double kRounding = 1e-9;  // of a step: 0.3 is three steps of 0.1
  const double count = longest > 0.0 ? std::max(std::ceil(sample / longest - kRounding), 1.0) : 1.0;
  return {sample / count, static_cast<int>(count)};
}

FmuInstance::FmuInstance(const FmuPackage& package, const FmuReferences& references,
                         const Eigen::VectorXd& parameters, const Eigen::VectorXd& input, FmuSteps steps)
    : references_(references),
      calls_((package.description().version == FmiVersion::two ? instantiate_fmi2 : instantiate_fmi3)(
          package, kMostSamples * steps.count * steps.length)),
      step_(steps) {
  set_parameters(parameters);
  calls_->enter_initialization();
  set(references_.inputs, input);
  calls_->exit_initialization();
}

void FmuInstance::set_parameters(const Eigen::VectorXd& parameters) {
  set(references_.parameters, parameters);
}

Eigen::VectorXd FmuInstance::step(const Eigen::VectorXd& input) {
  set(references_.inputs, input);
  for (int part = 0; part < step_.count; ++part) {
    calls_->advance(now_, step_.length);
    now_ = static_cast<double>(++steps_) * step_.length;
  }
  Eigen::VectorXd y(static_cast<Eigen::Index>(references_.outputs.size()));
  calls_->get(references_.outputs, y);
  if (!y.allFinite())
    throw ForeignFailure(fmt::format("an output that is not finite at its time {}", now_));
  return y;
}

void FmuInstance::set(const FmuCalls::References& references, const Eigen::VectorXd& values) {
  if (!references.empty())
    calls_->set(references, values);
}

}  // namespace mpm
