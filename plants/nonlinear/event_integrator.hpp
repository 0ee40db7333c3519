#pragma once

#include <cstddef>
#include <memory>

namespace mpm {

/// Differential equations x' = f(t, x) between events, and what happens at these: those of an FMU for model
/// exchange (FMI 2.0, 3.2; FMI 3.0, chapter 3). The numbers are arrays of the sizes with which the integrator
/// was made.
class EventSystem {
 public:
  EventSystem() = default;
  EventSystem(const EventSystem&) = delete;
  EventSystem& operator=(const EventSystem&) = delete;

  /// From continuous time into the event mode.
  virtual void enter_event_mode() = 0;
  /// New discrete states until nothing changes any more, and into continuous time. Returns the time of the
  /// next event that is known; infinite: none.
  virtual double handle_events() = 0;
  virtual void set_time(double time) = 0;
  virtual void set_states(const double* x) = 0;
  virtual void get_states(double* x) = 0;
  virtual void get_nominals(double* x) = 0;
  virtual void get_derivatives(double* dx) = 0;
  virtual void get_indicators(double* z) = 0;
  /// After each accepted step: does it ask for the event mode?
  virtual bool completed_step() = 0;

 protected:
  ~EventSystem() = default;
};

/// Integrates them by the backward differentiation formulae of CVODE (see OdeMethod::bdf), with a Jacobian of
/// finite differences: event by event, each found as a root of the indicators, a time or a request.
///
/// Errors of all members: those of the system, and ForeignFailure where CVODE gives up, and for more states
/// or indicators than kMostStates and kMostIndicators.
class EventIntegrator {
 public:
  /// The Jacobian is dense and kept twice: 5000 states take 400 MB. The system itself reports its sizes.
  static constexpr std::size_t kMostStates = 5000, kMostIndicators = 100'000;
  /// Of a local error, relative to the state and to its nominal value.
  static constexpr double kTolerance = 1e-9;

  /// `system` must outlive it.
  EventIntegrator(EventSystem& system, std::size_t states, std::size_t indicators);
  ~EventIntegrator();
  EventIntegrator(const EventIntegrator&) = delete;
  EventIntegrator& operator=(const EventIntegrator&) = delete;

  /// In the event mode, into continuous time at `now`.
  void start(double now);
  /// From continuous time at `now`. A step before which something has jumped begins with start().
  void advance(double now, double step);

 private:
  class Implementation;

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mpm
