#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "solvers/ipopt_solver.hpp"
#include "tests/solvers/qp_builder.hpp"

namespace mpm {
namespace {

using samples::NamedQp;
using samples::QpBuilder;
using samples::vec;

NamedQp half_plane() {
  return QpBuilder("nearest point of a half plane", Eigen::MatrixXd::Identity(2, 2), vec(0, 0))
      .hard(vec(3, 4), 5, kInfinity);
}

/// Stands in a folder of its own until the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder() : before_(std::filesystem::current_path()), folder_(before_ / "ipopt-opt-test") {
    std::filesystem::create_directories(folder_);
    std::filesystem::current_path(folder_);
  }
  ~TemporaryFolder() {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::filesystem::path before_, folder_;
};

}  // namespace

TEST_CASE("Ipopt options are checked", "[ipopt]") {
  const double nan = kNaN;
  CHECK_NOTHROW(IpoptOptions{}.validate());
  CHECK_NOTHROW(IpoptOptions{.working_set_margin = 0}.validate());
  for (const double tolerance : {0.0, -1e-8, 1.0, nan})
    CHECK_THROWS_AS(IpoptOptions{.tolerance = tolerance}.validate(), InputError);
  CHECK_THROWS_AS(IpoptOptions{.iteration_limit = 0}.validate(), InputError);
  for (const double margin : {-1e-3, kInfinity, nan})
    CHECK_THROWS_AS(IpoptOptions{.working_set_margin = margin}.validate(), InputError);
  CHECK_THROWS_AS(IpoptOptions{.rows_at_once = -1}.validate(), InputError);
  CHECK_THROWS_AS(IpoptSolver(half_plane().structure, {.tolerance = 0}), InputError);
}

TEST_CASE("the iteration limit is reported", "[ipopt]") {
  const bool working_set = GENERATE(true, false);
  const NamedQp qp = half_plane();
  IpoptSolver solver(qp.structure, {.iteration_limit = 2, .working_set = working_set});
  CHECK(solver.solve(qp.data).status == QpStatus::iteration_limit);
}

TEST_CASE("the limit of time is one of each problem, all its runs together", "[ipopt]") {
  const bool working_set = GENERATE(true, false);
  const NamedQp qp = half_plane();
  const IpoptOptions options{.working_set = working_set, .rows_at_once = 0};
  const QpResult expected = IpoptSolver(qp.structure, options).solve(qp.data);
  REQUIRE(expected.status == QpStatus::solved);
  IpoptSolver solver(qp.structure, options);
  for (const double seconds : {60.0, 0.0, 1e-9, kInfinity, 60.0}) {
    solver.set_time_limit(seconds);
    solver.reset();
    const QpResult& result = solver.solve(qp.data);
    CHECK(result.status == (seconds < 1.0 ? QpStatus::time_limit : QpStatus::solved));
    if (seconds > 1.0)
      CHECK(result.x == expected.x);  // a limit that is not reached changes no bit
  }
}

TEST_CASE("an ipopt.opt in the current folder is not read", "[ipopt]") {
  const TemporaryFolder folder;
  std::ofstream("ipopt.opt") << "max_iter 1\n";
  const NamedQp qp = half_plane();
  IpoptSolver solver(qp.structure, {});
  CHECK(solver.solve(qp.data).status == QpStatus::solved);
}

// The margin that lets limits in early must not change the answer.
TEST_CASE("the margin of the working set does not matter for the answer", "[ipopt]") {
  for (const NamedQp& qp : samples::closed_form_qps()) {
    INFO(qp.name);
    for (const double margin : {0.0, 10.0}) {
      IpoptSolver solver(qp.structure, {.working_set_margin = margin, .rows_at_once = 0});
      const QpResult& result = solver.solve(qp.data);
      REQUIRE(result.status == QpStatus::solved);
      // 1e-10 of complementarity at a limit that touches moves x by 1e-5.
      CHECK((result.x - *qp.x).lpNorm<Eigen::Infinity>() < 1e-4);
    }
  }
}

TEST_CASE("growing the working set from nothing answers the whole collection", "[ipopt]") {
  for (const NamedQp& qp : samples::qp_collection()) {
    INFO(qp.name);
    IpoptSolver solver(qp.structure, {.rows_at_once = 0});
    const QpResult& result = solver.solve(qp.data);
    CHECK(to_string(result.status) == to_string(qp.expected));
    if (qp.expected == QpStatus::solved)
      CHECK(result.kkt_residual < 1e-7);  // what IpoptSolver promises
  }
}

}  // namespace mpm
