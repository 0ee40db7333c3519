#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "scenarios/study/study.hpp"
#include "solvers/switched_off.hpp"

namespace mpm {

/// Is this variable off at sample k?
bool is_off(const Study& study, VariableSort sort, Eigen::Index variable, Eigen::Index k);

/// The variables that are off while a loop runs: `[[simulation.off]]` of the study.
class OffSchedule {
 public:
  /// `study` must outlive it.
  explicit OffSchedule(const Study& study);

  /// Goes on to sample k; calls must have k = 0, 1, ... in turn. `u` (nu) are the MVs that act until then: an
  /// MV whose table has no level keeps its value. Returns whether the controller must be told. Allocates
  /// nothing.
  bool go_on(Eigen::Index k, const Eigen::Ref<const Eigen::VectorXd>& u);

  /// The variables that are off at this sample.
  const SwitchedOff& off() const { return off_; }

 private:
  const std::vector<OffSpell>& spells_;
  std::size_t next_ = 0;                       ///< the first spell that has not begun
  std::vector<Eigen::Index> mv_end_, cv_end_;  ///< sample at which a variable comes back; 0: it is on
  SwitchedOff off_;
};

}  // namespace mpm
