#include "solvers/ipopt_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>
#include <fmt/format.h>

#include "plants/error.hpp"
#include "solvers/working_set.hpp"

namespace mpm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kIpoptInfinity = 2e19;           // Ipopt reads anything beyond 1e19 as no limit
constexpr double kRowTolerance = 1e-9;            // a left-out limit counts as kept up to here
constexpr double kInfeasibilityThreshold = 1e-7;  // smallest violation that proves infeasibility
constexpr double kCertifiedResidual = 1e-7;       // a point with at most this is an answer

double finite_limit(double limit) {
  return std::clamp(limit, -kIpoptInfinity, kIpoptInfinity);
}

/// The reduced problem over a working set as Ipopt sees it: variables (x, slacks in use), one constraint a
/// working row. All derivatives are constant.
class ReducedProgram final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  ReducedProgram(const QpStructure& structure, const WorkingSet& set) : structure_(structure), set_(set) {}

  /// The problem of the next solve; `start` is the answer it starts from and receives the new one.
  void bind(const QpData& data, QpResult& start) {
    data_ = &data;
    result_ = &start;
  }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_size, Index& hessian_size,
                    IndexStyleEnum& style) override {
    n = variables() + slacks();
    m = rows();
    jacobian_size = 0;
    for (const WorkingRow& row : set_.rows())
      jacobian_size += variables() + (row.side == RowSide::hard ? 0 : 1);
    hessian_size = variables() * (variables() + 1) / 2 + slacks();
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* g_lower,
                       Number* g_upper) override {
    for (Index i = 0; i < variables(); ++i) {
      x_lower[i] = finite_limit(data_->lower(i));
      x_upper[i] = finite_limit(data_->upper(i));
    }
    for (Index k = 0; k < slacks(); ++k) {
      x_lower[variables() + k] = 0.0;
      x_upper[variables() + k] = kIpoptInfinity;
    }
    for (Index r = 0; r < rows(); ++r) {
      const auto [row, side] = working_row(r);
      g_lower[r] = side == RowSide::hard         ? finite_limit(data_->hard_lower(row))
                   : side == RowSide::soft_lower ? data_->soft_lower(row)
                                                 : -kIpoptInfinity;
      g_upper[r] = side == RowSide::hard         ? finite_limit(data_->hard_upper(row))
                   : side == RowSide::soft_upper ? data_->soft_upper(row)
                                                 : kIpoptInfinity;
    }
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool init_z, Number* z_lower, Number* z_upper, Index,
                          bool init_lambda, Number* lambda) override {
    for (Index i = 0; i < variables(); ++i)
      x[i] = result_->x(i);
    for (Index k = 0; k < slacks(); ++k)
      x[variables() + k] = result_->slack(slack(k));
    if (init_z) {
      for (Index i = 0; i < variables(); ++i) {
        z_lower[i] = std::max(0.0, -result_->bound_dual(i));
        z_upper[i] = std::max(0.0, result_->bound_dual(i));
      }
      for (Index k = variables(); k < variables() + slacks(); ++k)
        z_lower[k] = z_upper[k] = 0.0;
    }
    if (init_lambda)
      for (Index r = 0; r < rows(); ++r) {
        const auto [row, side] = working_row(r);
        lambda[r] = side == RowSide::hard ? result_->hard_dual(row) : result_->soft_dual(row);
      }
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    const Eigen::Map<const Eigen::VectorXd> moves(x, variables());
    value = 0.0;
    for (Index i = 0; i < variables(); ++i)
      value += moves(i) * (0.5 * structure_.hessian.col(i).dot(moves) + data_->gradient(i));
    for (Index k = 0; k < slacks(); ++k) {
      const double s = x[variables() + k];
      value += s * (structure_.slack_quadratic(slack(k)) * s + structure_.slack_linear(slack(k)));
    }
    return true;
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    Eigen::Map<Eigen::VectorXd> of_moves(gradient, variables());
    of_moves = data_->gradient;
    of_moves.noalias() += structure_.hessian * Eigen::Map<const Eigen::VectorXd>(x, variables());
    for (Index k = 0; k < slacks(); ++k)
      gradient[variables() + k] =
          2.0 * structure_.slack_quadratic(slack(k)) * x[variables() + k] + structure_.slack_linear(slack(k));
    return true;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* g) override {
    const Eigen::Map<const Eigen::VectorXd> moves(x, variables());
    for (Index r = 0; r < rows(); ++r) {
      g[r] = structure_.rows.row(working_row(r).row).dot(moves);
      if (const Index k = slack_column(r); k >= 0)
        g[r] += slack_sign(r) * x[k];
    }
    return true;
  }

  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index* row_index, Index* column,
                  Number* values) override {
    Index entry = 0;
    const auto put = [&](Index r, Index c, Number value) {
      if (values == nullptr) {
        row_index[entry] = r;
        column[entry] = c;
      } else {
        values[entry] = value;
      }
      ++entry;
    };
    for (Index r = 0; r < rows(); ++r) {
      for (Index i = 0; i < variables(); ++i)
        put(r, i, structure_.rows(working_row(r).row, i));
      if (const Index k = slack_column(r); k >= 0)
        put(r, k, slack_sign(r));
    }
    return true;
  }

  bool eval_h(Index, const Number*, bool, Number objective_factor, Index, const Number*, bool, Index,
              Index* row_index, Index* column, Number* values) override {
    Index entry = 0;
    const auto put = [&](Index r, Index c, Number value) {
      if (values == nullptr) {
        row_index[entry] = r;
        column[entry] = c;
      } else {
        values[entry] = objective_factor * value;
      }
      ++entry;
    };
    for (Index i = 0; i < variables(); ++i)
      for (Index j = 0; j <= i; ++j)
        put(i, j, structure_.hessian(i, j));
    for (Index k = 0; k < slacks(); ++k)
      put(variables() + k, variables() + k, 2.0 * structure_.slack_quadratic(slack(k)));
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number* z_lower,
                         const Number* z_upper, Index, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    result_->slack.setZero();
    result_->hard_dual.setZero();
    result_->soft_dual.setZero();
    for (Index i = 0; i < variables(); ++i) {
      result_->x(i) = x[i];
      result_->bound_dual(i) = z_upper[i] - z_lower[i];
    }
    for (Index k = 0; k < slacks(); ++k)
      result_->slack(slack(k)) = x[variables() + k];
    for (Index r = 0; r < rows(); ++r) {
      const auto [row, side] = working_row(r);
      (side == RowSide::hard ? result_->hard_dual : result_->soft_dual)(row) += lambda[r];
    }
    // Ipopt removes fixed variables and returns no multiplier for them: it is what stationarity leaves.
    for (Index i = 0; i < variables(); ++i)
      if (data_->lower(i) == data_->upper(i))
        result_->bound_dual(i) = -(structure_.hessian.row(i).dot(result_->x) + data_->gradient(i) +
                                   structure_.rows.col(i).dot(result_->hard_dual + result_->soft_dual));
  }

 private:
  Index variables() const { return static_cast<Index>(structure_.variable_count()); }
  Index slacks() const { return static_cast<Index>(set_.slacks().size()); }
  Index rows() const { return static_cast<Index>(set_.rows().size()); }
  int slack(Index k) const { return set_.slacks()[static_cast<std::size_t>(k)]; }
  WorkingRow working_row(Index r) const { return set_.rows()[static_cast<std::size_t>(r)]; }
  double slack_sign(Index r) const { return working_row(r).side == RowSide::soft_lower ? 1.0 : -1.0; }
  Index slack_column(Index r) const {
    const auto [row, side] = working_row(r);
    return side == RowSide::hard ? -1 : variables() + set_.slack_position(structure_.slack_of_row(row));
  }

  const QpStructure& structure_;
  const WorkingSet& set_;
  const QpData* data_ = nullptr;
  QpResult* result_ = nullptr;
};

/// A row that no variable can move and whose hard limits its constant value 0 violates.
bool has_impossible_row(const QpStructure& structure, const QpData& data) {
  for (Eigen::Index i = 0; i < structure.row_count(); ++i)
    if ((data.hard_lower(i) > kInfeasibilityThreshold || data.hard_upper(i) < -kInfeasibilityThreshold) &&
        structure.rows.row(i).isZero(0.0))
      return true;
  return false;
}

/// No answer to start from.
void forget_answer(QpResult& result) {
  result.x.setZero();
  result.slack.setZero();
  result.bound_dual.setZero();
  result.hard_dual.setZero();
  result.soft_dual.setZero();
}

QpStatus status_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      return QpStatus::solved;
    case Ipopt::Infeasible_Problem_Detected:
    case Ipopt::Restoration_Failed:
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return QpStatus::infeasible;
    case Ipopt::Maximum_Iterations_Exceeded:
      return QpStatus::iteration_limit;
    default:
      return QpStatus::numerical_error;
  }
}

}  // namespace

void IpoptOptions::validate() const {
  if (!(tolerance > 0 && tolerance < 1))
    throw InputError("Ipopt tolerance", fmt::to_string(tolerance), "0 to 1");
  if (iteration_limit < 1)
    throw InputError("Ipopt iteration_limit", fmt::to_string(iteration_limit), ">= 1");
  if (!(std::isfinite(working_set_margin) && working_set_margin >= 0))
    throw InputError("Ipopt working_set_margin", fmt::to_string(working_set_margin), "a number >= 0");
}

/// The Ipopt application, kept from step to step, and the working set it solves over.
class IpoptSolver::Implementation {
 public:
  Implementation(const QpStructure& structure, const IpoptOptions& options)
      : set(structure),
        program_(new ReducedProgram(structure, set)),
        application_(IpoptApplicationFactory()) {
    const auto settings = application_->Options();
    settings->SetStringValue("sb", "yes");
    settings->SetIntegerValue("print_level", 0);
    settings->SetIntegerValue("max_iter", options.iteration_limit);
    settings->SetNumericValue("tol", options.tolerance);
    settings->SetNumericValue("constr_viol_tol", options.tolerance);
    settings->SetNumericValue("compl_inf_tol", options.tolerance);
    settings->SetNumericValue("dual_inf_tol", 1e3 * options.tolerance);
    settings->SetNumericValue("acceptable_tol", 1e2 * options.tolerance);
    settings->SetNumericValue("bound_relax_factor", 0.0);
    settings->SetStringValue("nlp_scaling_method", "none");
    settings->SetStringValue("hessian_constant", "yes");
    settings->SetStringValue("jac_d_constant", "yes");
    settings->SetStringValue("linear_solver", "mumps");
    // An empty name: an ipopt.opt that lies in the current folder must not change the answers.
    if (application_->Initialize("") != Ipopt::Solve_Succeeded)
      throw InputError("Ipopt", "an installation that does not start", "Ipopt 3.11 or later with MUMPS");
  }

  /// One Ipopt run over the working set, from and into `result`.
  QpStatus run(const QpData& data, QpResult& result) {
    program_->bind(data, result);
    const QpStatus status = status_of(application_->OptimizeTNLP(program_));
    if (const auto statistics = application_->Statistics(); Ipopt::IsValid(statistics))
      result.iterations += statistics->IterationCount();
    return status;
  }

  WorkingSet set;

 private:
  Ipopt::SmartPtr<ReducedProgram> program_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application_;
};

IpoptSolver::IpoptSolver(std::shared_ptr<const QpStructure> structure, const IpoptOptions& options)
    : QpSolver(std::move(structure)), options_(options) {
  options_.validate();
  implementation_ = std::make_unique<Implementation>(this->structure(), options_);
}

IpoptSolver::~IpoptSolver() = default;

void IpoptSolver::do_reset() {
  implementation_->set.clear();
}

void IpoptSolver::do_solve(const QpData& data, QpResult& result) {
  if (result.status != QpStatus::solved)
    forget_answer(result);
  result.iterations = 0;
  if (has_impossible_row(structure(), data)) {
    result.status = QpStatus::infeasible;
    return;
  }
  if (options_.working_set)
    solve_growing(data, result);
  else
    solve_full(data, result);
  if (result.status == QpStatus::solved)
    return;
  if (certainly_infeasible(data)) {
    result.status = QpStatus::infeasible;
    return;
  }
  if (options_.working_set) {  // a limit that was left out may be what bounds the problem
    forget_answer(result);
    solve_full(data, result);
  }
  if (result.status == QpStatus::infeasible)  // Ipopt's own word for it is no certificate
    result.status = QpStatus::numerical_error;
}

void IpoptSolver::solve_growing(const QpData& data, QpResult& result) {
  WorkingSet& set = implementation_->set;
  const auto add_violated = [&] {
    return set.add_violated(structure(), data, result.x, result.slack, options_.working_set_margin,
                            kRowTolerance);
  };
  set.clear();
  add_violated();
  do
    run(data, result);
  while (result.status == QpStatus::solved && add_violated() > 0);
}

void IpoptSolver::solve_full(const QpData& data, QpResult& result) {
  implementation_->set.clear();
  implementation_->set.fill(structure(), data);
  run(data, result);
}

// Near the limit of double precision Ipopt may end for want of progress at a point that is as good as any:
// the certificate decides.
void IpoptSolver::run(const QpData& data, QpResult& result) {
  result.status = implementation_->run(data, result);
  if (result.status != QpStatus::solved && kkt_residual(structure(), data, result) <= kCertifiedResidual)
    result.status = QpStatus::solved;
}

// The smallest t with hard_lower - t <= Ax <= hard_upper + t within the box, as a soft-constrained program
// with one slack: the soft limits are the hard ones.
bool IpoptSolver::certainly_infeasible(const QpData& data) {
  const Eigen::Index m = structure().row_count();
  if (!(data.hard_lower.array() > -kInfinity).any() && !(data.hard_upper.array() < kInfinity).any())
    return false;
  if (!feasibility_) {
    auto relaxed = std::make_shared<QpStructure>();
    relaxed->hessian.setZero(structure().variable_count(), structure().variable_count());
    relaxed->rows = structure().rows;
    relaxed->slack_of_row.setZero(m);
    relaxed->slack_quadratic.setZero(1);
    relaxed->slack_linear.setOnes(1);
    feasibility_ = std::make_unique<IpoptSolver>(relaxed, options_);
  }
  QpData relaxed = QpData::unconstrained(feasibility_->structure());
  relaxed.lower = data.lower;
  relaxed.upper = data.upper;
  relaxed.soft_lower = data.hard_lower;
  relaxed.soft_upper = data.hard_upper;
  feasibility_->reset();
  const QpResult& smallest = feasibility_->solve(relaxed);
  return smallest.status == QpStatus::solved && smallest.slack(0) > kInfeasibilityThreshold;
}

}  // namespace mpm
