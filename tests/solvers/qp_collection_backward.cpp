#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/random/random_stream.hpp"
#include "tests/solvers/qp_collection.hpp"

// How a problem is made backwards from its answer. Drawn: x, s, rows and a set of multipliers that are
// positive at upper and negative at lower limits. Then the limits are put where these multipliers belong,
// and the gradient is what makes Hx + g + bound_dual + A'(hard_dual + soft_dual) = 0. As H is positive
// definite, x is the minimiser.

namespace mpm::samples {
namespace {

enum class Slacks { none, one_a_row, one_for_three_rows };

struct Shape {
  std::string name;
  Eigen::Index variables = 1;
  Eigen::Index rows = 0;
  Slacks slacks = Slacks::none;
  double quadratic = 0.0;  ///< slack cost
  double linear = 0.0;     ///< slack cost
  double active = 0.3;     ///< share of limits that push
  double touching = 0.0;   ///< share of limits that touch without pushing
  double fixed = 0.0;      ///< share of fixed variables and equality rows
  double repeated = 0.0;   ///< share of rows that are their predecessor again, shifted by repeat_shift
  double repeat_shift = 0.0;
};

class BackwardQp {
 public:
  BackwardQp(const Shape& shape, std::uint64_t index) : shape_(shape), random_(2015, index, StreamId::audit) {
    draw_structure();
    answer_ = QpResult::zero(structure_);
    data_ = QpData::unconstrained(structure_);
    answer_.x = uniform_vector(shape.variables, -1, 1);
    row_value_ = structure_.rows * answer_.x;
    place_box();
    place_soft_limits();
    place_hard_limits();
    data_.gradient = -(structure_.hessian * answer_.x + answer_.bound_dual +
                       structure_.rows.transpose() * (answer_.hard_dual + answer_.soft_dual));
  }

  NamedQp build() const {
    return {shape_.name, std::make_shared<const QpStructure>(structure_), data_, QpStatus::solved, answer_.x};
  }

 private:
  Eigen::VectorXd uniform_vector(Eigen::Index size, double low, double high) {
    return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return random_.uniform(low, high); });
  }

  void draw_structure() {
    const Eigen::Index n = shape_.variables;
    const Eigen::Index m = shape_.rows;
    const Eigen::MatrixXd root =
        Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index, Eigen::Index) { return random_.normal(); });
    structure_.hessian = root * root.transpose() / static_cast<double>(n);
    structure_.hessian = 0.5 * (structure_.hessian + structure_.hessian.transpose()).eval();
    structure_.hessian.diagonal().array() += 0.5;
    structure_.rows.resize(m, n);
    structure_.slack_of_row.setConstant(m, -1);
    for (Eigen::Index i = 0; i < m; ++i) {
      if (i > 0 && random_.uniform() < shape_.repeated)
        structure_.rows.row(i) =
            structure_.rows.row(i - 1) + shape_.repeat_shift * uniform_vector(n, -1, 1).transpose();
      else
        structure_.rows.row(i) = uniform_vector(n, -1, 1).transpose();
      if (shape_.slacks != Slacks::none)
        structure_.slack_of_row(i) = static_cast<int>(shape_.slacks == Slacks::one_a_row ? i : i / 3);
    }
    const Eigen::Index q = m > 0 ? structure_.slack_of_row(m - 1) + 1 : 0;
    structure_.slack_quadratic.setConstant(q, shape_.quadratic);
    structure_.slack_linear.setConstant(q, shape_.linear);
  }

  /// Puts limits around `value` and returns the multiplier that pushes there.
  double place(double value, double& lower, double& upper) {
    lower = value - random_.uniform(0.1, 1);
    upper = value + random_.uniform(0.1, 1);
    const double kind = random_.uniform();
    const double size = random_.uniform(0.1, 1);
    const bool at_upper = random_.uniform() < 0.5;
    if (kind < shape_.fixed) {
      lower = upper = value;
      return at_upper ? size : -size;
    }
    if (kind >= shape_.fixed + shape_.active + shape_.touching)
      return 0.0;
    (at_upper ? upper : lower) = value;
    if (kind >= shape_.fixed + shape_.active)
      return 0.0;
    return at_upper ? size : -size;
  }

  void place_box() {
    for (Eigen::Index i = 0; i < shape_.variables; ++i)
      answer_.bound_dual(i) = place(answer_.x(i), data_.lower(i), data_.upper(i));
  }

  void place_hard_limits() {
    for (Eigen::Index i = 0; i < shape_.rows; ++i)
      answer_.hard_dual(i) = place(row_value_(i), data_.hard_lower(i), data_.hard_upper(i));
  }

  /// The limits of the rows of slack q: a slack in use is pushed with exactly its marginal cost, one at zero
  /// with less.
  void place_soft_limits() {
    for (Eigen::Index q = 0; q < structure_.slack_count(); ++q) {
      const bool in_use = random_.uniform() < shape_.active;
      const double s = in_use ? random_.uniform(0.1, 1) : 0.0;
      answer_.slack(q) = s;
      const double cost = shape_.linear + 2 * shape_.quadratic * s;
      place_group(q, s, in_use ? cost : 0.8 * cost);
    }
  }

  void place_group(Eigen::Index q, double s, double force) {
    bool pushed = false;
    for (Eigen::Index i = 0; i < shape_.rows; ++i) {
      if (structure_.slack_of_row(i) != q)
        continue;
      // The last row of a group takes what is left of the force.
      const bool last = i + 1 == shape_.rows || structure_.slack_of_row(i + 1) != q;
      const double part = last ? force : force * random_.uniform();
      const bool at_upper = random_.uniform() < 0.5;
      const bool touching = !pushed && force == 0.0 && random_.uniform() < shape_.touching;
      data_.soft_lower(i) = row_value_(i) - random_.uniform(0.1, 1);
      data_.soft_upper(i) = row_value_(i) + random_.uniform(0.1, 1);
      if (part > 0.0 || touching) {
        const double limit = at_upper ? row_value_(i) - s : row_value_(i) + s;
        const double other = at_upper ? limit - 0.5 : limit + 0.5;
        data_.soft_lower(i) = std::min(limit, other);
        data_.soft_upper(i) = std::max(limit, other);
        answer_.soft_dual(i) = at_upper ? part : -part;
        pushed = true;
      }
      force -= part;
    }
  }

  Shape shape_;
  RandomStream random_;
  QpStructure structure_;
  QpData data_;
  QpResult answer_;
  Eigen::VectorXd row_value_;
};

}  // namespace

std::vector<NamedQp> backward_qps() {
  const auto per_row = Slacks::one_a_row;
  const auto shared = Slacks::one_for_three_rows;
  const std::vector<Shape> shapes = {
      {.name = "box only", .variables = 20},
      {.name = "hard rows", .variables = 8, .rows = 12},
      {.name = "a slack a row, quadratic", .variables = 8, .rows = 30, .slacks = per_row, .quadratic = 2},
      {.name = "a slack a row, linear", .variables = 8, .rows = 30, .slacks = per_row, .linear = 0.7},
      {.name = "a slack a row, both",
       .variables = 8,
       .rows = 30,
       .slacks = per_row,
       .quadratic = 3,
       .linear = 0.2},
      {.name = "shared slacks, quadratic", .variables = 8, .rows = 30, .slacks = shared, .quadratic = 2},
      {.name = "shared slacks, linear", .variables = 8, .rows = 30, .slacks = shared, .linear = 0.7},
      {.name = "heavy slack weight", .variables = 6, .rows = 12, .slacks = per_row, .quadratic = 1000},
      {.name = "nothing active", .variables = 6, .rows = 12, .slacks = per_row, .quadratic = 1, .active = 0},
      {.name = "nearly all active",
       .variables = 10,
       .rows = 40,
       .slacks = per_row,
       .quadratic = 1,
       .active = 0.9},
      {.name = "touching limits",
       .variables = 8,
       .rows = 20,
       .slacks = per_row,
       .quadratic = 1,
       .touching = 0.4},
      {.name = "fixed variables and equality rows",
       .variables = 12,
       .rows = 6,
       .slacks = per_row,
       .quadratic = 1,
       .fixed = 0.3},
      {.name = "repeated rows",
       .variables = 8,
       .rows = 24,
       .slacks = shared,
       .quadratic = 1,
       .repeated = 0.5},
      {.name = "nearly repeated rows",
       .variables = 8,
       .rows = 24,
       .slacks = per_row,
       .quadratic = 1,
       .repeated = 0.5,
       .repeat_shift = 1e-8},
      {.name = "medium, a slack a row",
       .variables = 45,
       .rows = 150,
       .slacks = per_row,
       .quadratic = 100,
       .active = 0.1},
      {.name = "medium, shared slacks",
       .variables = 45,
       .rows = 150,
       .slacks = shared,
       .quadratic = 100,
       .active = 0.1},
  };
  constexpr std::uint64_t kDrawsPerShape = 3;
  std::vector<NamedQp> qps;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::uint64_t draw = 0; draw < kDrawsPerShape; ++draw) {
      qps.push_back(BackwardQp(shapes[i], kDrawsPerShape * i + draw).build());
      qps.back().name += " #" + std::to_string(draw);
    }
  return qps;
}

}  // namespace mpm::samples
