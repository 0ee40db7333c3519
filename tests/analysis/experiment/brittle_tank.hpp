#pragma once

#include <cmath>

#include "base/non_finite.hpp"
#include "plants/nonlinear/ode_system.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace mpm::testing {

/// The tank, unless it is broken: then it rests nowhere, or its equations are not finite.
class BrittleTank final : public OdeSystem {
 public:
  BrittleTank(bool rests, bool moves)
      : tank_(quadruple_tank_parameters("table-2.6")), rests_(rests), moves_(moves) {}

  Eigen::Index state_count() const override { return tank_.state_count(); }
  Eigen::Index input_count() const override { return tank_.input_count(); }
  Eigen::Index output_count() const override { return tank_.output_count(); }
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    tank_.derivative(x, u, dx);
    if (!moves_)
      dx.setConstant(NAN);
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    tank_.jacobian(x, u, J);
  }
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
              Eigen::Ref<Eigen::VectorXd> y) const override {
    tank_.output(x, u, y);
  }
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const bool operating_point = u == quadruple_tank_operating_point();
    return rests_ || operating_point ? tank_.steady_state(u)
                                     : Eigen::VectorXd::Constant(state_count(), mpm::kInfinity);
  }

 private:
  QuadrupleTank tank_;
  bool rests_, moves_;
};

}  // namespace mpm::testing
