#include "bench/perf/daqp_rival.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/perf/short_clock.hpp"

extern "C" {
#include <api.h>
#include <utils.h>
}

namespace mpm {
namespace {

constexpr double kNoLimit = 1e30;  // DAQP's infinity

double limited(double limit) {
  return std::min(std::max(limit, -kNoLimit), kNoLimit);
}

}  // namespace

/// DAQP's variables are (x, s) with the shared slacks s. Its limits are first their bounds, then the rows; if
/// slacks are shared, each soft row gives two: a x - s <= upper and a x + s >= lower.
struct DaqpRival::Workspace {
  explicit Workspace(const QpStructure& structure);

  int rows_of(Eigen::Index row) const { return static_cast<int>(bounds + (shared ? 2 * row : row)); }
  void load(const QpData& data);
  void set_softness();

  const QpStructure& structure;
  bool shared;
  Eigen::Index bounds;
  RowMajorMatrix hessian, rows;
  Eigen::VectorXd linear, lower, upper, x, dual;
  std::vector<int> sense;
  DAQPProblem problem{};
  DAQPWorkspace workspace{};
  DAQPResult result{};
};

DaqpRival::Workspace::Workspace(const QpStructure& s)
    : structure(s),
      shared(s.slack_count() < s.row_count()),
      bounds(s.variable_count() + (shared ? s.slack_count() : 0)) {
  const Eigen::Index n = s.variable_count();
  const Eigen::Index m = s.row_count();
  hessian.setZero(bounds, bounds);
  hessian.topLeftCorner(n, n) = s.hessian;
  if (shared)
    hessian.diagonal().tail(s.slack_count()) = 2.0 * s.slack_quadratic;
  rows.setZero(shared ? 2 * m : m, bounds);
  sense.assign(static_cast<std::size_t>(bounds + rows.rows()), 0);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index first = rows_of(i) - bounds;
    rows.row(first).head(n) = s.rows.row(i);
    if (shared) {
      rows.row(first + 1).head(n) = s.rows.row(i);
      rows(first, n + s.slack_of_row(i)) = -1.0;
      rows(first + 1, n + s.slack_of_row(i)) = 1.0;
    } else {
      sense[static_cast<std::size_t>(rows_of(i))] = DAQP_SOFT;
    }
  }
  linear.setZero(bounds);
  x.setZero(bounds);
  lower.setConstant(bounds + rows.rows(), -kNoLimit);
  upper.setConstant(bounds + rows.rows(), kNoLimit);
  if (shared)
    lower.segment(n, s.slack_count()).setZero();
  dual.setZero(lower.size());

  problem.n = static_cast<int>(bounds);
  problem.m = static_cast<int>(lower.size());
  problem.ms = static_cast<int>(bounds);
  problem.H = hessian.data();
  problem.f = linear.data();
  problem.A = rows.data();
  problem.bupper = upper.data();
  problem.blower = lower.data();
  problem.sense = sense.data();
  result.x = x.data();
  result.lam = dual.data();
}

void DaqpRival::Workspace::load(const QpData& data) {
  const Eigen::Index n = structure.variable_count();
  linear.head(n) = data.gradient;
  lower.head(n) = data.lower.unaryExpr(&limited);
  upper.head(n) = data.upper.unaryExpr(&limited);
  for (Eigen::Index i = 0; i < structure.row_count(); ++i) {
    upper(rows_of(i)) = limited(data.soft_upper(i));
    lower(rows_of(i) + (shared ? 1 : 0)) = limited(data.soft_lower(i));
  }
}

// Sets half the reciprocal of the weight of each row's slack, which DAQP scales in place.
void DaqpRival::Workspace::set_softness() {
  for (Eigen::Index i = 0; i < (shared ? 0 : structure.row_count()); ++i) {
    const double softness = 0.5 / structure.slack_quadratic(structure.slack_of_row(i));
    workspace.rho_ls[rows_of(i)] = softness;
    workspace.rho_us[rows_of(i)] = softness;
  }
}

DaqpRival::DaqpRival(const QpStructure& structure) : work_(std::make_unique<Workspace>(structure)) {
  double seconds = 0.0;
  if (const int code = setup_daqp(&work_->problem, &work_->workspace, &seconds); code < 0)
    throw InputError("DAQP setup", fmt::format("code {}", code), "a strictly convex program");
}

DaqpRival::~DaqpRival() {
  free_daqp_ldp(&work_->workspace);
  free_daqp_workspace(&work_->workspace);
}

void DaqpRival::reset() {
  daqp_deactivate_constraints(&work_->workspace);
  reset_daqp_workspace(&work_->workspace);
}

double DaqpRival::solve(const QpData& data) {
  Workspace& w = *work_;
  w.load(data);
  w.set_softness();
  const double begin = short_seconds();
  daqp_update_ldp(DAQP_UPDATE_v | DAQP_UPDATE_d, &w.workspace, &w.problem);
  daqp_solve(&w.result, &w.workspace);
  const double elapsed = short_seconds() - begin;
  if (!solved())
    reset();
  return elapsed;
}

bool DaqpRival::solved() const {
  return work_->result.exitflag >= 0;
}

Eigen::Map<const Eigen::VectorXd> DaqpRival::x() const {
  return {work_->x.data(), work_->structure.variable_count()};
}

}  // namespace mpm
