#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/non_finite.hpp"
#include "base/system/forked_service.hpp"
#include "plants/outside/fmi3.hpp"
#include "plants/outside/fmu_calls.hpp"
#include "plants/outside/fmu_library.hpp"
#include "plants/outside/fmu_model_exchange.hpp"

namespace mpm {
namespace {

class Fmi3Calls : public FmuCalls {
 public:
  using Status = fmi3::Status;
  using Boolean = fmi3::Boolean;
  static constexpr const char* kGetDerivatives = "GetContinuousStateDerivatives";

  Fmi3Calls(const FmuPackage& package, double stop)
      : library_(package, "fmi3", fmi3::kVersion),
        set_(library_.function<fmi3::SetFloat64>("SetFloat64")),
        get_(library_.function<fmi3::GetFloat64>("GetFloat64")),
        stop_(stop) {}

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

 protected:
  void take_instance(fmi3::Instance instance, const FmuPackage& package, const char* function) {
    if (instance == nullptr)
      throw ForeignFailure(
          fmt::format("fmi3{} gave no instance; is the instantiation token '{}' of modelDescription.xml that "
                      "of the library?{}",
                      function, package.description().guid, FmuLibrary::said()));
    instance_ = instance;
  }
  void require(fmi3::Status status, const char* function) const { library_.require(status, function, now_); }
  static void log(fmi3::InstanceEnvironment, fmi3::Status status, fmi3::String, fmi3::String message) {
    constexpr std::size_t kMost = 512;
    if (message != nullptr)
      FmuLibrary::keep(status, std::string(message, ::strnlen(message, kMost)).c_str());
  }

  const FmuLibrary library_;
  fmi3::Instance instance_ = nullptr;
  double now_ = 0.0;

 private:
  fmi3::SetFloat64* const set_;
  fmi3::GetFloat64* const get_;
  const double stop_;
};

/// Uses neither the event mode, so that the FMU handles its events within its steps, nor early returns.
class Fmi3CoSimulation final : public Fmi3Calls {
 public:
  Fmi3CoSimulation(const FmuPackage& package, double stop)
      : Fmi3Calls(package, stop), do_step_(library_.function<fmi3::DoStep>("DoStep")) {
    take_instance(library_.function<fmi3::InstantiateCoSimulation>("InstantiateCoSimulation")(
                      "mpmbench", package.description().guid.c_str(), package.resources().c_str(), false,
                      true, false, false, nullptr, 0, this, log, nullptr),
                  package, "InstantiateCoSimulation");
  }

  void advance(double now, double step) override {
    bool events = false, terminate = false, early = false;
    double reached = now;
    now_ = now;
    require(do_step_(instance_, now, step, true, &events, &terminate, &early, &reached), "DoStep");
    library_.require_no_end(terminate, "DoStep", now);
    if (early)
      throw ForeignFailure(fmt::format(
          "fmi3DoStep at its time {}: it returned early, at {}, which was not allowed", now, reached));
    now_ = now + step;
  }

 private:
  fmi3::DoStep* const do_step_;
};

class Fmi3ModelExchange final : public ModelExchange<Fmi3Calls> {
 public:
  Fmi3ModelExchange(const FmuPackage& package, double stop) : ModelExchange(package, stop) {
    take_instance(library_.function<fmi3::InstantiateModelExchange>("InstantiateModelExchange")(
                      "mpmbench", package.description().guid.c_str(), package.resources().c_str(), false,
                      true, this, log),
                  package, "InstantiateModelExchange");
  }

 private:
  std::pair<std::size_t, std::size_t> sizes() override {
    const auto number = [this](const char* function) {
      std::size_t count = 0;
      require(library_.function<fmi3::GetNumber>(function)(instance_, &count), function);
      return count;
    };
    return {number("GetNumberOfContinuousStates"), number("GetNumberOfEventIndicators")};
  }
  double update_discrete_states() override {
    bool again = false, terminate = false, nominals = false, states = false, has_next = false;
    double next = 0.0;
    do {
      require(library_.function<fmi3::UpdateDiscreteStates>("UpdateDiscreteStates")(
                  instance_, &again, &terminate, &nominals, &states, &has_next, &next),
              "UpdateDiscreteStates");
      library_.require_no_end(terminate, "UpdateDiscreteStates", now_);
    } while (again);
    return has_next ? next : kInfinity;
  }
};

}  // namespace

std::unique_ptr<FmuCalls> instantiate_fmi3(const FmuPackage& package, double stop) {
  if (package.description().kind == FmuKind::co_simulation)
    return std::make_unique<Fmi3CoSimulation>(package, stop);
  return std::make_unique<Fmi3ModelExchange>(package, stop);
}

}  // namespace mpm
