#include "solvers/mpc.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/prediction.hpp"

namespace mpm {
namespace {

const MpcOptions& checked(const MpcOptions& options, const TransferMatrix& model, Eigen::Index mv_count) {
  if (mv_count < 1 || mv_count > model.cols())
    throw InputError("mv_count", fmt::format("{}", mv_count),
                     fmt::format("1 to {} (model columns)", model.cols()));
  options.validate(model.rows(), mv_count, model.cols() - mv_count);
  return options;
}

void require_signal(const char* name, const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index size) {
  if (signal.size() != size)
    throw InputError(name, fmt::format("{} numbers", signal.size()), fmt::format("{}", size));
  if (!signal.allFinite())
    throw InputError(name, "a number that is not finite", "finite numbers");
}

ControlStatus control_status(QpStatus status) {
  return status == QpStatus::solved       ? ControlStatus::ok
         : status == QpStatus::infeasible ? ControlStatus::infeasible
                                          : ControlStatus::failed;
}

}  // namespace

std::string_view to_string(ControlStatus status) {
  switch (status) {
    case ControlStatus::ok:
      return "ok";
    case ControlStatus::infeasible:
      return "infeasible";
    case ControlStatus::failed:
      return "failed";
  }
  return "unknown";
}

Mpc::Mpc(const TransferMatrix& model, Eigen::Index mv_count, const MpcOptions& options,
         const QpSolverFactory& factory)
    : G_(model),
      options_(checked(options, model, mv_count)),
      factory_(with_time_limit(factory, options.solver_time_limit)),
      nu_(mv_count),
      model_(model, options.sample_time),
      scratch_(model_),
      simulated_analysers_(options.analysers),
      setpoint_(Eigen::VectorXd::Zero(model.rows())),
      cv_soft_(options.cv_soft),
      off_(SwitchedOff::none(model.rows(), mv_count)) {
  program_ = &program_without(off_);
  Eigen::MatrixXd gain = model.steady_gain();
  for (Eigen::Index cv = 0; cv < model.rows(); ++cv)
    if (model.is_integrating(cv)) {
      integrating_.push_back(cv);
      gain.row(cv) *= options.prediction_horizon * options.sample_time;
    }
  md_gain_ = gain.rightCols(model.cols() - mv_count);
  if (has_analysers(options.md_analysers))
    late_.emplace(model_, nu_, options.md_analysers);
  if (options.has_targets()) {
    targets_.emplace(gain.leftCols(mv_count), options, factory_);
    pass_on_targets();
  }
  input_.setZero(model.cols());
  for (Eigen::VectorXd* of_cv : {&bias_, &ramp_, &ramp_share_, &y_model_})
    of_cv->setZero(model.rows());
  for (const Eigen::Index cv : integrating_)
    if (options.has_bias_ramps())
      ramp_share_(cv) = options.bias_ramp(cv);
  measured_.setZero(model.rows());
  y_at_zero_.setZero(model.rows());
  free_.setZero(model.rows(), options.prediction_horizon);
  move_.u.setZero(nu_);
  move_.u_target.setZero(nu_);
}

void Mpc::reset(const Eigen::Ref<const Eigen::VectorXd>& u, const Eigen::Ref<const Eigen::VectorXd>& d) {
  require_signal("MVs", u, nu_);
  require_signal("measured disturbances", d, md_gain_.cols());
  input_ << u, d;
  model_.reset(input_);
  if (late_)
    late_->reset(model_, input_);
  simulated_analysers_.reset(model_.output());
  is_pending_ = false;
  has_bias_ = false;
  ramp_.setZero();
  if (targets_)
    targets_->reset();
  program_->solver->reset();
  move_.status = ControlStatus::ok;
  move_.u = u;
  move_.u_target = u;
  off_.hold(move_.u);
}

void Mpc::set_cv_soft(const Limits& limits) {
  limits.validate("cv_soft", model_.output_count());
  cv_soft_ = limits;
  pass_on_limits();
}

void Mpc::set_setpoints(const Eigen::Ref<const Eigen::VectorXd>& y_set) {
  require_signal("setpoints", y_set, setpoint_.size());
  setpoint_ = y_set;
  pass_on_targets();
}

void Mpc::set_off(const SwitchedOff& off) {
  off.validate(model_.output_count(), nu_);
  Program& program = program_without(off);
  if (&program != program_)
    program.solver->reset();
  program_ = &program;
  off_ = off;
  off_.hold(move_.u);
  std::vector<Eigen::Index> held;
  for (Eigen::Index mv = 0; mv < nu_; ++mv)
    if (off_.has_mv(mv))
      held.push_back(mv);
  program_->qp.set_held(std::move(held));
  if (targets_)
    targets_->set_held(off_.position);
  pass_on_limits();
}

Mpc::Program& Mpc::program_without(const SwitchedOff& off) {
  std::vector<bool> without(static_cast<std::size_t>(G_.rows()));
  for (Eigen::Index cv = 0; cv < G_.rows(); ++cv)
    without[static_cast<std::size_t>(cv)] = off.cvs(cv) && options_.has_setpoint(cv);
  if (const auto known = programs_.find(without); known != programs_.end())
    return known->second;
  MpcOptions options = options_;
  options.setpoint_weight = off.cvs.select(0.0, options_.setpoint_weight);
  MpcQp qp(G_, nu_, options);
  std::unique_ptr<QpSolver> solver = factory_(qp.structure());
  return programs_.emplace(std::move(without), Program{std::move(qp), std::move(solver)}).first->second;
}

void Mpc::pass_on_limits() {
  program_->qp.set_cv_limits(off_.opened(options_.cv_hard), off_.opened(cv_soft_));
  pass_on_targets();
}

/// To the target optimizer, a setpoint is a range of width 0. The rate of a CV that integrates has the range
/// 0, and a CV that is off has no limits.
void Mpc::pass_on_targets() {
  if (!targets_)
    return;
  target_range_ = cv_soft_;
  for (Eigen::Index cv = 0; cv < setpoint_.size(); ++cv)
    if (options_.has_setpoint(cv))
      target_range_.lower(cv) = target_range_.upper(cv) = setpoint_(cv);
  for (const Eigen::Index cv : integrating_)
    target_range_.lower(cv) = target_range_.upper(cv) = 0.0;
  for (Eigen::Index cv = 0; cv < setpoint_.size(); ++cv)
    if (off_.cvs(cv)) {
      target_range_.lower(cv) = -kInfinity;
      target_range_.upper(cv) = kInfinity;
    }
  targets_->set_cv_soft(target_range_);
}

std::optional<SolvedQp> Mpc::target_problem() const {
  if (!targets_)
    return std::nullopt;
  return targets_->problem();
}

std::optional<SolvedQp> Mpc::move_problem() const {
  return SolvedQp{program_->solver->structure(), program_->qp.data(), program_->solver->result()};
}

Eigen::VectorXd Mpc::nominal_target(const Eigen::Ref<const Eigen::VectorXd>& d) {
  require_signal("measured disturbances", d, md_gain_.cols());
  if (!targets_)
    return Eigen::VectorXd::Zero(nu_);
  targets_->reset();
  return targets_->solve(md_gain_ * d).x;
}

const ControlMove& Mpc::step(const Eigen::Ref<const Eigen::VectorXd>& y,
                             const Eigen::Ref<const Eigen::VectorXd>& d) {
  require_signal("measured CVs", y, bias_.size());
  require_signal("measured disturbances", d, md_gain_.cols());
  if (is_pending_)
    model_.advance(input_);
  if (is_pending_ && late_)
    late_->advance(input_);
  // Late measurements change the bias of the sample before. This change does not count as a ramp.
  if (late_ && late_->correct(d, model_))
    for (const Eigen::Index cv : integrating_)
      bias_(cv) += y_model_(cv) - late_->output_before()(cv);
  measured_ = y;
  feed_back(y);
  input_ << move_.u, d;
  move_.status = ControlStatus::ok;
  move_.kkt_residual = 0.0;
  move_.iterations = 0;
  move_.fallbacks = 0;
  if (!targets_ || solve_targets())
    solve_moves();
  input_.head(nu_) = move_.u;
  is_pending_ = true;
  return move_;
}

void Mpc::feed_back(const Eigen::Ref<const Eigen::VectorXd>& y) {
  y_model_ = model_.output();
  simulated_analysers_.pass(y_model_);
  for (const Eigen::Index cv : integrating_)
    if (has_bias_)
      ramp_(cv) += ramp_share_(cv) * (y(cv) - y_model_(cv) - bias_(cv) - ramp_(cv));
  bias_ = y - y_model_;
  has_bias_ = true;
}

void Mpc::set_acting(const Eigen::Ref<const Eigen::VectorXd>& u) {
  require_signal("MVs", u, nu_);
  input_.head(nu_) = u;
}

std::string Mpc::failure() const {
  return reason_ == QpStatus::time_limit
             ? fmt::format("{}: Ipopt needed more than controller.solver_time_limit, {:g} s, for a problem",
                           Controller::failure(), options_.solver_time_limit)
             : Controller::failure();
}

void Mpc::note(const QpResult& answer) {
  reason_ = answer.status;
  move_.status = control_status(answer.status);
  move_.iterations += answer.iterations;
  move_.fallbacks += answer.from_ipopt ? 1 : 0;
}

bool Mpc::solve_targets() {
  y_at_zero_.noalias() = md_gain_ * input_.tail(md_gain_.cols());
  y_at_zero_ += bias_;
  for (const Eigen::Index cv : integrating_)
    y_at_zero_(cv) += static_cast<double>(free_.cols()) * ramp_(cv) - bias_(cv);
  const QpResult& target = targets_->solve(y_at_zero_);
  note(target);
  if (move_.status != ControlStatus::ok)
    return false;
  move_.kkt_residual = target.kkt_residual;
  move_.u_target = target.x;
  off_.hold(move_.u_target);
  return true;
}

void Mpc::solve_moves() {
  free_response(model_, input_, scratch_, free_);
  free_.colwise() += bias_;
  for (const Eigen::Index cv : integrating_)
    for (Eigen::Index l = 0; l < free_.cols(); ++l)
      free_(cv, l) += static_cast<double>(l + 1) * ramp_(cv);
  const QpResult& plan = program_->solver->solve(
      program_->qp.update({free_, input_.head(nu_), move_.u_target, setpoint_, measured_}));
  note(plan);
  if (move_.status != ControlStatus::ok)
    return;
  move_.kkt_residual = std::max(move_.kkt_residual, plan.kkt_residual);
  move_.u += plan.x.head(nu_);
  off_.hold(move_.u);
}

}  // namespace mpm
