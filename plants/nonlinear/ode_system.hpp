#pragma once

#include <Eigen/Core>

namespace mpm {

/// An autonomous system of ordinary differential equations with inputs,
///
///   dx/dt = f(x, u),   y = g(x, u).
///
/// | symbol | meaning | shape         |
/// |--------|---------|---------------|
/// | x      | states  | state_count() |
/// | u      | inputs  | input_count() |
/// | y      | outputs | output_count()|
///
/// f must be defined and continuous for every x near the trajectory, also where an integrator's trial steps
/// leave what is physical. The caller must pass vectors of the right sizes.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;

  virtual Eigen::Index state_count() const = 0;
  virtual Eigen::Index input_count() const = 0;
  virtual Eigen::Index output_count() const = 0;

  /// dx := f(x, u).
  virtual void derivative(const Eigen::Ref<const Eigen::VectorXd>& x,
                          const Eigen::Ref<const Eigen::VectorXd>& u,
                          Eigen::Ref<Eigen::VectorXd> dx) const = 0;

  /// J := df/dx at (x, u), state_count() x state_count().
  virtual void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x,
                        const Eigen::Ref<const Eigen::VectorXd>& u, Eigen::Ref<Eigen::MatrixXd> J) const = 0;

  /// y := g(x, u), where u is the input that has acted until now.
  virtual void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                      Eigen::Ref<Eigen::VectorXd> y) const = 0;

  /// The x with f(x, u) = 0. Errors: NoSteadyState.
  virtual Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const = 0;

 protected:
  OdeSystem() = default;
  OdeSystem(const OdeSystem&) = default;
  OdeSystem& operator=(const OdeSystem&) = default;
};

}  // namespace mpm
