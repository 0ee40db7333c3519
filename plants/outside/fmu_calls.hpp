#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The functions of an instance of an FMU in this process, whatever the version of its interface. The
/// instance ends only with the process.
///
/// Errors of all members: ForeignFailure that names the function of the interface, its status and the last
/// message of the FMU.
class FmuCalls {
 public:
  using References = std::vector<fmi2::ValueReference>;  // FMI 3.0 has the same type

  FmuCalls() = default;
  FmuCalls(const FmuCalls&) = delete;
  FmuCalls& operator=(const FmuCalls&) = delete;
  virtual ~FmuCalls() = default;

  /// Enters the mode in which inputs get their first values. Parameters are set before.
  virtual void enter_initialization() = 0;
  virtual void exit_initialization() = 0;
  virtual void set(const References& references, const Eigen::VectorXd& values) = 0;
  virtual void get(const References& references, Eigen::VectorXd& values) = 0;
  /// Makes one communication step from the time `now` of the FMU on.
  virtual void advance(double now, double step) = 0;
};

/// Instantiates an FMU by FMI 2.0, or by FMI 3.0, as the kind that its description has, for an experiment
/// from 0 to `stop`.
std::unique_ptr<FmuCalls> instantiate_fmi2(const FmuPackage& package, double stop);
std::unique_ptr<FmuCalls> instantiate_fmi3(const FmuPackage& package, double stop);

}  // namespace mpm
