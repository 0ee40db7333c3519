#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The value references of the variables that a study uses, each list in the order of its numbers.
struct FmuReferences {
  std::vector<fmi2::ValueReference> inputs, outputs, parameters;
};

/// The communication steps of a sample, in the time of the FMU.
struct FmuSteps {
  double length = 1.0;
  int count = 1;  ///< in a sample

  /// As many equal ones as make each at most `longest` long; 0: one.
  static FmuSteps of_sample(double sample, double longest);
};

/// The instance of an FMU in this process. Its code is somebody else's: it may crash, and it may leave
/// behind what the next instance would find, so that a ForkedService is the place for it. There is no end to
/// it but that of the process.
///
/// Errors of all members: ForeignFailure that names the function of the interface, its status and the last
/// message of the FMU.
class FmuInstance {
 public:
  /// Instantiates the FMU and initialises it with these parameters and inputs, at time 0, for an experiment
  /// that ends after kMostSamples samples: an FMU may end where its own default experiment does if nobody
  /// tells it. Names that this program has as well, such as those of CVODE and LAPACK, are first looked for
  /// in its own library.
  FmuInstance(const FmuPackage& package, const FmuReferences& references, const Eigen::VectorXd& parameters,
              const Eigen::VectorXd& input, FmuSteps steps);
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;

  void set_parameters(const Eigen::VectorXd& parameters);
  /// Holds the input over one sample; the outputs at its end.
  Eigen::VectorXd step(const Eigen::VectorXd& input);

 private:
  static constexpr double kMostSamples = 1e6;

  static void log(fmi2::ComponentEnvironment environment, fmi2::String instance, fmi2::Status status,
                  fmi2::String category, fmi2::String message, ...);
  template <class Function>
  Function* function(const char* name) const;
  void require(fmi2::Status status, const char* function) const;
  static std::string said();
  void set(const std::vector<fmi2::ValueReference>& references, const Eigen::VectorXd& values) const;

  const FmuReferences& references_;
  void* library_ = nullptr;
  fmi2::Component component_ = nullptr;
  fmi2::CallbackFunctions callbacks_{};
  fmi2::SetReal* set_real_ = nullptr;
  fmi2::GetReal* get_real_ = nullptr;
  fmi2::DoStep* do_step_ = nullptr;
  FmuSteps step_;
  double now_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace mpm
