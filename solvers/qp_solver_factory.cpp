#include "solvers/qp_solver_factory.hpp"

#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "solvers/active_set_solver.hpp"
#include "solvers/certified_solver.hpp"
#include "solvers/ipopt_solver.hpp"

namespace mpm {
namespace {

struct BackEnd {
  const char* name;
  std::unique_ptr<QpSolver> (*make)(std::shared_ptr<const QpStructure>);
};

constexpr std::array<BackEnd, 4> kBackEnds{{
    {"auto",
     [](std::shared_ptr<const QpStructure> structure) -> std::unique_ptr<QpSolver> {
       return std::make_unique<CertifiedSolver>(std::move(structure));
     }},
    {"active-set",
     [](std::shared_ptr<const QpStructure> structure) -> std::unique_ptr<QpSolver> {
       return std::make_unique<ActiveSetSolver>(std::move(structure), ActiveSetOptions{});
     }},
    {"ipopt",
     [](std::shared_ptr<const QpStructure> structure) -> std::unique_ptr<QpSolver> {
       return std::make_unique<IpoptSolver>(std::move(structure), IpoptOptions{});
     }},
    {"ipopt-full",
     [](std::shared_ptr<const QpStructure> structure) -> std::unique_ptr<QpSolver> {
       return std::make_unique<IpoptSolver>(std::move(structure), IpoptOptions{.working_set = false});
     }},
}};

}  // namespace

QpSolverFactory qp_solver_factory(const std::string& name) {
  for (const BackEnd& back_end : kBackEnds)
    if (name == back_end.name)
      return back_end.make;
  throw InputError("solver", fmt::format("\"{}\"", name),
                   fmt::format("{}", fmt::join(qp_solver_names(), ", ")));
}

std::vector<std::string> qp_solver_names() {
  std::vector<std::string> names;
  for (const BackEnd& back_end : kBackEnds)
    names.emplace_back(back_end.name);
  return names;
}

}  // namespace mpm
