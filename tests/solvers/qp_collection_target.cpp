#include <string>

#include "plants/models/catalogue.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/solvers/p1_controller.hpp"
#include "tests/solvers/qp_collection.hpp"

namespace mpm::samples {

std::vector<NamedQp> target_qps() {
  const MpcOptions options = p1_options();
  auto structure = std::make_shared<QpStructure>();
  structure->hessian.setZero(3, 3);
  structure->rows = benchmark_plant("shell-7x3").G.static_gain().leftCols(3);
  structure->slack_of_row.setLinSpaced(7, 0, 6);
  structure->slack_quadratic.setZero(7);
  structure->slack_linear.setConstant(7, 8000);

  std::vector<NamedQp> qps;
  for (int draw = 0; draw < 8; ++draw) {
    RandomStream random(2015, static_cast<std::uint64_t>(draw), StreamId::excitation);
    // From disturbances that leave room for every limit to some that do not.
    const double size = 0.2 * draw;
    QpData data = QpData::unconstrained(*structure);
    data.gradient = options.mv_cost;
    data.lower = options.mv_hard.lower;
    data.upper = options.mv_hard.upper;
    for (Eigen::Index cv = 0; cv < 7; ++cv) {
      const double y_at_zero = random.uniform(-size, size);
      data.soft_lower(cv) = options.cv_soft.lower(cv) - y_at_zero;
      data.soft_upper(cv) = options.cv_soft.upper(cv) - y_at_zero;
    }
    qps.push_back({"targets of P1 #" + std::to_string(draw), structure, data, QpStatus::solved, {}});
  }
  return qps;
}

}  // namespace mpm::samples
