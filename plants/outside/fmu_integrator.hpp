#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "plants/nonlinear/sundials_handles.hpp"

namespace mpm {

/// The equations of an FMU for model exchange, between events and at them (FMI 2.0, 3.2; FMI 3.0, 3.2). The
/// numbers are arrays of the sizes with which the integrator was made.
class FmuEquations {
 public:
  FmuEquations() = default;
  FmuEquations(const FmuEquations&) = delete;
  FmuEquations& operator=(const FmuEquations&) = delete;

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
  ~FmuEquations() = default;
};

/// Integrates them by the backward differentiation formulae of CVODE (see OdeMethod::bdf), with a Jacobian of
/// finite differences: event by event, each found as a root of the indicators, a time or a request.
///
/// Errors of all members: those of the equations, and ForeignFailure where CVODE gives up.
class FmuIntegrator {
 public:
  /// Of a local error, relative to the state and to its nominal value.
  static constexpr double kTolerance = 1e-9;

  FmuIntegrator(FmuEquations& equations, std::size_t states, std::size_t indicators);
  FmuIntegrator(const FmuIntegrator&) = delete;
  FmuIntegrator& operator=(const FmuIntegrator&) = delete;

  /// In the event mode, into continuous time at `now`.
  void start(double now);
  /// From continuous time at `now`. A step after which parameters or inputs have changed begins with start().
  void advance(double now, double step);

 private:
  static int derivative(realtype time, N_Vector state, N_Vector rate, void* self);
  static int indicators(realtype time, N_Vector state, realtype* values, void* self);
  /// Runs `work`; keeps what it throws, which must not pass through CVODE.
  template <class Work>
  int guarded(const Work& work);

  FmuEquations& equations_;
  std::size_t states_;
  std::vector<double> x_;  ///< at least one: without states CVODE gets one that rests
  double next_event_ = 0.0;
  std::exception_ptr thrown_;
  // In the order in which they depend on each other.
  sundials::Context context_;
  sundials::Vector vector_, tolerances_;
  sundials::Matrix matrix_;
  sundials::LinearSolver linear_solver_;
  sundials::Cvode cvode_;
};

}  // namespace mpm
