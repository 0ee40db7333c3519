#include <memory>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/counterfactual_loop.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

OptionKeys keys(CounterfactualOptions& options) {
  return {key::choice("noise", options.noise, {"difference", "positive", "none"},
                      "v of Ivar = var y / (var y0 + v), the variance that noise adds. `\"difference\"`: var "
                      "y - var y0 of the benchmark, of either sign, since noise also keeps CVs off their "
                      "limits. `\"positive\"`: the same, but at least 0. `\"none\"`: 0")};
}

/// Finds the impact by CounterfactualLoop and, in a flagged loop, that on each CV.
class Counterfactual final : public AssessmentMethod {
 public:
  explicit Counterfactual(const AssessmentContext& context)
      : nominal_(CounterfactualLoop::of_context(context)) {}

  Assessment assess(const AssessedLoop& loop) override {
    const CounterfactualLoop::Impact impact = nominal_->impact(loop);
    Assessment assessment = impact.assessment;
    if (assessment.status != AssessmentStatus::ok)
      return assessment;
    if (!assessment.flagged) {
      assessment.cvs.resize(static_cast<std::size_t>(loop.y.rows()));
      return assessment;
    }
    const Eigen::VectorXd ivar_diag = nominal_->ivar_diag(loop, impact);
    assessment.cvs = nominal_->located(ivar_diag, impact);
    for (Eigen::Index cv = 0; cv < ivar_diag.size(); ++cv)
      assessment.numbers.push_back({"ivar_diag", ivar_diag(cv), cv});
    return assessment;
  }

 private:
  std::shared_ptr<CounterfactualLoop> nominal_;
};

}  // namespace

AssessmentMethodInfo counterfactual_method() {
  return {{.name = "counterfactual",
           .title = "counterfactual nominal output",
           .verdict = "a modelling error has an impact: Ivar of some CV, relative to the simulated nominal "
                      "loop, lies outside the band of impact",
           .requirements = {.nominal_loop = true, .complete_record = false},
           .locates_cvs = true,
           .information = ModelInformation::learnt,
           .numbers = {{"ivar", NumberScope::cv,
                        "var y / (var y0 + v), y0 of the simulated nominal loop, v of noise", "1",
                        NumberFinding::regression},
                       {"ivar_diag", NumberScope::cv, "var y / (var y0_diag + v), of flagged loops"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<Counterfactual>(context); },
          option_table<CounterfactualOptions>(keys, "options of the simulated nominal loop")};
}

}  // namespace mpm
