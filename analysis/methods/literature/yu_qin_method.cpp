#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/variability_comparison.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "base/error.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct YuQinOptions {
  VariabilityOptions comparison;
  int first_sample = 0;  ///< start of both periods; leaves out the start of a loop

  bool operator==(const YuQinOptions&) const = default;
};

OptionKeys keys(YuQinOptions& options) {
  return {
      key::number("confidence", options.comparison.confidence, NumberRule::inside(0, 1),
                  "confidence of the limits of eigenvalues and angles (2.4.1)"),
      key::whole("largest_lag", options.comparison.largest_lag, 0, 1'000'000,
                 "largest lag of the sum over squared autocorrelations (2.9), samples; 0: all lags, "
                 "because the thesis prints the sum in this form. This overstates the sum, so changes "
                 "are called significant too rarely (`docs/methods.md`)"),
      key::choice("limits", options.comparison.limits, {"published", "largest-root"},
                  "limits of the ratios of variances. `\"published\"`: (2.10), (2.11), for a direction "
                  "chosen beforehand, although the data choose it. `\"largest-root\"`: for all directions "
                  "at once (`docs/methods_literature.md`); the method `yu-qin:largest-root` has them in any "
                  "case"),
      key::whole("first_sample", options.first_sample, 0, 1'000'000,
                 "sample at which the compared periods begin. 0: the whole record, as for every other "
                 "method. A loop whose plant differs from its model starts with a transient, which "
                 "otherwise dominates the variances")};
}

/// Control errors of `cvs`, one row each, from sample `first` on.
Eigen::MatrixXd control_errors(const AssessedLoop& loop, const std::vector<Eigen::Index>& cvs,
                               Eigen::Index first) {
  const auto samples = Eigen::seq(first, loop.samples() - 1);
  return loop.y(cvs, samples) - loop.y_set(cvs, samples);
}

std::vector<Eigen::Index> common_setpoint_cvs(const AssessedLoop& a, const AssessedLoop& b) {
  const std::vector<Eigen::Index> of_a = a.setpoint_cvs();
  const std::vector<Eigen::Index> of_b = b.setpoint_cvs();
  std::vector<Eigen::Index> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  return common;
}

/// If every direction is worse, every cosine is 1. The worst direction then decides which CV comes first.
constexpr double kTieBreak = 1e-6;

class YuQin final : public AssessmentMethod {
 public:
  /// A benchmark exists, because the method requires one.
  YuQin(const YuQinOptions& options, const AssessmentContext& context)
      : options_(options.comparison), first_(options.first_sample), benchmark_(*context.benchmark) {
    options_.validate();
  }

  Assessment assess(const AssessedLoop& loop) override {
    const std::vector<Eigen::Index> cvs = common_setpoint_cvs(benchmark_, loop);
    if (cvs.empty())
      return Assessment::not_applicable("no CV has a setpoint in this loop and in the benchmark period");
    if (first_ + 2 > loop.samples())
      return Assessment::not_applicable("the record ends before the first sample to be compared");
    if (first_ + 2 > benchmark_.samples())
      return Assessment::not_applicable("the benchmark ends before the first sample to be compared");
    const VariabilityComparison found = compare_variability(control_errors(benchmark_, cvs, first_),
                                                            control_errors(loop, cvs, first_), options_);
    if (found.status == VariabilityStatus::singular_benchmark)
      return Assessment::failed("the control errors of the benchmark period are linearly dependent");
    return answer(found, cvs, loop.y.rows());
  }

 private:
  static Assessment answer(const VariabilityComparison& found, const std::vector<Eigen::Index>& cvs,
                           Eigen::Index ny) {
    Assessment assessment;
    assessment.score = 0.0;
    for (const VariabilityDirection& direction : found.directions)
      assessment.score = larger_or_nan(assessment.score, direction.limits.lower);
    assessment.flagged = assessment.score > 1.0;
    assessment.numbers = {{"i_v", found.i_v},
                          {"mu_max", found.directions.front().mu},
                          {"mu_min", found.directions.back().mu},
                          {"beta", found.beta}};
    assessment.cvs.resize(static_cast<std::size_t>(ny));
    for (std::size_t i = 0; i < cvs.size(); ++i) {
      const double worse = found.cos_worse(static_cast<Eigen::Index>(i));
      const double better = found.cos_better(static_cast<Eigen::Index>(i));
      const double nearness = std::abs(found.directions.front().p(static_cast<Eigen::Index>(i)));
      assessment.cvs[static_cast<std::size_t>(cvs[i])] = {worse > found.beta, worse + kTieBreak * nearness};
      assessment.numbers.push_back({"cos_worse", worse, cvs[i]});
      assessment.numbers.push_back({"cos_better", better, cvs[i]});
      assessment.numbers.push_back({"worse", worse > found.beta ? 1.0 : 0.0, cvs[i]});
      assessment.numbers.push_back({"better", better > found.beta ? 1.0 : 0.0, cvs[i]});
    }
    return assessment;
  }

  VariabilityOptions options_;
  Eigen::Index first_;
  const AssessedLoop& benchmark_;
};

/// The method with limits that hold for the directions that the data choose.
std::unique_ptr<AssessmentMethod> with_limits_of_largest_root(const AssessmentContext& context) {
  auto options = context.study.assessment.of<YuQinOptions>();
  options.comparison.limits = VariabilityLimits::largest_root;
  return std::make_unique<YuQin>(options, context);
}

}  // namespace

AssessmentMethodInfo yu_qin_method() {
  return {
      {.name = "yu-qin",
       .title = "Yu and Qin (2008)",
       .verdict = "along some direction the variance of the control errors is above that of the benchmark",
       .requirements = {.setpoints = true, .benchmark = true},
       .locates_cvs = true,
       .information = ModelInformation::unused,
       .numbers = {{"i_v", NumberScope::loop, "det cov e / det cov e of the benchmark (2.7)"},
                   {"mu_max", NumberScope::loop, "largest ratio of variances (2.8)"},
                   {"mu_min", NumberScope::loop, "smallest ratio of variances (2.8)"},
                   {"beta", NumberScope::loop, "limit of the cosines (2.14)"},
                   {"cos_worse", NumberScope::cv, "nearness to the worse directions (2.12)"},
                   {"cos_better", NumberScope::cv, "nearness to the better directions (2.13)"},
                   {"worse", NumberScope::cv, "1 when cos_worse is above beta, 0 when not"},
                   {"better", NumberScope::cv, "1 when cos_better is above beta, 0 when not"}}},
      {},
      [](const AssessmentContext& context) {
        return std::make_unique<YuQin>(context.study.assessment.of<YuQinOptions>(), context);
      },
      option_table<YuQinOptions>(keys, "options of the method of Yu and Qin"),
      // A loop is flagged if the lower of the two limits is above 1, so half of the error probability counts.
      [](const MethodOptions& options) {
        return 0.5 * (1.0 - options.of<YuQinOptions>().comparison.confidence);
      },
      {{"largest-root", "limits of all directions at once", with_limits_of_largest_root}}};
}

}  // namespace mpm
