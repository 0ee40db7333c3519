#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "base/non_finite.hpp"
#include "base/system/forked_service.hpp"
#include "plants/outside/fmi2.hpp"
#include "plants/outside/fmu_calls.hpp"
#include "plants/outside/fmu_library.hpp"
#include "plants/outside/fmu_model_exchange.hpp"

namespace mpm {
namespace {

class Fmi2Calls : public FmuCalls {
 public:
  using Status = fmi2::Status;
  using Boolean = fmi2::Boolean;
  static constexpr const char* kGetDerivatives = "GetDerivatives";

  Fmi2Calls(const FmuPackage& package, double stop, fmi2::Type type)
      : library_(package, "fmi2", fmi2::kVersion),
        set_(library_.function<fmi2::SetReal>("SetReal")),
        get_(library_.function<fmi2::GetReal>("GetReal")) {
    library_.require_text("GetTypesPlatform", fmi2::kTypesPlatform);
    instance_ = library_.function<fmi2::Instantiate>("Instantiate")(
        "mpmbench", type, package.description().guid.c_str(), package.resources().c_str(), &callbacks_,
        fmi2::kFalse, fmi2::kTrue);
    if (instance_ == nullptr)
      throw ForeignFailure(fmt::format(
          "fmi2Instantiate gave no instance; is the GUID '{}' of modelDescription.xml that of the library?{}",
          package.description().guid, FmuLibrary::said()));
    require(library_.function<fmi2::SetupExperiment>("SetupExperiment")(instance_, fmi2::kFalse, 0.0, 0.0,
                                                                        fmi2::kTrue, stop),
            "SetupExperiment");
  }

  void enter_initialization() override {
    require(library_.function<fmi2::EnterInitializationMode>("EnterInitializationMode")(instance_),
            "EnterInitializationMode");
  }
  void exit_initialization() override {
    require(library_.function<fmi2::ExitInitializationMode>("ExitInitializationMode")(instance_),
            "ExitInitializationMode");
  }
  void set(const References& references, const Eigen::VectorXd& values) override {
    require(set_(instance_, references.data(), references.size(), values.data()), "SetReal");
  }
  void get(const References& references, Eigen::VectorXd& values) override {
    require(get_(instance_, references.data(), references.size(), values.data()), "GetReal");
  }

 protected:
  void require(fmi2::Status status, const char* function) const { library_.require(status, function, now_); }

  const FmuLibrary library_;
  fmi2::Component instance_ = nullptr;
  double now_ = 0.0;

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

  const fmi2::CallbackFunctions callbacks_{log, std::calloc, std::free, nullptr, this};
  fmi2::SetReal* const set_;
  fmi2::GetReal* const get_;
};

class Fmi2CoSimulation final : public Fmi2Calls {
 public:
  Fmi2CoSimulation(const FmuPackage& package, double stop)
      : Fmi2Calls(package, stop, fmi2::co_simulation), do_step_(library_.function<fmi2::DoStep>("DoStep")) {}

  void advance(double now, double step) override {
    now_ = now;
    require(do_step_(instance_, now, step, fmi2::kTrue), "DoStep");
    now_ = now + step;
  }

 private:
  fmi2::DoStep* const do_step_;
};

class Fmi2ModelExchange final : public ModelExchange<Fmi2Calls> {
 public:
  Fmi2ModelExchange(const FmuPackage& package, double stop)
      : ModelExchange(package, stop, fmi2::model_exchange),
        sizes_(package.description().states, package.description().indicators) {}

 private:
  std::pair<std::size_t, std::size_t> sizes() override { return sizes_; }
  double update_discrete_states() override {
    fmi2::EventInfo info{};
    do {
      info = {};
      require(library_.function<fmi2::NewDiscreteStates>("NewDiscreteStates")(instance_, &info),
              "NewDiscreteStates");
      library_.require_no_end(info.terminate != fmi2::kFalse, "NewDiscreteStates", now_);
    } while (info.again != fmi2::kFalse);
    return info.has_next_event != fmi2::kFalse ? info.next_event : kInfinity;
  }

  std::pair<std::size_t, std::size_t> sizes_;
};

}  // namespace

std::unique_ptr<FmuCalls> instantiate_fmi2(const FmuPackage& package, double stop) {
  if (package.description().kind == FmuKind::co_simulation)
    return std::make_unique<Fmi2CoSimulation>(package, stop);
  return std::make_unique<Fmi2ModelExchange>(package, stop);
}

}  // namespace mpm
