#include "analysis/sensitivity/loop_stability.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/loop/world.hpp"
#include "solvers/mpc_qp.hpp"

namespace mpm {
namespace {

/// Largest number of past inputs in the state of a loop. Beyond it nobody would wait for the eigenvalues,
/// which cost ten times the cube of the size.
constexpr Eigen::Index kMostStates = 1000;

using Indices = std::vector<Eigen::Index>;

Eigen::Index count_of(const Indices& indices) {
  return static_cast<Eigen::Index>(indices.size());
}

/// A channel from MV `mvs[col]` to CV `cvs[row]`, both of the loop.
struct DelayedChannel {
  Eigen::Index row, col;
  DiscreteChannel model;
};

/// Returns the channels of G that belong to the loop and are not zero.
std::vector<DelayedChannel> channels_of(const TransferMatrix& G, double sample_time, const Indices& cvs,
                                        const Indices& mvs) {
  std::vector<DelayedChannel> channels;
  for (Eigen::Index row = 0; row < count_of(cvs); ++row)
    for (Eigen::Index col = 0; col < count_of(mvs); ++col) {
      const TransferFunction& channel =
          G(cvs[static_cast<std::size_t>(row)], mvs[static_cast<std::size_t>(col)]);
      if (!channel.is_zero())
        channels.push_back({row, col, discretise(channel, sample_time)});
    }
  return channels;
}

/// Returns the number of past samples of the inputs on which the channels depend.
Eigen::Index memory_of(const std::vector<DelayedChannel>& channels) {
  Eigen::Index memory = 1;
  for (const DelayedChannel& channel : channels)
    memory = std::max<Eigen::Index>(memory, channel.model.delay + 1);
  return memory;
}

/// Channels side by side in one state space. Past inputs are h = (u(k-1), u(k-2), ...), with nu numbers each:
///
///     x(k+1) = A x(k) + B u(k) + B_past h(k),   y(k) = C x(k) + D_past h(k)
struct Realisation {
  Eigen::MatrixXd A, B, B_past, C, D_past;

  Realisation(const std::vector<DelayedChannel>& channels, Eigen::Index ny, Eigen::Index nu,
              Eigen::Index memory) {
    Eigen::Index n = 0;
    for (const DelayedChannel& channel : channels)
      n += channel.model.A.rows();
    A.setZero(n, n);
    B.setZero(n, nu);
    B_past.setZero(n, nu * memory);
    C.setZero(ny, n);
    D_past.setZero(ny, nu * memory);
    Eigen::Index at = 0;
    for (const auto& [row, col, model] : channels) {
      const Eigen::Index order = model.A.rows();
      A.block(at, at, order, order) = model.A;
      if (model.delay == 0)
        B.col(col).segment(at, order) = model.b_now;
      else
        B_past.col((model.delay - 1) * nu + col).segment(at, order) = model.b_now;
      B_past.col(model.delay * nu + col).segment(at, order) += model.b_previous;
      C.row(row).segment(at, order) = model.c;
      D_past(row, model.delay * nu + col) += model.d;
      at += order;
    }
  }
};

/// Returns the matrix that moves the past inputs on by one sample, without the new input.
Eigen::MatrixXd shift_of(Eigen::Index nu, Eigen::Index memory) {
  Eigen::MatrixXd shift = Eigen::MatrixXd::Zero(nu * memory, nu * memory);
  shift.bottomLeftCorner(nu * (memory - 1), nu * (memory - 1)).setIdentity();
  return shift;
}

/// Returns the matrix from (x, h) at sample k to y(k+1), ..., y(k+Hp) of the model with the MVs held at
/// u(k-1). Output a at step l is in row a Hp + l - 1.
Eigen::MatrixXd free_response_of(const Realisation& model, Eigen::Index nu, Eigen::Index memory,
                                 Eigen::Index horizon) {
  const Eigen::Index n = model.A.rows(), ny = model.C.rows();
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(n + nu * memory, n + nu * memory);
  held << model.A, model.B_past, Eigen::MatrixXd::Zero(nu * memory, n), shift_of(nu, memory);
  held.block(0, n, n, nu) += model.B;
  held.block(n, n, nu, nu).setIdentity();
  Eigen::MatrixXd output(ny, n + nu * memory);
  output << model.C, model.D_past;
  Eigen::MatrixXd response(ny * horizon, output.cols());
  for (Eigen::Index l = 0; l < horizon; ++l) {
    output *= held;
    for (Eigen::Index a = 0; a < ny; ++a)
      response.row(a * horizon + l) = output.row(a);
  }
  return response;
}

/// Returns a controller without limits. For a CV at a limit, the limit becomes a setpoint, with the weight of
/// the slack if `over_limits`, else with weight 0.
MpcOptions linear_options(const Study& study, const OperatingPoint& point, bool over_limits) {
  MpcOptions options = study.controller;
  options.mv_hard = Limits::none(study.mv_count());
  options.cv_hard = options.cv_soft = Limits::none(study.cv_count());
  for (const ActiveConstraint& reference : point.active) {
    if (reference.kind == ConstraintKind::setpoint)
      continue;
    const double weight = over_limits ? options.slack_weight(reference.cv) : 0.0;
    options.setpoint_weight(reference.cv) =
        options.weight_convention == WeightConvention::squared ? std::sqrt(weight) : weight;
  }
  return options;
}

/// The first moves of the free MVs, per unit of the free response and of the target.
struct FirstMoves {
  Eigen::MatrixXd of_free;    ///< per unit of the free response, nu x (m Hp); column a Hp + l - 1
  Eigen::MatrixXd of_target;  ///< per unit of u_target - u(k-1), nu x nu
};

/// Returns the problem of the controller with these options; none if they do not determine its moves.
std::optional<MpcQp> linear_problem(const TransferMatrix& model, const MpcOptions& options) {
  try {
    return MpcQp(model, options.mv_cost.size(), options);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

FirstMoves first_moves(const Study& study, MpcQp& qp, const Indices& cvs, const Indices& mvs) {
  const Eigen::Index all = study.mv_count(), nu = count_of(mvs), hp = study.controller.prediction_horizon;
  Indices places;  // places of the free MVs in the planned positions
  for (Eigen::Index i = 0; i < study.controller.control_horizon; ++i)
    for (const Eigen::Index mv : mvs)
      places.push_back(i * all + mv);
  const Eigen::LLT<Eigen::MatrixXd> hessian(qp.structure()->hessian(places, places));
  Eigen::MatrixXd free = Eigen::MatrixXd::Zero(study.cv_count(), hp);
  Eigen::VectorXd target = Eigen::VectorXd::Zero(all);
  const Eigen::VectorXd previous = Eigen::VectorXd::Zero(all), setpoint = Eigen::VectorXd::Zero(free.rows());
  const auto moves = [&]() -> Eigen::VectorXd {
    const Eigen::VectorXd gradient = qp.update({free, previous, target, setpoint, setpoint}).gradient(places);
    return -hessian.solve(gradient).head(nu);
  };
  FirstMoves result{Eigen::MatrixXd(nu, count_of(cvs) * hp), Eigen::MatrixXd(nu, nu)};
  for (Eigen::Index a = 0; a < count_of(cvs); ++a)
    for (Eigen::Index l = 0; l < hp; ++l) {
      double& one = free(cvs[static_cast<std::size_t>(a)], l);
      one = 1.0;
      result.of_free.col(a * hp + l) = moves();
      one = 0.0;
    }
  for (Eigen::Index j = 0; j < nu; ++j) {
    double& one = target(mvs[static_cast<std::size_t>(j)]);
    one = 1.0;
    result.of_target.col(j) = moves();
    one = 0.0;
  }
  return result;
}

/// Returns the matrix from the bias to the targets, -K_active^-1; 0 if there are no targets. None if the
/// active CVs do not determine the targets.
std::optional<Eigen::MatrixXd> target_of_bias(const TransferMatrix& model, const MpcOptions& options,
                                              const Indices& cvs, const Indices& mvs) {
  if (!options.has_targets())
    return Eigen::MatrixXd::Zero(count_of(mvs), count_of(cvs));
  const Eigen::MatrixXd K = model.static_gain()(cvs, mvs);
  if (K.rows() != K.cols() || K.rows() == 0 || !K.allFinite())
    return std::nullopt;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(K);
  if (!lu.isInvertible())
    return std::nullopt;
  return -lu.inverse();
}

double spectral_radius_of(const Eigen::MatrixXd& A) {
  if (!A.allFinite())
    return kNaN;
  return A.rows() == 0 ? 0.0 : A.eigenvalues().cwiseAbs().maxCoeff();
}

/// Returns whether the fault changes the loop, so that its law no longer holds.
bool changes_loop(const OtherFault& fault) {
  const FaultEffect effect = info_of(fault.kind).effect;
  return effect == FaultEffect::valve || effect == FaultEffect::hold;
}

bool has_linear_law(const Study& study, bool has_active_limits) {
  const bool one_slack = has_active_limits && study.controller.slack_form != SlackForm::per_sample;
  const MpcOptions& controller = study.controller;
  const bool other_terms = (controller.reference_time.array() > 0.0).any() ||
                           (controller.slack_cost.array() > 0.0).any() || controller.has_resting_values() ||
                           has_analysers(controller.analysers);
  return !study.nonlinear && !study.plant.G.is_integrating() && !study.controller_program && !one_slack &&
         !other_terms;
}

}  // namespace

LoopStability::LoopStability(const Study& study, const OperatingPoint& point)
    : study_(study),
      model_(study.plant.G.without_step_coefficients()),
      sample_time_(study.controller.sample_time) {
  bool has_limits = false;
  for (const ActiveConstraint& reference : point.active) {
    cvs_.push_back(reference.cv);
    has_limits = has_limits || reference.kind != ConstraintKind::setpoint;
  }
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    if (std::find(point.fixed_mvs.begin(), point.fixed_mvs.end(), mv) == point.fixed_mvs.end())
      mvs_.push_back(mv);
  if (mvs_.empty() || !has_linear_law(study, has_limits))
    return;
  const std::optional<Eigen::MatrixXd> target = target_of_bias(model_, study.controller, cvs_, mvs_);
  if (!target)
    return;

  const Eigen::Index nu = count_of(mvs_), hp = study.controller.prediction_horizon;
  const std::vector<DelayedChannel> channels = channels_of(model_, sample_time_, cvs_, mvs_);
  const Eigen::Index memory = memory_of(channels);
  if (nu * memory > kMostStates)
    return;
  const Realisation model(channels, count_of(cvs_), nu, memory);
  const Eigen::MatrixXd response = free_response_of(model, nu, memory, hp);
  // One law over the limits and one inside. Without targets there is no law inside, because nothing would act
  // there.
  for (const bool over_limits : {true, false}) {
    if (!over_limits && !(has_limits && study.controller.has_targets()))
      continue;
    std::optional<MpcQp> qp = linear_problem(model_, linear_options(study, point, over_limits));
    if (!qp) {
      laws_.clear();
      return;
    }
    const FirstMoves moves = first_moves(study, *qp, cvs_, mvs_);
    Law law{moves.of_free * response, moves.of_target * *target};
    law.of_state.middleCols(model.A.rows(), nu) += Eigen::MatrixXd::Identity(nu, nu) - moves.of_target;
    for (Eigen::Index a = 0; a < count_of(cvs_); ++a)
      law.of_bias.col(a) += moves.of_free.middleCols(a * hp, hp).rowwise().sum();
    laws_.push_back(std::move(law));
  }
}

double LoopStability::spectral_radius(const TransferMatrix& plant) const {
  if (laws_.empty())
    return kNaN;
  double radius = 0.0;
  for (const Law& law : laws_)
    radius = std::max(radius, radius_with(law, plant.without_step_coefficients()));
  return radius;
}

double LoopStability::spectral_radius(const ExperimentDraw& draw) const {
  if (!draw.parameters.empty() || (draw.other && changes_loop(*draw.other)))
    return kNaN;
  return spectral_radius(
      with_world_mismatches(world_plant(study_, draw_world(study_, draw.world)), draw.mismatches));
}

/// The state consists of the state of the model, the state of those channels of the plant that differ from
/// the model, and the past inputs. A channel without an error has the same state in plant and model, because
/// both have had the same inputs since they were at rest.
double LoopStability::radius_with(const Law& law, const TransferMatrix& plant) const {
  const Eigen::Index ny = count_of(cvs_), nu = count_of(mvs_);
  const auto differs = [&](const DelayedChannel& channel) {
    const Eigen::Index cv = cvs_[static_cast<std::size_t>(channel.row)];
    const Eigen::Index mv = mvs_[static_cast<std::size_t>(channel.col)];
    return !(model_(cv, mv) == plant(cv, mv));
  };
  const std::vector<DelayedChannel> all = channels_of(model_, sample_time_, cvs_, mvs_);
  std::vector<DelayedChannel> real = channels_of(plant, sample_time_, cvs_, mvs_), wrong = all;
  std::erase_if(real, [&](const DelayedChannel& channel) { return !differs(channel); });
  for (DelayedChannel& channel : wrong)
    if (!differs(channel)) {
      channel.model.c.setZero();
      channel.model.d = 0.0;
    }
  const Eigen::Index memory = std::max(memory_of(all), memory_of(real));
  if (nu * memory > kMostStates)
    return kNaN;
  const Realisation model(all, ny, nu, memory), simulated(wrong, ny, nu, memory), own(real, ny, nu, memory);
  const Eigen::Index nx = model.A.rows(), nr = own.A.rows(), n = nx + nr, past = nu * memory;

  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + past, n + past);
  A.block(0, 0, nx, nx) = model.A;
  A.block(nx, nx, nr, nr) = own.A;
  A.block(0, n, nx, past) = model.B_past;
  A.block(nx, n, nr, past) = own.B_past;
  A.bottomRightCorner(past, past) = shift_of(nu, memory);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(n + past, nu);
  B.topRows(n) << model.B, own.B;
  B.middleRows(n, nu).setIdentity();

  Eigen::MatrixXd bias(ny, n + past);
  bias << -simulated.C, own.C, own.D_past - simulated.D_past;
  Eigen::MatrixXd move = law.of_bias * bias;
  const Eigen::Index known = law.of_state.cols() - nx;  // number of past inputs in the law
  move.leftCols(nx) += law.of_state.leftCols(nx);
  move.middleCols(n, known) += law.of_state.rightCols(known);
  return spectral_radius_of(A + B * move);
}

}  // namespace mpm
