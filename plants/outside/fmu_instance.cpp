#include "plants/outside/fmu_instance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

/// The last messages of the one FMU of this process. They are no member of an instance, because some FMUs
/// give their logger no environment.
struct FmuMessages {
  std::string any, of_trouble;
};

FmuMessages& messages() {
  static FmuMessages kept;
  return kept;
}

/// The library with its own symbols first. The sanitizers cannot have that.
void* load_library(const std::string& path) {
#ifdef __SANITIZE_ADDRESS__
  constexpr int kOwnFirst = 0;
#else
  constexpr int kOwnFirst = RTLD_DEEPBIND;
#endif
  return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | kOwnFirst);
}

}  // namespace

FmuSteps FmuSteps::of_sample(double sample, double longest) {
  constexpr double kRounding = 1e-9;  // of a step: 0.3 is three steps of 0.1
  const double count = longest > 0.0 ? std::max(std::ceil(sample / longest - kRounding), 1.0) : 1.0;
  return {sample / count, static_cast<int>(count)};
}

FmuInstance::FmuInstance(const FmuPackage& package, const FmuReferences& references,
                         const Eigen::VectorXd& parameters, const Eigen::VectorXd& input, FmuSteps steps)
    : references_(references), library_(load_library(package.library())), step_(steps) {
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
      &callbacks_, fmi2::kFalse, fmi2::kTrue);
  if (component_ == nullptr)
    throw ForeignFailure(fmt::format(
        "fmi2Instantiate gave no instance; is the GUID '{}' of modelDescription.xml that of the library?{}",
        package.description().guid, said()));
  require(function<fmi2::SetupExperiment>("SetupExperiment")(component_, fmi2::kFalse, 0.0, 0.0, fmi2::kTrue,
                                                             kMostSamples * step_.count * step_.length),
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

Eigen::VectorXd FmuInstance::step(const Eigen::VectorXd& input) {
  set(references_.inputs, input);
  for (int part = 0; part < step_.count; ++part) {
    require(do_step_(component_, now_, step_.length, 1), "DoStep");
    now_ = static_cast<double>(++steps_) * step_.length;
  }
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
    throw ForeignFailure(fmt::format("fmi2{} at its time {}: {}{}", function, now_, name_of(status), said()));
}

std::string FmuInstance::said() {
  const FmuMessages& kept = messages();
  const std::string& text = kept.of_trouble.empty() ? kept.any : kept.of_trouble;
  return text.empty() ? "" : fmt::format(" (it says: {})", text);
}

void FmuInstance::log(fmi2::ComponentEnvironment, fmi2::String, fmi2::Status status, fmi2::String,
                      fmi2::String message, ...) {
  if (message == nullptr)
    return;
  std::array<char, 512> text{};
  std::va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(text.data(), text.size(), message, arguments);
  va_end(arguments);
  (status == fmi2::ok ? messages().any : messages().of_trouble) = text.data();
}

}  // namespace mpm
