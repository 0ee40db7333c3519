#include "solvers/ipopt_solver.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/system/thread_clock.hpp"
#include "solvers/reduced_program.hpp"
#include "solvers/working_set.hpp"

namespace mpm {
namespace {

constexpr double kIpoptInfinity = 2e19;           // Ipopt reads anything beyond 1e19 as no limit
constexpr double kRowTolerance = 1e-9;            // a left-out limit counts as kept up to this violation
constexpr double kInfeasibilityThreshold = 1e-7;  // smallest violation that proves infeasibility
constexpr std::size_t kManyRows = 200;            // of P1's 1 620 some 130 are in the set at a quiet step
constexpr double kPushing = 1e-6;                 // least multiplier of a limit that pushes

double finite_limit(double limit) {
  return std::clamp(limit, -kIpoptInfinity, kIpoptInfinity);
}

/// A reduced program as Ipopt sees it. All derivatives of second order are constant.
class ProgramForIpopt final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  ProgramForIpopt(const QpStructure& structure, const WorkingSet& set)
      : structure_(structure), set_(set), program_(structure) {}

  /// The problem of the next solve; `start` is the answer it starts from and receives the new one. It stops
  /// after the iteration in which thread_seconds() reaches `end`.
  void bind(const QpData& data, QpResult& start, double end) {
    end_ = end;
    data_ = &data;
    result_ = &start;
    program_.assemble(set_, data, start);
  }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_size, Index& hessian_size,
                    IndexStyleEnum& style) override {
    n = variables();
    m = constraints();
    jacobian_size = static_cast<Index>(program_.constraints().size());
    hessian_size = static_cast<Index>(program_.hessian().size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* g_lower,
                       Number* g_upper) override {
    write_limits(program_.lower(), x_lower);
    write_limits(program_.upper(), x_upper);
    write_limits(program_.constraint_lower(), g_lower);
    write_limits(program_.constraint_upper(), g_upper);
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    Eigen::Map<Eigen::VectorXd>(x, variables()) = program_.start();
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = program_.gradient().dot(Eigen::Map<const Eigen::VectorXd>(x, variables()));
    for (const auto [i, j, q] : program_.hessian())
      value += (i == j ? 0.5 : 1.0) * q * x[i] * x[j];
    return true;
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    Eigen::Map<Eigen::VectorXd>(gradient, variables()) = program_.gradient();
    for (const auto [i, j, q] : program_.hessian()) {
      gradient[i] += q * x[j];
      if (i != j)
        gradient[j] += q * x[i];
    }
    return true;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* g) override {
    std::fill_n(g, constraints(), 0.0);
    for (const auto [i, j, c] : program_.constraints())
      g[i] += c * x[j];
    return true;
  }

  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index* row, Index* column,
                  Number* values) override {
    write_entries(program_.constraints(), 1.0, row, column, values);
    return true;
  }

  bool eval_h(Index, const Number*, bool, Number objective_factor, Index, const Number*, bool, Index,
              Index* row, Index* column, Number* values) override {
    write_entries(program_.hessian(), objective_factor, row, column, values);
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number, Number,
                             Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return thread_seconds() < end_;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number* z_lower,
                         const Number* z_upper, Index m, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    using Map = Eigen::Map<const Eigen::VectorXd>;
    program_.report(set_, *data_, Map(x, n), Map(z_upper, n) - Map(z_lower, n), Map(lambda, m), *result_);
    // Ipopt removes fixed variables and returns no multiplier for them; stationarity gives it.
    for (Eigen::Index i = 0; i < structure_.variable_count(); ++i)
      if (data_->lower(i) == data_->upper(i))
        result_->bound_dual(i) = -(structure_.hessian.row(i).dot(result_->x) + data_->gradient(i) +
                                   structure_.rows.col(i).dot(result_->hard_dual + result_->soft_dual));
  }

 private:
  Index variables() const { return static_cast<Index>(program_.variable_count()); }
  Index constraints() const { return static_cast<Index>(program_.constraint_count()); }

  /// Writes the pattern of a matrix if there is no room for values, otherwise its values.
  static void write_entries(const std::vector<MatrixEntry>& entries, double factor, Index* row, Index* column,
                            Number* values) {
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (values == nullptr) {
        row[k] = entries[k].row;
        column[k] = entries[k].column;
      } else {
        values[k] = factor * entries[k].value;
      }
  }

  static void write_limits(const Eigen::VectorXd& limits, Number* out) {
    std::transform(limits.begin(), limits.end(), out, finite_limit);
  }

  const QpStructure& structure_;
  const WorkingSet& set_;
  ReducedProgram program_;
  double end_ = 0.0;
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

/// Clears the answer: there is none to start from.
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
    case Ipopt::User_Requested_Stop:  // by intermediate_callback()
      return QpStatus::time_limit;
    case Ipopt::Insufficient_Memory:
      throw std::bad_alloc();
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
  if (rows_at_once < 0)
    throw InputError("Ipopt rows_at_once", fmt::to_string(rows_at_once), ">= 0");
  if (!(std::isfinite(working_set_margin) && working_set_margin >= 0))
    throw InputError("Ipopt working_set_margin", fmt::to_string(working_set_margin), "a number >= 0");
}

/// The Ipopt application, kept from step to step, and the working set it solves over.
class IpoptSolver::Implementation {
 public:
  Implementation(const QpStructure& structure, const IpoptOptions& options)
      : set(structure),
        program_(new ProgramForIpopt(structure, set)),
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
    // The last answer is near, and Ipopt's own 0.1 would lead away from it first (docs/performance.md).
    settings->SetNumericValue("mu_init", 1e-3);
    // Ipopt's own steps are scaled well enough; scaling by MUMPS takes longer than it saves.
    settings->SetIntegerValue("mumps_scaling", 0);
    settings->SetIntegerValue("mumps_permuting_scaling", 0);
    // An empty name: an ipopt.opt that lies in the current folder must not change the answers.
    if (application_->Initialize("") != Ipopt::Solve_Succeeded)
      throw InputError("Ipopt", "an installation that does not start", "Ipopt 3.11 or later with MUMPS");
  }

  /// One Ipopt run over the working set, from and into `result`, until thread_seconds() reaches `end`.
  QpStatus run(const QpData& data, QpResult& result, double end) {
    if (thread_seconds() >= end)
      return QpStatus::time_limit;
    program_->bind(data, result, end);
    const QpStatus status = status_of(application_->OptimizeTNLP(program_));
    if (const auto statistics = application_->Statistics(); Ipopt::IsValid(statistics))
      result.iterations += statistics->IterationCount();
    return status;
  }

  WorkingSet set;

 private:
  Ipopt::SmartPtr<ProgramForIpopt> program_;
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
  end_ = thread_seconds() + time_limit();
  if (result.status != QpStatus::solved)
    forget_answer(result);
  result.iterations = 0;
  if (has_impossible_row(structure(), data)) {
    result.status = QpStatus::infeasible;
    return;
  }
  const bool in_rounds = options_.working_set && structure().row_count() > options_.rows_at_once;
  if (in_rounds)
    solve_growing(data, result);
  else
    solve_full(data, result);
  if (result.status == QpStatus::solved)
    return;
  if (certainly_infeasible(data)) {
    result.status = QpStatus::infeasible;
    return;
  }
  if (in_rounds) {  // a limit that was left out may be what bounds the problem
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
  // After a sudden change the last answer violates nearly everything and says little. Its active limits are
  // then the better guess, and the time of a run grows faster than the number of rows.
  if (set.rows().size() > kManyRows) {
    set.clear();
    set.add_active(structure(), data, result, kPushing);
  }
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
  result.status = implementation_->run(data, result, end_);
  if (result.status != QpStatus::solved && kkt_residual(structure(), data, result) <= kSolvedKktResidual)
    result.status = QpStatus::solved;
}

// Finds the smallest t with hard_lower - t <= Ax <= hard_upper + t within the box, as a soft-constrained
// program with one slack, whose soft limits are the hard ones.
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
  feasibility_->set_time_limit(end_ - thread_seconds());
  feasibility_->reset();
  const QpResult& smallest = feasibility_->solve(relaxed);
  return smallest.status == QpStatus::solved && smallest.slack(0) > kInfeasibilityThreshold;
}

}  // namespace mpm
