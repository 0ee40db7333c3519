#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "plants/outside/fmu_calls.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The value references of the variables that a study uses, each list in the order of the values to set or
/// get.
struct FmuReferences {
  FmuCalls::References inputs, outputs, parameters;
};

/// The communication steps of a sample, in the time of the FMU.
struct FmuSteps {
  double length = 1.0;
  int count = 1;  ///< steps in a sample

  /// Returns the fewest equal steps of at most `longest` each; if `longest` is 0, one step.
  static FmuSteps of_sample(double sample, double longest);
};

/// The instance of an FMU in this process. Its code is somebody else's: it may crash, and it may leave behind
/// what the next instance would find. It therefore belongs in a ForkedService. It ends only with the
/// process.
///
/// Errors of all members: ForeignFailure that names the function of the interface, its status and the last
/// message of the FMU.
class FmuInstance {
 public:
  /// Instantiates the FMU and initialises it with these parameters and inputs, at time 0, for an experiment
  /// that ends after kMostSamples samples. An FMU that is told no end may stop at the end of its own default
  /// experiment.
  FmuInstance(const FmuPackage& package, const FmuReferences& references, const Eigen::VectorXd& parameters,
              const Eigen::VectorXd& input, FmuSteps steps);
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;

  void set_parameters(const Eigen::VectorXd& parameters);
  /// Holds the input over one sample and returns the outputs at its end.
  Eigen::VectorXd step(const Eigen::VectorXd& input);

 private:
  static constexpr double kMostSamples = 1e6;

  void set(const FmuCalls::References& references, const Eigen::VectorXd& values);

  const FmuReferences& references_;
  std::unique_ptr<FmuCalls> calls_;
  FmuSteps step_;
  double now_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace mpm
