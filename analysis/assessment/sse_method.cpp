#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/assessment/methods.hpp"
#include "analysis/simulation_error.hpp"
#include "analysis/variance.hpp"

namespace mpm {
namespace {

/// SSE_i of (4.17) divided by the square root of the length, which periods of different lengths share.
Eigen::VectorXd root_mean_square_errors(const AssessedLoop& loop) {
  return simulation_errors(loop.y, loop.y_sim) / std::sqrt(static_cast<double>(loop.samples()));
}

/// What a monitor of the prediction error says, which does not ask whether the error reaches the control.
class SimulationErrorMonitor final : public AssessmentMethod {
 public:
  /// The requirements of the method say that there is a benchmark.
  explicit SimulationErrorMonitor(const AssessmentContext& context)
      : threshold_(context.study.assessment.sse.threshold),
        benchmark_(root_mean_square_errors(*context.benchmark)) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::VectorXd sse = simulation_errors(loop.y, loop.y_sim);
    const Eigen::VectorXd errors = root_mean_square_errors(loop);
    Assessment assessment;
    assessment.score = 0.0;
    assessment.numbers.push_back({"tsse", sse.sum()});
    for (Eigen::Index cv = 0; cv < errors.size(); ++cv) {
      const double ratio = variance_ratio(errors(cv) * errors(cv), benchmark_(cv) * benchmark_(cv));
      const bool flagged = ratio > threshold_;
      assessment.cvs.push_back({flagged, ratio});
      assessment.flagged = assessment.flagged || flagged;
      assessment.score = std::max(assessment.score, ratio);
      assessment.numbers.push_back({"sse", sse(cv), cv});
      assessment.numbers.push_back({"ratio", ratio, cv});
    }
    return assessment;
  }

 private:
  double threshold_;
  Eigen::VectorXd benchmark_;
};

}  // namespace

AssessmentMethodInfo sse_method() {
  return {.name = "sse",
          .title = "simulation errors (SSE)",
          .verdict = "the mean squared simulation error of some CV is above that of the benchmark",
          .requirements = {.benchmark = true},
          .locates_cvs = true,
          .numbers = {{"tsse", NumberScope::loop, "sum of the SSE of all CVs (6.21)"},
                      {"sse", NumberScope::cv, "norm of y - y_sim (4.17)"},
                      {"ratio", NumberScope::cv,
                       "mean square of y - y_sim over that of the benchmark; 1 for the same errors"}},
          .make = [](const AssessmentContext& context) {
            return std::make_unique<SimulationErrorMonitor>(context);
          }};
}

}  // namespace mpm
