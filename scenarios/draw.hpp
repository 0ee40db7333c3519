#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "plants/transfer_matrix.hpp"
#include "scenarios/study.hpp"

namespace mpm {

/// A model-plant mismatch: one parameter of the channel (cv, mv) of the plant differs from the model.
struct Mismatch {
  Eigen::Index cv;
  Eigen::Index mv;
  MismatchParameter parameter;
  double value;  ///< factor of gain or time constant; shift of the dead time in the plant's time unit
};

/// An unmeasured disturbance y_d = gain / (time_constant s + 1) v added to one CV.
struct Disturbance {
  Eigen::Index cv;
  double gain;           ///< CV unit per unit of v
  double time_constant;  ///< time unit of the plant
};

/// What one experiment does to the loop.
struct ExperimentDraw {
  std::int64_t index = 0;
  ExperimentKind kind = ExperimentKind::none;
  std::optional<Mismatch> mismatch;
  std::optional<Disturbance> disturbance;

  /// The CV that is affected, -1 for the basis case.
  Eigen::Index true_cv() const;
  /// The same experiment with the mismatch alone, and with the disturbance alone.
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

/// Experiment `index` of the study: a pure function of (study, seed, index). In an experiment with mismatch
/// and disturbance both are on the same CV, as (6.23) needs. Throws InputError for a negative index.
ExperimentDraw draw_experiment(const Study& study, std::int64_t index);

/// The basis case: nothing is wrong.
ExperimentDraw basis_draw();

/// The plant that has this mismatch where the model is `model`.
TransferMatrix with_mismatch(const TransferMatrix& model, const Mismatch& mismatch);

}  // namespace mpm
