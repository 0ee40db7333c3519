#pragma once

#include <cstddef>
#include <string>

#include "plants/linear/plant_model.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/nonlinear/nonlinear_model.hpp"
#include "plants/nonlinear/ode_system.hpp"
#include "plants/nonlinear/quadruple_tank_parameters.hpp"

namespace mpm {

/// The nonlinear quadruple-tank process, (2.27) to (2.30) with the external flows of (3.25), (3.26):
///
///   A_1 dh_1/dt = -q_1(h_1) + q_3(h_3) + x_1 k_1 v_1       + F_1
///   A_2 dh_2/dt = -q_2(h_2) + q_4(h_4) + x_2 k_2 v_2       + F_2
///   A_3 dh_3/dt = -q_3(h_3)            + (1 - x_2) k_2 v_2 + F_3
///   A_4 dh_4/dt = -q_4(h_4)            + (1 - x_1) k_1 v_1 + F_4,    q_i(h) = cd_i h^exp_i.
///
/// | symbol    | meaning                             | input or state | unit   |
/// |-----------|-------------------------------------|----------------|--------|
/// | h_i - D_i | states                              | x(0) ... x(3)  | cm     |
/// | v_j       | voltages of the pumps               | u(0), u(1)     | V      |
/// | x_j       | openings of the valves, 0 to 1      | u(2), u(3)     |        |
/// | F_i       | external flows, negative: taken out | u(4) ... u(7)  | cm^3/s |
/// | D_i       | disturbances added to the levels    | u(8) ... u(11) | cm     |
///
/// Outputs are the levels h_i. The thesis has F_1 (Fex1) and F_2; F_3 and F_4 are there for disturbances of
/// the upper tanks. D_i is water that comes and goes: it stands in the tank and runs out of its outlet, so
/// that a disturbance of h_4 affects h_2 as well (table 3.9); the derivatives above are those of the states.
/// Time is in seconds. Beyond the equations, these limits of real tanks hold:
///
/// - A pump does not suck and a valve does not open beyond its ends: v_j is taken as at least 0, x_j between
///   0 and 1.
/// - Nothing flows out of an empty tank. Below kShallow the laws are continued: q_i by the parabola through
///   the origin that has the value and the slope of q_i at kShallow (a power has an infinite slope at 0), and
///   a flow that is taken out by its share h / kShallow; both are 0 for h < 0. A level can then become
///   negative only by the error of the integration or by D_i; output() reports it as 0.
class QuadrupleTank final : public OdeSystem {
 public:
  static constexpr Eigen::Index kMvs = 4;    ///< v_1, v_2, x_1, x_2
  static constexpr Eigen::Index kFlows = 4;  ///< F_1 ... F_4
  static constexpr Eigen::Index kAdded = 4;  ///< D_1 ... D_4
  static constexpr double kShallow = 1e-3;   ///< cm

  /// Errors: InputError as QuadrupleTankParameters::validate().
  explicit QuadrupleTank(const QuadrupleTankParameters& parameters);

  const QuadrupleTankParameters& parameters() const { return parameters_; }

  Eigen::Index state_count() const override { return 4; }
  Eigen::Index input_count() const override { return kMvs + kFlows + kAdded; }
  Eigen::Index output_count() const override { return 4; }
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override;
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                Eigen::Ref<Eigen::MatrixXd> J) const override;
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
              Eigen::Ref<Eigen::VectorXd> y) const override;

  /// Computed in closed form, from the upper tanks down. Errors: NoSteadyState if more is taken out of a tank
  /// than flows in, or if the level of a tank from which a flow is taken out would be below kShallow.
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const override;

  /// The exact linearisation at the steady state of `u`: 4 x 12, from deviations of the inputs to deviations
  /// of the levels. From D_i to h_i it is s / (s + rate): what is added to a level runs out again. Errors: as
  /// steady_state(); InputError when a pump or a valve rests at one of its ends, or a tank is shallower than
  /// kShallow, where the equations have a kink.
  TransferMatrix linearised(const Eigen::Ref<const Eigen::VectorXd>& u) const;

 private:
  double outflow(std::size_t tank, double level) const;
  double outflow_slope(std::size_t tank, double level) const;
  Eigen::Vector4d inflow(const Eigen::Ref<const Eigen::VectorXd>& u) const;

  QuadrupleTankParameters parameters_;
};

/// The inputs of the operating point of the thesis: v1 = 3.2 V, v2 = 3.15 V, x1 = 0.43, x2 = 0.34, no
/// disturbances.
Eigen::VectorXd quadruple_tank_operating_point();

/// The linear model of P3 to P7, which is (2.31), (3.29) and (5.29) without their misprints: the
/// linearisation at the operating point, MVs v1, v2, x1, x2. With table 2.6 it reproduces all entries that
/// are printed correctly.
PlantModel quadruple_tank_table_2_6();
/// The same with the parameters of tables 3.1 and 5.9.
PlantModel quadruple_tank_table_3_1();
/// The same two with the external flows F_1 and F_2 of (3.25), (3.26) as measured disturbances (3.3.5).
PlantModel quadruple_tank_flows_table_2_6();
PlantModel quadruple_tank_flows_table_3_1();

/// The nonlinear plant with the parameter set `set`. The first `flows` external flows are MDs; the inner
/// inputs are the other flows and D1 ... D4. Errors: InputError for an unknown set.
NonlinearModel quadruple_tank_nonlinear(const std::string& set, std::size_t flows);

}  // namespace mpm
