#include "analysis/methods/ours/learnt_context.hpp"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/nonlinear/foreign_model.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/historian.hpp"

namespace mpm {
namespace {

/// The fewest samples of a CV from which errors are learnt, a round number: fewer hardly tell the noise from
/// a dozen errors.
constexpr Eigen::Index kFewestLearnt = 30;

/// Returns whether the benchmark has enough samples of each CV and every sample of the inputs.
bool learns_from(const AssessedLoop& benchmark) {
  return model_inputs(benchmark.from_start()).allFinite() &&
         ((!benchmark.y.array().isNaN()).rowwise().count() >= kFewestLearnt).all();
}

/// The errors of the model, learnt when they are first asked for, so that methods that do not need them cost
/// nothing.
class LearntWhenAsked final : public ModelCorrection {
 public:
  LearntWhenAsked(const AssessmentContext& context, AssessedLoop benchmark)
      : study_(context.study), initial_u_(context.basis.point.u), benchmark_(std::move(benchmark)) {}

  /// Throws InputError if the likelihood of what the benchmark shows is not a number.
  std::shared_ptr<const LearntModel> model() const {
    if (!model_ && failure_.empty())
      learn();
    if (!model_)
      throw InputError("the benchmark does not show the errors of the model: " + failure_);
    return model_;
  }
  std::shared_ptr<const AssessedLoop> corrected(const AssessedLoop& loop) const override {
    return model()->corrected(loop);
  }

 private:
  void learn() const {
    const AssessmentOptions& options = study_.assessment;
    try {
      model_ = std::make_shared<const LearntModel>(study_, initial_u_, benchmark_, options.model_error,
                                                   options.bias);
    } catch (const InputError& error) {
      failure_ = error.what();
    }
  }

  const Study& study_;
  const Eigen::VectorXd initial_u_;
  const AssessedLoop benchmark_;
  mutable std::shared_ptr<const LearntModel> model_;
  mutable std::string failure_;
};

/// The assumption as far as the study alone tells it; `automatic` if the benchmark decides.
ModelAssumption stated_assumption(const Study& study) {
  if (study.assessment.model != AssessmentModel::automatic)
    return {study.assessment.model, "the study says so"};
  if (study.world)
    return {AssessmentModel::benchmark, "the study has worlds"};
  if (!study.nonlinear && !study.record.moves_rows())
    return {AssessmentModel::nominal, "the plant without a fault is the model"};
  if (const ForeignModel* const foreign = study.nonlinear ? study.nonlinear->model.foreign.get() : nullptr)
    return {AssessmentModel::benchmark, fmt::format("the plant is {}, which no linear model matches exactly",
                                                    foreign->command().empty() ? "an FMU" : "a program")};
  return {AssessmentModel::automatic, ""};
}

}  // namespace

ModelAssumption model_assumption(const AssessmentContext& context) {
  ModelAssumption stated = stated_assumption(context.study);
  if (stated.model != AssessmentModel::automatic)
    return stated;
  const std::shared_ptr<const LearntModel> learnt = learnt_model(context);
  if (!learnt)
    return {AssessmentModel::nominal, "the benchmark does not reject an exact model"};
  return {
      AssessmentModel::benchmark,
      fmt::format("the benchmark rejects an exact model of {}",
                  context.study.plant.cvs[static_cast<std::size_t>(*learnt->rejects_exact_model())].name)};
}

std::string to_string(const ModelAssumption& assumption) {
  return fmt::format("assessment.model: {}, because {}", to_string(assumption.model), assumption.why);
}

void learn_model(const AssessedLoop& benchmark, AssessmentContext& context) {
  const AssessmentModel stated = stated_assumption(context.study).model;
  if (stated == AssessmentModel::nominal || !learns_from(benchmark) ||
      out_of_proportion(context.study, benchmark))
    return;
  auto learnt = std::make_shared<const LearntWhenAsked>(context, benchmark);
  try {
    if (stated == AssessmentModel::benchmark || learnt->model()->rejects_exact_model())
      context.correction = std::move(learnt);
  } catch (const InputError&) {  // what shows no errors does not reject an exact model
  }
}

std::shared_ptr<const LearntModel> learnt_model(const AssessmentContext& context) {
  const auto learnt = std::dynamic_pointer_cast<const LearntWhenAsked>(context.correction);
  return learnt ? learnt->model() : nullptr;
}

AssessmentContext assessment_context(const Study& study, const BasisCase& basis, QpSolverFactory factory) {
  const std::int64_t index = basis_index(basis.world);
  AssessmentContext context{study, basis, std::move(factory),
                            assessed_loop(study, basis.point, recorded(study, index, basis.trajectory))};
  if (study.simulation.excitation == SignalSequence::each)
    context.benchmark_study = std::make_shared<const Study>(with_excitation(study, index));
  learn_model(*context.benchmark, context);
  return context;
}

}  // namespace mpm
