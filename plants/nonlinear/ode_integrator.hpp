#pragma once

#include <memory>

#include <Eigen/Core>

#include "plants/nonlinear/ode_system.hpp"

namespace mpm {

enum class OdeMethod {
  /// The explicit pair of orders 5 and 4 of Dormand and Prince (J. Comput. Appl. Math. 6 (1980) 19-26), by
  /// ERKStep of ARKODE (Reynolds et al., ACM Trans. Math. Softw. 49 (2023) 19). A one-step method, which
  /// begins at its full order after each jump of the input. On stiff equations its steps are as short as the
  /// fastest time constant.
  runge_kutta,
  /// Backward differentiation formulae of variable order and step with Newton's method on the analytic
  /// Jacobian, by CVODE (Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363-396). For equations of any
  /// stiffness; begins at order 1 after each jump of the input.
  bdf,
};

struct OdeOptions {
  OdeMethod method = OdeMethod::runge_kutta;
  /// Local error of a step, relative to the state.
  double relative_tolerance = 1e-9;
  /// Local error of a step of a state near zero, in the state's unit.
  double absolute_tolerance = 1e-10;
  /// Largest number of steps in one call of advance(); it fails if it needs more.
  int step_limit = 10000;

  /// Errors: InputError when a number is out of range.
  void validate() const;

  bool operator==(const OdeOptions&) const = default;
};

enum class OdeStatus {
  ok,
  step_limit,  ///< the end was not reached within the limit of steps
  failed,      ///< the error test or Newton's iteration failed again and again, or f is not finite
};

/// Integrates an OdeSystem with a method of SUNDIALS.
///
/// The input is constant within a call of advance(). No step of the method crosses the end of a call, and the
/// method begins anew when the input changes, so that no polynomial runs through a jump of the derivative.
///
/// Each integrator has a SUNDIALS context of its own: integrators of different threads are independent.
class OdeIntegrator {
 public:
  /// Errors: InputError when there is no system or an option is out of range.
  OdeIntegrator(std::shared_ptr<const OdeSystem> system, const OdeOptions& options);
  ~OdeIntegrator();
  OdeIntegrator(const OdeIntegrator&) = delete;
  OdeIntegrator& operator=(const OdeIntegrator&) = delete;

  /// Begins at the state `x` (state_count()). Errors: InputError for a wrong size or a number that is not
  /// finite.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& x);

  /// Goes on by `duration` > 0 under the constant input `u` (input_count()). If the status is not ok, the
  /// state is that of the last accepted step, and reset() is needed to go on. Errors: InputError for a wrong
  /// size, a duration that is not positive or an input that is not finite.
  OdeStatus advance(const Eigen::Ref<const Eigen::VectorXd>& u, double duration);

  /// x, state_count().
  const Eigen::VectorXd& state() const;

 private:
  class Implementation;
  class RungeKutta;
  class BackwardDifferentiation;

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace mpm
