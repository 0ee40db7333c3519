#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "scenarios/study/study.hpp"
#include "solvers/switched_off.hpp"

namespace mpm {

/// Is this variable off at sample k?
bool is_off(const Study& study, VariableSort sort, Eigen::Index variable, Eigen::Index k);

/// What is off while a loop runs: `[[simulation.off]]` of the study.
class OffSchedule {
 public:
  /// `study` must outlive it.
  explicit OffSchedule(const Study& study);

  /// Goes on to sample k, which is 0, 1, ... in turn, with the MVs `u` (nu) that act until then: one whose
  /// table has no level stays there. True when the controller must be told. Allocates nothing.
  bool go_on(Eigen::Index k, const Eigen::Ref<const Eigen::VectorXd>& u);

  /// What is off at this sample.
  const SwitchedOff& off() const { return off_; }

 private:
  const std::vector<OffSpell>& spells_;
  std::size_t next_ = 0;                       ///< spell that has not begun
  std::vector<Eigen::Index> mv_end_, cv_end_;  ///< sample at which a variable comes back; 0: it is on
  SwitchedOff off_;
};

}  // namespace mpm
