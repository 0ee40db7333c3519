#pragma once

#include <cmath>

#include "analysis/experiment/experiment.hpp"

namespace mpm::testing {

/// An experiment of the chapter 6 study with both indices 1 but for `cv`, which has Ivar 2 and is located.
inline ExperimentRecord made_up_record(std::int64_t index, ExperimentKind kind, Eigen::Index cv,
                                       double i_mpm) {
  ExperimentRecord record;
  record.draw.index = index;
  record.draw.kind = kind;
  if (kind != ExperimentKind::ud)
    record.draw.mismatches = {{cv, 0, MismatchParameter::gain, 0.5}};
  if (kind != ExperimentKind::mpm)
    record.draw.disturbances = {{cv, 1.0, 50.0}};
  record.status = ExperimentStatus::ok;
  Diagnosis& d = record.diagnosis;
  d.ivar = d.ivar_diag = Eigen::VectorXd::Ones(7);
  d.ivar(cv) = d.ivar_diag(cv) = 2.0 + 0.1 * static_cast<double>(index);
  d.ivar_basis = (2.0 * d.ivar.array() + 1.0).matrix();  // an exact line of slope 2
  d.impactful = true;
  d.predicted_cv = cv;
  d.indicator.i_mpm = i_mpm;
  d.predicted_source = i_mpm > 0.1 ? ExperimentKind::mpm : ExperimentKind::ud;
  record.dominance_mpm = kind == ExperimentKind::mpm_ud ? 0.8 : std::nan("");
  return record;
}

}  // namespace mpm::testing
