#pragma once

#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

#include <Eigen/Core>

#include "plants/nonlinear/event_integrator.hpp"
#include "plants/outside/fmu_calls.hpp"

namespace mpm {

/// An FMU for model exchange, in either version of the interface. `Calls` provides instance_, library_, the
/// time now_, require(), the types Status and Boolean, and the name kGetDerivatives. Inputs and parameters
/// are set in the event mode, since they jump.
template <class Calls>
class ModelExchange : public Calls, protected EventSystem {
 public:
  using Calls::Calls;

  void exit_initialization() override {
    Calls::exit_initialization();
    std::tie(states_, indicators_) = sizes();
    integrator_.emplace(static_cast<EventSystem&>(*this), states_, indicators_);
    integrator_->start(this->now_);
    is_continuous_ = true;
  }
  void set(const FmuCalls::References& references, const Eigen::VectorXd& values) override {
    if (is_continuous_)
      enter_event_mode();
    is_continuous_ = false;
    Calls::set(references, values);
  }
  void advance(double now, double step) override {
    if (!is_continuous_)
      integrator_->start(now);
    is_continuous_ = true;
    integrator_->advance(now, step);
  }

 protected:
  /// Returns the numbers of states and of event indicators.
  virtual std::pair<std::size_t, std::size_t> sizes() = 0;
  /// Updates the discrete states until nothing changes any more. Returns the time of the next event;
  /// infinite: none.
  virtual double update_discrete_states() = 0;

 private:
  using Status = typename Calls::Status;
  using Boolean = typename Calls::Boolean;

  /// Calls the function of this name with the instance and these arguments.
  template <class... Arguments>
  void call(const char* name, Arguments... arguments) {
    this->require(
        this->library_.template function<Status(void*, Arguments...)>(name)(this->instance_, arguments...),
        name);
  }

  void enter_event_mode() override { call("EnterEventMode"); }
  double handle_events() override {
    const double next = update_discrete_states();
    call("EnterContinuousTimeMode");
    return next;
  }
  void set_time(double time) override {
    this->now_ = time;
    call("SetTime", time);
  }
  void set_states(const double* x) override { call("SetContinuousStates", x, states_); }
  void get_states(double* x) override { call("GetContinuousStates", x, states_); }
  void get_nominals(double* x) override { call("GetNominalsOfContinuousStates", x, states_); }
  void get_derivatives(double* dx) override { call(Calls::kGetDerivatives, dx, states_); }
  void get_indicators(double* z) override { call("GetEventIndicators", z, indicators_); }
  bool completed_step() override {
    Boolean enter = false, terminate = false;
    call("CompletedIntegratorStep", static_cast<Boolean>(true), &enter, &terminate);
    this->library_.require_no_end(terminate != static_cast<Boolean>(false), "CompletedIntegratorStep",
                                  this->now_);
    return enter != static_cast<Boolean>(false);
  }

  std::size_t states_ = 0, indicators_ = 0;
  std::optional<EventIntegrator> integrator_;  ///< made once the sizes are known
  bool is_continuous_ = false;
};

}  // namespace mpm
