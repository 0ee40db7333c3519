#include "analysis/methods/ours/learnt_context.hpp"

#include <cstdint>
#include <utility>

#include "base/error.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/historian.hpp"

namespace mpm {
namespace {

/// Samples of a CV, a round number: fewer hardly tell the noise from a dozen errors.
constexpr Eigen::Index kFewestLearnt = 30;

/// Does it have enough samples, and every input?
bool learns_from(const AssessedLoop& benchmark) {
  return model_inputs(benchmark.from_start()).allFinite() &&
         ((!benchmark.y.array().isNaN()).rowwise().count() >= kFewestLearnt).all();
}

}  // namespace

void learn_model(const AssessedLoop& benchmark, AssessmentContext& context) {
  const AssessmentOptions& options = context.study.assessment;
  const bool learns = options.model == AssessmentModel::automatic
                          ? context.study.world.has_value()
                          : options.model == AssessmentModel::benchmark;
  if (!learns || !learns_from(benchmark) || out_of_proportion(context.study, benchmark))
    return;
  try {
    context.correction = std::make_shared<const LearntModel>(context.study, context.basis.point.u, benchmark,
                                                             options.model_error, options.bias);
  } catch (const InputError& error) {
    context.not_learnt = error.what();
  }
}

std::shared_ptr<const LearntModel> learnt_model(const AssessmentContext& context) {
  return std::dynamic_pointer_cast<const LearntModel>(context.correction);
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
