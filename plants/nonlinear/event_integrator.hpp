#pragma once

#include <cstddef>
#include <memory>

namespace mpm {

/// Differential equations x' = f(t, x) between events, and the handling of events, as in an FMU for model
/// exchange (FMI 2.0, 3.2; FMI 3.0, chapter 3). Arrays have the sizes with which the integrator was made.
class EventSystem {
 public:
  EventSystem() = default;
  EventSystem(const EventSystem&) = delete;
  EventSystem& operator=(const EventSystem&) = delete;

  /// Leaves continuous time for the event mode.
  virtual void enter_event_mode() = 0;
  /// Updates the discrete states until nothing changes any more, and enters continuous time. Returns the time
  /// of the next event that is known; infinite: none.
  virtual double handle_events() = 0;
  virtual void set_time(double time) = 0;
  virtual void set_states(const double* x) = 0;
  virtual void get_states(double* x) = 0;
  virtual void get_nominals(double* x) = 0;
  virtual void get_derivatives(double* dx) = 0;
  virtual void get_indicators(double* z) = 0;
  /// Called after each accepted step. Does the system ask for the event mode?
  virtual bool completed_step() = 0;

 protected:
  ~EventSystem() = default;
};

/// Integrates an EventSystem by the backward differentiation formulae of CVODE (see OdeMethod::bdf), with a
/// Jacobian of finite differences, from event to event. An event is a root of the indicators, a known time or
/// a request of the system.
///
/// Errors of all members: those of the system, and ForeignFailure if CVODE gives up or if there are more
/// states or indicators than kMostStates and kMostIndicators.
class EventIntegrator {
 public:
  /// The system itself reports its sizes, hence the limits: the Jacobian is dense and kept twice, and 5000
  /// states take 400 MB.
  static constexpr std::size_t kMostStates = 5000, kMostIndicators = 100'000;
  /// Tolerance of a local error, relative to the state and to its nominal value.
  static constexpr double kTolerance = 1e-9;

  /// `system` must outlive the integrator.
  EventIntegrator(EventSystem& system, std::size_t states, std::size_t indicators);
  ~EventIntegrator();
  EventIntegrator(const EventIntegrator&) = delete;
  EventIntegrator& operator=(const EventIntegrator&) = delete;

  /// Goes from the event mode into continuous time at `now`.
  void start(double now);
  /// Integrates over `step` from `now`, in continuous time. If something has jumped before the step, call
  /// start() first.
  void advance(double now, double step);

 private:
  class Implementation;

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mpm
