#pragma once

#include <cmath>

#include <Eigen/Core>

#include "solvers/mpc_options.hpp"

namespace mpm {

/// The variables of a controller that operators have switched off.
///
/// | symbol | member   | shape | meaning                                                              |
/// |--------|----------|-------|----------------------------------------------------------------------|
/// |        | position | nu    | where an operator holds the MV; NaN: the controller moves it         |
/// |        | cvs      | ny    | the CV has no setpoint and no limit, but counts in the output bias   |
struct SwitchedOff {
  Eigen::VectorXd position;
  Eigen::Array<bool, Eigen::Dynamic, 1> cvs;

  static SwitchedOff none(Eigen::Index cv_count, Eigen::Index mv_count);

  bool has_mv(Eigen::Index mv) const { return !std::isnan(position(mv)); }
  bool has_any() const { return cvs.any() || !position.array().isNaN().all(); }
  /// Sets the MVs in `u` (nu) that are off to the positions where they are held.
  void hold(Eigen::Ref<Eigen::VectorXd> u) const;
  /// Returns `limits` of the CVs (ny) without those of CVs that are off.
  Limits opened(Limits limits) const;
  /// Throws InputError for other sizes, and for an infinite position.
  void validate(Eigen::Index cv_count, Eigen::Index mv_count) const;
};

}  // namespace mpm
