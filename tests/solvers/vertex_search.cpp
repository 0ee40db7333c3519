#include "tests/solvers/vertex_search.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "base/non_finite.hpp"

namespace mpm::samples {
namespace {

constexpr double kTouching = 1e-9;  // rounding of a 3 x 3 solution of order one

struct Plane {
  Eigen::RowVector3d normal;
  double value;
};

std::vector<Plane> planes_of(const Eigen::MatrixXd& normals, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high) {
  std::vector<Plane> planes;
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    planes.push_back({normals.row(i), low(i)});
    planes.push_back({normals.row(i), high(i)});
  }
  return planes;
}

std::optional<Eigen::Vector3d> meeting_point(const Plane& a, const Plane& b, const Plane& c) {
  Eigen::Matrix3d normals;
  normals << a.normal, b.normal, c.normal;
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normals);
  if (!lu.isInvertible())
    return std::nullopt;
  return lu.solve(Eigen::Vector3d(a.value, b.value, c.value));
}

}  // namespace

VertexSearch::VertexSearch(const Eigen::MatrixXd& static_gain, const MpcOptions& options,
                           const Eigen::VectorXd& y_at_zero)
    : gain_(static_gain),
      cost_(options.mv_cost),
      low_(options.cv_soft.lower - y_at_zero),
      high_(options.cv_soft.upper - y_at_zero) {
  const Limits& box = options.mv_hard;
  std::vector<Plane> planes = planes_of(gain_, low_, high_);
  for (const Plane& side : planes_of(Eigen::Matrix3d::Identity(), box.lower, box.upper))
    planes.push_back(side);
  for (std::size_t a = 0; a < planes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c) {
        const auto u = meeting_point(planes[a], planes[b], planes[c]);
        if (u && (u->array() >= box.lower.array() - kTouching).all() &&
            (u->array() <= box.upper.array() + kTouching).all())
          vertices_.push_back(*u);
      }
}

double VertexSearch::violation(const Eigen::Vector3d& u) const {
  const Eigen::VectorXd y = gain_ * u;
  return (low_ - y).cwiseMax(0).sum() + (y - high_).cwiseMax(0).sum();
}

std::optional<Eigen::Vector3d> VertexSearch::keeping_all_limits() const {
  std::optional<Eigen::Vector3d> best;
  for (const Eigen::Vector3d& u : vertices_)
    if (violation(u) < 100 * kTouching && (!best || cost_.dot(u) < cost_.dot(*best)))
      best = u;
  return best;
}

double VertexSearch::smallest_violation() const {
  double smallest = kInfinity;
  for (const Eigen::Vector3d& u : vertices_)
    smallest = std::min(smallest, violation(u));
  return smallest;
}

double VertexSearch::smallest_cost(double price) const {
  double smallest = kInfinity;
  for (const Eigen::Vector3d& u : vertices_)
    smallest = std::min(smallest, cost_.dot(u) + price * violation(u));
  return smallest;
}

}  // namespace mpm::samples
