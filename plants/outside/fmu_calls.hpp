#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The functions of an instance of an FMU in this process, whatever the version of its interface. There is no
/// end to it but that of the process.
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

/// An instance by FMI 2.0 or 3.0, as the description has it, for an experiment from 0 to `stop`.
std::unique_ptr<FmuCalls> instantiate_fmu(const FmuPackage& package, double stop);
std::unique_ptr<FmuCalls> instantiate_fmi2(const FmuPackage& package, double stop);
std::unique_ptr<FmuCalls> instantiate_fmi3(const FmuPackage& package, double stop);

/// The library of an FMU, and what its one instance in this process says.
class FmuLibrary {
 public:
  /// Names that this program has as well, such as those of CVODE and LAPACK, are first looked for in its own
  /// library. `prefix` stands before the names of all functions. Errors: ForeignFailure for a library that
  /// cannot be loaded or has another version of the interface than `version`.
  FmuLibrary(const FmuPackage& package, std::string prefix, std::string_view version);

  template <class Function>
  Function* function(const std::string& name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }
  /// Throws ForeignFailure unless the status is `ok` or `warning`; both versions number them alike.
  void require(int status, const std::string& function, double now) const;
  /// Throws ForeignFailure where the FMU asks to end.
  void require_no_end(bool asks, const std::string& function, double now) const;
  /// " (it says: ...)", its last message of trouble; empty: none.
  static std::string said();
  static void keep(int status, const char* message);

 private:
  void* symbol(const std::string& name) const;

  std::string prefix_;
  void* library_;
};

}  // namespace mpm
