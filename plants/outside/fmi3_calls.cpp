#include <cstddef>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "plants/outside/fmi3.hpp"
#include "plants/outside/fmu_calls.hpp"
#include "plants/system/forked_service.hpp"

namespace mpm {
namespace {

/// Without the event mode, in which an FMU handles its events within its steps, and without early returns.
class Fmi3Calls : public FmuCalls {
 public:
  Fmi3Calls(const FmuPackage& package, double stop)
      : library_(package, "fmi3", fmi3::kVersion),
        set_(library_.function<fmi3::SetFloat64>("SetFloat64")),
        get_(library_.function<fmi3::GetFloat64>("GetFloat64")),
        do_step_(library_.function<fmi3::DoStep>("DoStep")),
        stop_(stop) {
    instance_ = library_.function<fmi3::InstantiateCoSimulation>("InstantiateCoSimulation")(
        "mpmbench", package.description().guid.c_str(), package.resources().c_str(), false, true, false,
        false, nullptr, 0, this, log, nullptr);
    if (instance_ == nullptr)
      throw ForeignFailure(
          fmt::format("fmi3InstantiateCoSimulation gave no instance; is the instantiation token '{}' of "
                      "modelDescription.xml that of the library?{}",
                      package.description().guid, FmuLibrary::said()));
  }

  void enter_initialization() override {
    require(library_.function<fmi3::EnterInitializationMode>("EnterInitializationMode")(instance_, false, 0.0,
                                                                                        0.0, true, stop_),
            "EnterInitializationMode");
  }
  void exit_initialization() override {
    require(library_.function<fmi3::ExitInitializationMode>("ExitInitializationMode")(instance_),
            "ExitInitializationMode");
  }
  void set(const References& references, const Eigen::VectorXd& values) override {
    require(set_(instance_, references.data(), references.size(), values.data(), references.size()),
            "SetFloat64");
  }
  void get(const References& references, Eigen::VectorXd& values) override {
    require(get_(instance_, references.data(), references.size(), values.data(), references.size()),
            "GetFloat64");
  }
  void advance(double now, double step) override {
    bool events = false, terminate = false, early = false;
    double reached = now;
    now_ = now;
    require(do_step_(instance_, now, step, true, &events, &terminate, &early, &reached), "DoStep");
    if (terminate)
      throw ForeignFailure(
          fmt::format("fmi3DoStep at its time {}: it asks to end{}", now, FmuLibrary::said()));
    if (early)
      throw ForeignFailure(fmt::format(
          "fmi3DoStep at its time {}: it returned early, at {}, which was not allowed", now, reached));
    now_ = now + step;
  }

 private:
  static void log(fmi3::InstanceEnvironment, fmi3::Status status, fmi3::String, fmi3::String message) {
    constexpr std::size_t kMost = 512;
    if (message != nullptr)
      FmuLibrary::keep(status, std::string(message, ::strnlen(message, kMost)).c_str());
  }

  void require(fmi3::Status status, const char* function) const { library_.require(status, function, now_); }

  const FmuLibrary library_;
  fmi3::SetFloat64* const set_;
  fmi3::GetFloat64* const get_;
  fmi3::DoStep* const do_step_;
  const double stop_;
  fmi3::Instance instance_ = nullptr;
  double now_ = 0.0;
};

}  // namespace

std::unique_ptr<FmuCalls> instantiate_fmi3(const FmuPackage& package, double stop) {
  return std::make_unique<Fmi3Calls>(package, stop);
}

}  // namespace mpm
