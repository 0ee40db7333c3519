#include "bench/perf/hpipm_rival.hpp"

#include <vector>

#include "bench/perf/short_clock.hpp"
#include "solvers/lanes/lane_vector.hpp"

extern "C" {
#include <hpipm_d_dense_qp.h>
#include <hpipm_d_dense_qp_dim.h>
#include <hpipm_d_dense_qp_ipm.h>
#include <hpipm_d_dense_qp_sol.h>
}

namespace mpm {
namespace {

constexpr double kTolerance = 1e-8;  // with 1e-10 it reports no success from 40x15 on
constexpr double kFarAway = 1e6;     // an absent limit

}  // namespace

struct HpipmRival::Workspace {
  explicit Workspace(const QpStructure& structure);

  /// Memory for the next of HPIPM's objects.
  void* room(hpipm_size_t bytes) {
    memory.emplace_back(bytes / sizeof(double) + 8, 0.0);
    return memory.back().data();
  }
  void set_structure(const QpStructure& structure);

  std::vector<LaneMemory> memory;
  d_dense_qp_dim size{};
  d_dense_qp program{};
  d_dense_qp_sol answer{};
  d_dense_qp_ipm_arg options{};
  d_dense_qp_ipm_ws work{};
  QpData data;
  Eigen::VectorXd x;
  int status = -1;
};

HpipmRival::Workspace::Workspace(const QpStructure& structure) : x(structure.variable_count()) {
  const auto n = static_cast<int>(structure.variable_count());
  const auto m = static_cast<int>(structure.row_count());
  d_dense_qp_dim_create(&size, room(d_dense_qp_dim_memsize()));
  d_dense_qp_dim_set_all(n, 0, n, m, m, &size);
  d_dense_qp_create(&size, &program, room(d_dense_qp_memsize(&size)));
  d_dense_qp_sol_create(&size, &answer, room(d_dense_qp_sol_memsize(&size)));
  d_dense_qp_ipm_arg_create(&size, &options, room(d_dense_qp_ipm_arg_memsize(&size)));
  d_dense_qp_ipm_arg_set_default(SPEED, &options);
  double tolerance = kTolerance;
  d_dense_qp_ipm_arg_set_tol_stat(&tolerance, &options);
  d_dense_qp_ipm_arg_set_tol_ineq(&tolerance, &options);
  d_dense_qp_ipm_arg_set_tol_comp(&tolerance, &options);
  d_dense_qp_ipm_ws_create(&size, &options, &work, room(d_dense_qp_ipm_ws_memsize(&size, &options)));
  set_structure(structure);
}

void HpipmRival::Workspace::set_structure(const QpStructure& structure) {
  Eigen::MatrixXd hessian = structure.hessian;
  Eigen::MatrixXd rows = structure.rows;
  const Eigen::Index n = rows.cols();
  const Eigen::Index m = rows.rows();
  std::vector<int> bounded, softened;  // HPIPM numbers the limits through: bounds, then rows
  for (int j = 0; j < static_cast<int>(n); ++j)
    bounded.push_back(j);
  for (int i = 0; i < static_cast<int>(m); ++i)
    softened.push_back(static_cast<int>(n) + i);
  Eigen::VectorXd weight(m);
  for (Eigen::Index i = 0; i < m; ++i)
    weight(i) = 2.0 * structure.slack_quadratic(structure.slack_of_row(i));
  Eigen::VectorXd zero = Eigen::VectorXd::Zero(m);
  d_dense_qp_set_H(hessian.data(), &program);
  d_dense_qp_set_C(rows.data(), &program);
  d_dense_qp_set_idxb(bounded.data(), &program);
  d_dense_qp_set_idxs(softened.data(), &program);
  for (const auto set : {d_dense_qp_set_Zl, d_dense_qp_set_Zu})
    set(weight.data(), &program);
  for (const auto set : {d_dense_qp_set_zl, d_dense_qp_set_zu, d_dense_qp_set_lls, d_dense_qp_set_lus})
    set(zero.data(), &program);
}

HpipmRival::HpipmRival(const QpStructure& structure) : work_(std::make_unique<Workspace>(structure)) {}

HpipmRival::~HpipmRival() = default;

double HpipmRival::solve(const QpData& data) {
  Workspace& w = *work_;
  w.data = data;
  w.data.soft_lower = data.soft_lower.cwiseMax(-kFarAway);
  w.data.soft_upper = data.soft_upper.cwiseMin(kFarAway);
  d_dense_qp_set_g(w.data.gradient.data(), &w.program);
  d_dense_qp_set_lb(w.data.lower.data(), &w.program);
  d_dense_qp_set_ub(w.data.upper.data(), &w.program);
  d_dense_qp_set_lg(w.data.soft_lower.data(), &w.program);
  d_dense_qp_set_ug(w.data.soft_upper.data(), &w.program);
  const double begin = short_seconds();
  d_dense_qp_ipm_solve(&w.program, &w.answer, &w.options, &w.work);
  const double elapsed = short_seconds() - begin;
  d_dense_qp_ipm_get_status(&w.work, &w.status);
  d_dense_qp_sol_get_v(&w.answer, w.x.data());
  return elapsed;
}

bool HpipmRival::solved() const {
  return work_->status == SUCCESS;
}

const Eigen::VectorXd& HpipmRival::x() const {
  return work_->x;
}

}  // namespace mpm
