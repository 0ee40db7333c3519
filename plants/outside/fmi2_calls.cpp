#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_calls.hpp"
#include "plants/system/forked_service.hpp"

namespace mpm {
namespace {

class Fmi2Calls : public FmuCalls {
 public:
  Fmi2Calls(const FmuPackage& package, double stop)
      : library_(package, "fmi2", fmi2::kVersion),
        set_(library_.function<fmi2::SetReal>("SetReal")),
        get_(library_.function<fmi2::GetReal>("GetReal")),
        do_step_(library_.function<fmi2::DoStep>("DoStep")) {
    if (const std::string platform = library_.function<fmi2::GetTypesPlatform>("GetTypesPlatform")();
        platform != fmi2::kTypesPlatform)
      throw ForeignFailure(
          fmt::format("its library has the types '{}', not '{}'", platform, fmi2::kTypesPlatform));
    component_ = library_.function<fmi2::Instantiate>("Instantiate")(
        "mpmbench", fmi2::co_simulation, package.description().guid.c_str(), package.resources().c_str(),
        &callbacks_, fmi2::kFalse, fmi2::kTrue);
    if (component_ == nullptr)
      throw ForeignFailure(fmt::format(
          "fmi2Instantiate gave no instance; is the GUID '{}' of modelDescription.xml that of the library?{}",
          package.description().guid, FmuLibrary::said()));
    require(library_.function<fmi2::SetupExperiment>("SetupExperiment")(component_, fmi2::kFalse, 0.0, 0.0,
                                                                        fmi2::kTrue, stop),
            "SetupExperiment");
  }

  void enter_initialization() override {
    require(library_.function<fmi2::EnterInitializationMode>("EnterInitializationMode")(component_),
            "EnterInitializationMode");
  }
  void exit_initialization() override {
    require(library_.function<fmi2::ExitInitializationMode>("ExitInitializationMode")(component_),
            "ExitInitializationMode");
  }
  void set(const References& references, const Eigen::VectorXd& values) override {
    require(set_(component_, references.data(), references.size(), values.data()), "SetReal");
  }
  void get(const References& references, Eigen::VectorXd& values) override {
    require(get_(component_, references.data(), references.size(), values.data()), "GetReal");
  }
  void advance(double now, double step) override {
    now_ = now;
    require(do_step_(component_, now, step, fmi2::kTrue), "DoStep");
    now_ = now + step;
  }

 private:
  static void log(fmi2::ComponentEnvironment, fmi2::String, fmi2::Status status, fmi2::String,
                  fmi2::String message, ...) {
    if (message == nullptr)
      return;
    std::array<char, 512> text{};
    std::va_list arguments;
    va_start(arguments, message);
    std::vsnprintf(text.data(), text.size(), message, arguments);
    va_end(arguments);
    FmuLibrary::keep(status, text.data());
  }

  void require(fmi2::Status status, const char* function) const { library_.require(status, function, now_); }

  const FmuLibrary library_;
  const fmi2::CallbackFunctions callbacks_{log, std::calloc, std::free, nullptr, this};
  fmi2::SetReal* const set_;
  fmi2::GetReal* const get_;
  fmi2::DoStep* const do_step_;
  fmi2::Component component_ = nullptr;
  double now_ = 0.0;
};

}  // namespace

std::unique_ptr<FmuCalls> instantiate_fmi2(const FmuPackage& package, double stop) {
  return std::make_unique<Fmi2Calls>(package, stop);
}

}  // namespace mpm
