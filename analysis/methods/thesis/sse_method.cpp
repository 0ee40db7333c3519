#include <cmath>
#include <memory>

#include "analysis/indicators/simulation_error.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct SseOptions {
  double threshold =
      1.5;  ///< a CV with a mean squared error above this multiple of the benchmark's is flagged

  bool operator==(const SseOptions&) const = default;
};

OptionKeys keys(SseOptions& options) {
  return {key::number(
      "threshold", options.threshold, NumberRule::positive(),
      "a CV is flagged when its mean squared simulation error is above this multiple of the one in the "
      "benchmark. The thesis has no threshold. The ratio of white noise over 400 samples scatters by 0.1 "
      "around 1, so chance seldom exceeds 1.5, and errors of 0.7 standard deviations of the noise are seen")};
}

/// The measured CVs, with y_sim where a sample is missing, so that the error there is 0.
Eigen::MatrixXd without_gaps(const AssessedLoop& loop) {
  return loop.y.array().isNaN().select(loop.y_sim, loop.y);
}

/// Mean squares of y - y_sim over the samples that are there; 0 for a model that is exact up to the rounding
/// of y. `y` is without_gaps(), `errors` are its simulation_errors().
Eigen::VectorXd mean_squared_errors(const AssessedLoop& loop, const Eigen::MatrixXd& y,
                                    const Eigen::VectorXd& errors) {
  if (!errors.allFinite())
    throw InputError("simulation errors", "a value that is not finite", "finite values only");
  const Eigen::VectorX<Eigen::Index> missing = loop.y.array().isNaN().rowwise().count().matrix();
  Eigen::VectorXd squares = errors.cwiseAbs2();
  for (Eigen::Index cv = 0; cv < squares.size(); ++cv) {
    if (missing(cv) == loop.samples())
      throw InputError("record of a CV", "no sample at all", "one or more");
    squares(cv) /= static_cast<double>(loop.samples() - missing(cv));
    if (squares(cv) <= variance_floor(y.row(cv).transpose()))
      squares(cv) = 0.0;
  }
  return squares;
}

Eigen::VectorXd squares_of(const AssessedLoop& loop) {
  const Eigen::MatrixXd y = without_gaps(loop);
  return mean_squared_errors(loop, y, simulation_errors(y, loop.y_sim));
}

/// A monitor of the prediction error. It does not ask whether the error reaches the control.
class SimulationErrorMonitor final : public AssessmentMethod {
 public:
  /// A benchmark exists, because the method requires one.
  explicit SimulationErrorMonitor(const AssessmentContext& context)
      : threshold_(context.study.assessment.of<SseOptions>().threshold),
        benchmark_(squares_of(*context.benchmark)) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd y = without_gaps(loop);
    const Eigen::VectorXd sse = simulation_errors(y, loop.y_sim);
    const Eigen::VectorXd squares = mean_squared_errors(loop, y, sse);
    Assessment assessment;
    assessment.numbers.push_back({"tsse", sse.sum()});
    for (Eigen::Index cv = 0; cv < squares.size(); ++cv) {
      const bool exact = squares(cv) == 0.0 && benchmark_(cv) == 0.0;
      const double ratio = exact ? 1.0 : variance_ratio(squares(cv), benchmark_(cv));
      const bool flagged = ratio > threshold_;
      assessment.cvs.push_back({flagged, ratio});
      assessment.flagged = assessment.flagged || flagged;
      assessment.score = std::fmax(assessment.score, ratio);
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
  return {{.name = "sse",
           .title = "simulation errors (SSE)",
           .verdict = "the mean squared simulation error of some CV is above that of the benchmark",
           .requirements = {.benchmark = true, .complete_record = false},
           .locates_cvs = true,
           .information = ModelInformation::shown,
           .numbers = {{"tsse", NumberScope::loop, "sum of the SSE of all CVs (6.21)"},
                       {"sse", NumberScope::cv, "norm of y - y_sim (4.17)"},
                       {"ratio", NumberScope::cv,
                        "mean square of y - y_sim over that of the benchmark; 1 for the same errors"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<SimulationErrorMonitor>(context); },
          option_table<SseOptions>(keys, "options of the monitor of the simulation errors")};
}

}  // namespace mpm
