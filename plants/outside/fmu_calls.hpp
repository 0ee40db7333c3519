#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The functions of an instance of an FMU in this process, whatever the version of its interface. It ends
/// only with the process.
///
/// Errors of all members: ForeignFailure that names the function of the interface, its status and the last
/// message of the FMU.
class FmuCalls {
 public:
  using References = std::vector<fmi2::ValueReference>;  // those of FMI 3.0 are the same

  FmuCalls() = default;
  FmuCalls(const FmuCalls&) = delete;
  FmuCalls& operator=(const FmuCalls&) = delete;
  virtual ~FmuCalls() = default;

  /// Into the mode in which inputs have their first values. Parameters are set before.
  virtual void enter_initialization() = 0;
  virtual void exit_initialization() = 0;
  virtual void set(const References& references, const Eigen::VectorXd& values) = 0;
  virtual void get(const References& references, Eigen::VectorXd& values) = 0;
  /// One communication step from its time `now` on.
  virtual void advance(double now, double step) = 0;
};

/// An instance of an FMU by FMI 2.0, and by 3.0, of the kind that its description has, for an experiment from
/// 0 to `stop`.
std::unique_ptr<FmuCalls> instantiate_fmi2(const FmuPackage& package, double stop);
std::unique_ptr<FmuCalls> instantiate_fmi3(const FmuPackage& package, double stop);

}  // namespace mpm
