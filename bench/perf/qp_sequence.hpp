#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {

/// The quadratic programs that one controller met in one closed loop, in their order.
struct QpSequence {
  std::string problem;    ///< "moves" (6.20) or "targets" (6.19)
  std::string slack;      ///< "per-sample" or "per-cv", the slack form of the controller
  std::string loop;       ///< the loop that it was recorded in, see recorded_sequences()
  std::string loop_text;  ///< events of that loop, one line for people
  std::shared_ptr<const QpStructure> structure;
  std::vector<QpData> data;  ///< one a sample

  /// "moves/per-sample/quiet"
  std::string name() const;
  /// Samples `first` to `first + count - 1`, or as many of them as there are.
  QpSequence part(std::size_t first, std::size_t count) const;
};

/// Runs closed loops of the study with the active-set back end and keeps what it was asked to solve: moves
/// and targets, both slack forms, and three loops,
///
/// | loop    | what happens                                                                  |
/// |---------|-------------------------------------------------------------------------------|
/// | quiet   | the basis case: noise and the steps of the measured disturbances              |
/// | mpm     | the mismatch of chapter6 that moves the variances most                        |
/// | ud      | the unmeasured disturbance of chapter6 that costs the solver most iterations  |
///
/// A loop that ends as infeasible is kept up to there; the last program of it is the infeasible one.
/// Throws InputError when the study has no such experiments.
std::vector<QpSequence> recorded_sequences(const Study& study);

/// The draw of one of these loops. Throws InputError for another name.
ExperimentDraw recorded_draw(const Study& study, const std::string& loop);

}  // namespace mpm
