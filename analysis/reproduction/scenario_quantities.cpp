#include "analysis/reproduction/scenario_quantities.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/indicators/simulation_error.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kNone = kNaN;

QuantityScope table_scope(NumberScope scope) {
  switch (scope) {
    case NumberScope::loop:
      return QuantityScope::loop;
    case NumberScope::cv:
      return QuantityScope::cv;
    case NumberScope::channel:
    case NumberScope::cv_lag:  // no method in a table has such numbers
    case NumberScope::window:
      break;
  }
  return QuantityScope::channel;
}

void add_method_quantities(const AssessmentMethodInfo& method, std::vector<TableQuantity>& quantities) {
  quantities.push_back({method.name + ".loop_flagged", QuantityScope::loop});
  if (method.locates_cvs)
    quantities.push_back({method.name + ".flagged", QuantityScope::cv});
  if (method.names_channels)
    quantities.push_back({method.name + ".channel_flagged", QuantityScope::channel});
  for (const AssessmentNumberInfo& number : method.numbers)
    quantities.push_back({method.name + "." + number.name, table_scope(number.scope)});
}

std::vector<TableQuantity> all_quantities() {
  std::vector<TableQuantity> quantities{{"ivar"},
                                        {"ivar_diag"},
                                        {"ivar_basis"},
                                        {"sse"},
                                        {"squared_error"},
                                        {"sqr"},
                                        {"rga_diagonal"},
                                        {"rpn_frequency", QuantityScope::loop},
                                        {"rpn_lowest_peak", QuantityScope::loop},
                                        {"rpn_maximum", QuantityScope::loop}};
  for (const Row<DistributionIndicators>& row : distribution_rows())
    quantities.push_back({row.text.name});
  for (const AssessmentMethodInfo& method : shipped_methods().methods())
    add_method_quantities(method, quantities);
  return quantities;
}

void refuse_unknown(const std::string& name) {
  const std::vector<TableQuantity>& known = ScenarioQuantities::known();
  if (std::any_of(known.begin(), known.end(), [&](const TableQuantity& each) { return each.name == name; }))
    return;
  std::vector<std::string> names;
  for (const TableQuantity& quantity : known)
    names.push_back(quantity.name);
  throw InputError("quantity", fmt::format("'{}'", name), fmt::format("{}", fmt::join(names, ", ")));
}

double cv_flag(const Assessment& assessment, Eigen::Index cv) {
  if (assessment.cvs.empty())
    return kNone;
  const std::optional<bool> flagged = assessment.cvs[static_cast<std::size_t>(cv)].flagged;
  return flagged ? static_cast<double>(*flagged) : kNone;
}

}  // namespace

ScenarioQuantities::ScenarioQuantities(const Study& study, const BasisCase& basis, const ExperimentDraw& draw,
                                       const QpSolverFactory& factory, std::optional<AssessedLoop> benchmark)
    : loop_(simulate_experiment(study, draw, factory)),
      context_{study, basis, factory, std::move(benchmark)},
      chain_(study) {
  if (loop_.status != ControlStatus::ok)
    return;
  nominal_ = NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(loop_);
  diagnosis_ = chain_.diagnose(loop_.y, nominal_);
  by_cv_["ivar"] = diagnosis_.ivar;
  by_cv_["ivar_diag"] = diagnosis_.ivar_diag;
  by_cv_["ivar_basis"] = basis_variance_indices(study, loop_.y, basis.trajectory.y);
  by_cv_["sse"] = simulation_errors(loop_.y, nominal_.y_sim);
  by_cv_["squared_error"] = by_cv_["sse"].cwiseAbs2();
  by_cv_["sqr"] = (basis.trajectory.y - nominal_.y0).cwiseAbs().rowwise().sum();
}

double ScenarioQuantities::value(const std::string& name, Eigen::Index cv, Eigen::Index mv) {
  refuse_unknown(name);
  if (loop_.status != ControlStatus::ok)
    return kNone;
  if (const auto found = by_cv_.find(name); found != by_cv_.end())
    return found->second(cv);
  if (const std::size_t dot = name.find('.'); dot != std::string::npos)
    return method_value(name.substr(0, dot), std::string_view(name).substr(dot + 1), cv, mv);
  if (name == "rpn_frequency")
    return interaction().rpn_frequency;
  if (name == "rpn_lowest_peak")
    return interaction().peaks.empty() ? kNone : interaction().peaks.front().frequency;
  if (name == "rpn_maximum")
    return interaction().rpn_maximum;
  if (name == "rga_diagonal")
    return relative_gain(cv);
  for (const Row<DistributionIndicators>& row : distribution_rows())
    if (row.text.name == name)
      return numbers_of(row, cvs()[static_cast<std::size_t>(cv)].distribution).front();
  return kNone;
}

const std::vector<TableQuantity>& ScenarioQuantities::known() {
  static const std::vector<TableQuantity> quantities = all_quantities();
  return quantities;
}

const std::vector<CvDiagnosis>& ScenarioQuantities::cvs() {
  if (diagnosis_.cvs.empty())
    diagnosis_.cvs = chain_.diagnose_each(loop_.y, nominal_, diagnosis_.ivar_diag);
  return diagnosis_.cvs;
}

const LoopInteraction& ScenarioQuantities::interaction() {
  if (!interaction_)
    interaction_ = loop_interaction(context_.study, context_.basis.point, context_.basis.sensitivity);
  return *interaction_;
}

double ScenarioQuantities::relative_gain(Eigen::Index cv) {
  const LoopInteraction& of_study = interaction();
  const auto found = std::find(of_study.cvs.begin(), of_study.cvs.end(), cv);
  if (of_study.mvs.empty() || found == of_study.cvs.end())
    return kNone;
  const Eigen::Index at = found - of_study.cvs.begin();
  return of_study.relative_gain_at_maximum(at, at);
}

const Assessment& ScenarioQuantities::assessment(const std::string& method) {
  const auto found = assessments_.find(method);
  if (found != assessments_.end())
    return found->second;
  if (!assessed_)
    assessed_ = assessed_loop(context_.study, context_.basis.point, loop_);
  return assessments_.emplace(method, Assessor(assessment_method(method), context_).assess(*assessed_))
      .first->second;
}

double ScenarioQuantities::method_value(const std::string& method, std::string_view name, Eigen::Index cv,
                                        Eigen::Index mv) {
  const Assessment& of_loop = assessment(method);
  if (of_loop.status != AssessmentStatus::ok)
    return kNone;
  if (name == "loop_flagged")
    return of_loop.flagged ? 1.0 : 0.0;
  if (name == "flagged")
    return cv_flag(of_loop, cv);
  if (name == "channel_flagged") {
    const auto& channels = of_loop.flagged_channels;
    return std::find(channels.begin(), channels.end(), Channel{cv, mv}) != channels.end() ? 1.0 : 0.0;
  }
  return of_loop.number(name, cv, mv);
}

}  // namespace mpm
