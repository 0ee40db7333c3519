#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/fault.hpp"
#include "scenarios/study.hpp"

namespace mpm {

/// A CV that an experiment affects, and by what.
struct AffectedCv {
  Eigen::Index cv;
  FaultSource by;  ///< mpm, ud, or mpm_ud for both
};

/// What one experiment does to the loop: drawn at random, with at most one fault of either sort or a change
/// of the tuning, or a named scenario of the study.
struct ExperimentDraw {
  std::int64_t index = 0;
  ExperimentKind kind = ExperimentKind::healthy;
  std::vector<Mismatch> mismatches;
  std::vector<Disturbance> disturbances;
  bool named = false;  ///< the scenario number `index` of the study
  /// The CVs that a diagnosis should find, when the study says it; otherwise those with a fault.
  std::optional<std::vector<Eigen::Index>> affected_cvs = {};
  std::vector<ParameterChange> parameters = {};  ///< of a nonlinear plant; a mismatch, too
  std::optional<TuningChange> tuning = {};       ///< of the controller; no fault of model or plant

  /// The CVs that are affected, in their order. A CV that has no fault of its own is affected by what is
  /// wrong in the experiment.
  std::vector<AffectedCv> affected() const;
  /// The CV that is affected; -1 when it is none, or more than one.
  Eigen::Index true_cv() const;
  /// The same experiment with the mismatches alone, and with the disturbances alone.
  ExperimentDraw mismatch_alone() const;
  ExperimentDraw disturbance_alone() const;
};

/// The index under which the basis case draws its noise: no experiment of a study has it.
inline constexpr std::int64_t kBasisIndex = -1;

/// The order of kinds over the experiments of a study.
///
/// The kinds are interleaved so that any first N experiments keep the proportions of the whole study as well
/// as whole numbers can: a subset of a study is its beginning, and a longer run continues it.
class KindSequence {
 public:
  /// Throws InputError when all counts are zero or one is negative.
  explicit KindSequence(const ExperimentCounts& counts);

  ExperimentKind operator[](std::int64_t index) const;

 private:
  std::vector<ExperimentKind> period_;
};

/// Experiment `index` of the study: a pure function of (study, seed, index). In a random experiment with
/// mismatch and disturbance both are on the same CV, as (6.23) needs. Throws InputError for a negative index,
/// and for one that is no scenario of a study of named scenarios.
ExperimentDraw draw_experiment(const Study& study, std::int64_t index);

/// The basis case: nothing is wrong.
ExperimentDraw basis_draw();

/// The study with the controller that runs in the experiment: `study` itself unless the draw changes its
/// tuning. simulate_experiment() does this by itself; to pass it the result would change the tuning twice.
/// Throws InputError for a weight that the controller has not.
Study with_tuning(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
