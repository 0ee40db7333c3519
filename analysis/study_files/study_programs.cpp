#include "analysis/study_files/study_programs.hpp"

#include "base/system/program_trust.hpp"

namespace mpm {

void trust_programs_of(const Study& study) {
  if (study.nonlinear && study.nonlinear->model.foreign) {
    const ForeignModel& plant = *study.nonlinear->model.foreign;
    if (plant.file().empty())
      trust_program(plant.command());
    else
      trust_fmu(plant.file());
  }
  if (study.controller_program)
    trust_program(study.controller_program->command());
}

}  // namespace mpm
