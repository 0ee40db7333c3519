#include "analysis/experiment/repaired_model.hpp"

#include <memory>

#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/world.hpp"

namespace mpm {

TransferMatrix true_plant(const Study& study, const ExperimentDraw& draw) {
  return with_world_mismatches(world_plant(study, draw_world(study, draw.world)), draw.mismatches);
}

Trajectory loop_with_model(const Study& study, const TransferMatrix& model, ExperimentDraw draw,
                           const QpSolverFactory& factory) {
  if (study.simulation.excitation == SignalSequence::each)
    return loop_with_model(with_excitation(study, draw.index), model, draw, factory);
  draw.onset = {};
  const std::unique_ptr<Plant> plant = experiment_plant(study, draw);
  Study repaired = with_tuning(study, draw);
  repaired.plant.G = model;
  return run_closed_loop(repaired, *plant, experiment_signals(study, draw), factory);
}

}  // namespace mpm
