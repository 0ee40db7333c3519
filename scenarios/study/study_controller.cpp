#include "scenarios/study/study_controller.hpp"

#include "solvers/mpc.hpp"

namespace mpm {

std::unique_ptr<Controller> controller_of(const Study& study, const MpcOptions& tuning,
                                          const QpSolverFactory& factory) {
  if (study.controller_program)
    return study.controller_program->controller(study.plant, tuning, study.sensitivity.samples, factory);
  return std::make_unique<Mpc>(study.plant.G, study.mv_count(), tuning, factory);
}

bool runs_on_model(const Study& study) {
  return !study.controller_program || study.controller_program->runs_on_model();
}

}  // namespace mpm
