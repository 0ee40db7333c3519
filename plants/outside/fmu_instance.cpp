#include "plants/outside/fmu_instance.hpp"

#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <fmt/format.h>

#include "plants/system/forked_service.hpp"

namespace mpm {
namespace {

std::string_view name_of(fmi2::Status status) {
  switch (status) {
    case fmi2::ok:
      return "ok";
    case fmi2::warning:
      return "warning";
    case fmi2::discard:
      return "discard: the step cannot be made, or not of this length";
    case fmi2::error:
      return "error";
    case fmi2::fatal:
      return "fatal error";
    case fmi2::pending:
      return "pending, which was not allowed";
  }
  return "a status that there is not";
}

}  // namespace

FmuInstance::FmuInstance(const FmuPackage& package, const FmuReferences& references,
                         const Eigen::VectorXd& parameters, const Eigen::VectorXd& input)
    : references_(references), library_(::dlopen(package.library().c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (library_ == nullptr)
    throw ForeignFailure(fmt::format("its library cannot be loaded: {}", ::dlerror()));
  const std::string version = function<fmi2::GetVersion>("GetVersion")();
  const std::string platform = function<fmi2::GetTypesPlatform>("GetTypesPlatform")();
  if (version != fmi2::kVersion || platform != fmi2::kTypesPlatform)
    throw ForeignFailure(fmt::format("its library has FMI version '{}' and the types '{}', not '{}' and '{}'",
                                     version, platform, fmi2::kVersion, fmi2::kTypesPlatform));
  set_real_ = function<fmi2::SetReal>("SetReal");
  get_real_ = function<fmi2::GetReal>("GetReal");
  do_step_ = function<fmi2::DoStep>("DoStep");
  callbacks_ = {log, std::calloc, std::free, nullptr, this};
  component_ = function<fmi2::Instantiate>("Instantiate")(
      "mpmbench", fmi2::co_simulation, package.description().guid.c_str(), package.resources().c_str(),
      &callbacks_, fmi2::kFalse, fmi2::kFalse);
  if (component_ == nullptr)
    throw ForeignFailure(fmt::format(
        "fmi2Instantiate gave no instance; is the GUID '{}' of modelDescription.xml that of the library?{}",
        package.description().guid, said_));
  require(function<fmi2::SetupExperiment>("SetupExperiment")(component_, fmi2::kFalse, 0.0, 0.0, fmi2::kFalse,
                                                             0.0),
          "SetupExperiment");
  set_parameters(parameters);
  require(function<fmi2::EnterInitializationMode>("EnterInitializationMode")(component_),
          "EnterInitializationMode");
  set(references_.inputs, input);
  require(function<fmi2::ExitInitializationMode>("ExitInitializationMode")(component_),
          "ExitInitializationMode");
}

void FmuInstance::set_parameters(const Eigen::VectorXd& parameters) {
  set(references_.parameters, parameters);
}

Eigen::VectorXd FmuInstance::step(const Eigen::VectorXd& input, double step) {
  set(references_.inputs, input);
  require(do_step_(component_, now_, step, 1), "DoStep");
  now_ = static_cast<double>(++steps_) * step;
  Eigen::VectorXd y(static_cast<Eigen::Index>(references_.outputs.size()));
  require(get_real_(component_, references_.outputs.data(), references_.outputs.size(), y.data()), "GetReal");
  if (!y.allFinite())
    throw ForeignFailure(fmt::format("an output that is not finite at its time {}", now_));
  return y;
}

void FmuInstance::set(const std::vector<fmi2::ValueReference>& references,
                      const Eigen::VectorXd& values) const {
  if (!references.empty())
    require(set_real_(component_, references.data(), references.size(), values.data()), "SetReal");
}

template <class Function>
Function* FmuInstance::function(const char* name) const {
  const std::string full_name = fmt::format("fmi2{}", name);
  void* const found = ::dlsym(library_, full_name.c_str());
  if (found == nullptr)
    throw ForeignFailure(fmt::format("its library has no function {}", full_name));
  return reinterpret_cast<Function*>(found);
}

void FmuInstance::require(fmi2::Status status, const char* function) const {
  if (status != fmi2::ok && status != fmi2::warning)
    throw ForeignFailure(fmt::format("fmi2{} at its time {}: {}{}", function, now_, name_of(status), said_));
}

void FmuInstance::log(fmi2::ComponentEnvironment environment, fmi2::String, fmi2::Status status, fmi2::String,
                      fmi2::String message, ...) {
  if (environment == nullptr || message == nullptr || status == fmi2::ok)
    return;
  std::array<char, 512> text{};
  std::va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(text.data(), text.size(), message, arguments);
  va_end(arguments);
  static_cast<FmuInstance*>(environment)->said_ = fmt::format(" (it says: {})", text.data());
}

}  // namespace mpm
