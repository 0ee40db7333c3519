#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "scenarios/random/random_stream.hpp"
#include "solvers/active_set_solver.hpp"
#include "solvers/linear_vertex.hpp"
#include "tests/plants/allocation_counter.hpp"
#include "tests/solvers/qp_builder.hpp"

// The active-set back end on sequences of linear programs, whose next answer is mostly a vertex it knows.

namespace mpm {
namespace {

constexpr double kWide = 3.0;  // limits that are seldom active
/// Answers from nothing keep their limits to 1e-10, and the normals of a vertex of four random rows have
/// condition numbers below 1e3.
constexpr double kPlace = 1e-7;

/// A linear program in a box with soft rows, of which some have hard limits too, whose rows and costs drift.
class LinearSequence {
 public:
  LinearSequence(std::uint64_t seed, Eigen::Index n, Eigen::Index m)
      : random_(seed, 0, StreamId::excitation) {
    auto structure = std::make_shared<QpStructure>();
    structure->hessian.setZero(n, n);
    structure->rows = RowMajorMatrix::NullaryExpr(m, n, [&] { return random_.uniform(-1.0, 1.0); });
    structure->slack_of_row.setLinSpaced(m, 0, static_cast<int>(m) - 1);
    structure->slack_of_row(0) = -1;  // this one is hard only
    structure->slack_quadratic.setZero(m);
    structure->slack_linear = Eigen::VectorXd::NullaryExpr(m, [&] { return random_.uniform(0.5, 20.0); });
    structure_ = std::move(structure);
    data_ = QpData::unconstrained(*structure_);
    data_.lower.setConstant(-1.0);
    data_.upper.setConstant(1.0);
    data_.gradient = Eigen::VectorXd::NullaryExpr(n, [&] { return random_.uniform(-1.0, 1.0); });
    middle_.setZero(m);
  }

  std::shared_ptr<const QpStructure> structure() const { return structure_; }

  const QpData& next() {
    for (Eigen::Index i = 0; i < middle_.size(); ++i)
      middle_(i) = 0.98 * middle_(i) + random_.uniform(-0.05, 0.05);
    data_.gradient(0) += random_.uniform(-0.02, 0.02);
    data_.soft_lower = middle_.array() - 0.2;
    data_.soft_upper = middle_.array() + 0.3;
    data_.soft_lower(0) = -kInfinity;
    data_.soft_upper(0) = kInfinity;
    data_.hard_lower = middle_.array() - kWide;
    data_.hard_upper(0) = middle_(0) + 0.4;
    return data_;
  }

 private:
  RandomStream random_;
  std::shared_ptr<const QpStructure> structure_;
  QpData data_;
  Eigen::VectorXd middle_;
};

}  // namespace

TEST_CASE("from vertex to vertex the answers are those from nothing", "[active-set][linear-vertex]") {
  int kept = 0, left = 0, on_hard_limits = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const auto n = static_cast<Eigen::Index>(1 + seed % 4);
    LinearSequence sequence(seed, n, 7);
    ActiveSetSolver warm(sequence.structure(), ActiveSetOptions{}),
        cold(sequence.structure(), ActiveSetOptions{});
    for (int k = 0; k < 150; ++k) {
      INFO("seed " << seed << ", sample " << k);
      const QpData& data = sequence.next();
      cold.reset();
      const QpResult& expected = cold.solve(data);
      const QpResult& result = warm.solve(data);
      REQUIRE(expected.status == QpStatus::solved);
      REQUIRE(result.status == QpStatus::solved);
      CHECK(result.kkt_residual <= 1e-9);
      CHECK(result.objective == Approx(expected.objective).epsilon(1e-8).margin(1e-8));
      CHECK((result.x - expected.x).lpNorm<Eigen::Infinity>() <= kPlace);
      CHECK((result.slack - expected.slack).lpNorm<Eigen::Infinity>() <= kPlace);
      const bool from_vertex = result.iterations == 1;
      kept += from_vertex;
      left += !from_vertex;
      on_hard_limits += from_vertex && result.hard_dual.cwiseAbs().maxCoeff() > 0.0;
      beyond += from_vertex && result.slack.maxCoeff() > 0.0;
    }
  }
  // All kinds were met.
  CHECK(kept > 1200);
  CHECK(left > 100);
  CHECK(on_hard_limits > 50);
  CHECK(beyond > 50);
}

TEST_CASE("from vertex to vertex nothing is allocated", "[active-set][linear-vertex][allocation]") {
  LinearSequence sequence(5, 12, 30);
  ActiveSetSolver solver(sequence.structure(), ActiveSetOptions{});
  int kept = 0, left = 0;
  const std::size_t before = allocation_count();
  for (int k = 0; k < 200; ++k)
    (solver.solve(sequence.next()).iterations == 1 ? kept : left) += 1;
  const std::size_t after = allocation_count();
  CHECK(after - before == 0);
  CHECK(kept > 20);
  CHECK(left > 20);
}

TEST_CASE("a vertex that is one of several answers is not kept", "[active-set][linear-vertex]") {
  using samples::vec;
  // Every point of the edge x1 + x2 = 1 of the box costs the same; (1/2, 1/2) is nearest to the origin.
  const samples::NamedQp edge = samples::QpBuilder("edge", Eigen::MatrixXd::Zero(2, 2), vec(-1.0, -1.0))
                                    .box(vec(0.0, 0.0), vec(1.0, 1.0))
                                    .slack(0.0, 10.0)
                                    .soft(vec(1.0, 1.0), 0, -kInfinity, 1.0);
  ActiveSetSolver solver(edge.structure, ActiveSetOptions{});
  for (int k = 0; k < 3; ++k) {
    const QpResult& result = solver.solve(edge.data);
    REQUIRE(result.status == QpStatus::solved);
    CHECK((result.x - vec(0.5, 0.5)).norm() < 1e-8);
    CHECK(result.iterations > 1);
  }
}

TEST_CASE("only linear programs with own slacks have a vertex to keep", "[linear-vertex]") {
  const auto structure = *LinearSequence(1, 2, 3).structure();
  CHECK(LinearVertex::applies(structure));
  QpStructure other = structure;
  other.hessian(1, 1) = 1e-12;
  CHECK_FALSE(LinearVertex::applies(other));
  other = structure;
  other.slack_quadratic(2) = 1.0;
  CHECK_FALSE(LinearVertex::applies(other));
  other = structure;
  other.slack_of_row(1) = other.slack_of_row(2);
  CHECK_FALSE(LinearVertex::applies(other));
}

}  // namespace mpm
