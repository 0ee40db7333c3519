#include "scenarios/loop/off_schedule.hpp"

#include "base/non_finite.hpp"

namespace mpm {

bool is_off(const Study& study, VariableSort sort, Eigen::Index variable, Eigen::Index k) {
  for (const OffSpell& spell : study.simulation.off) {
    if (spell.sample > k)
      break;
    if (spell.sort == sort && spell.variable == variable && k < spell.end())
      return true;
  }
  return false;
}

OffSchedule::OffSchedule(const Study& study)
    : spells_(study.simulation.off),
      mv_end_(static_cast<std::size_t>(study.mv_count()), 0),
      cv_end_(static_cast<std::size_t>(study.cv_count()), 0),
      off_(SwitchedOff::none(study.cv_count(), study.mv_count())) {}

bool OffSchedule::go_on(Eigen::Index k, const Eigen::Ref<const Eigen::VectorXd>& u) {
  bool changed = false;
  for (std::size_t mv = 0; mv < mv_end_.size(); ++mv)
    if (mv_end_[mv] > 0 && k >= mv_end_[mv]) {
      mv_end_[mv] = 0;
      off_.position(static_cast<Eigen::Index>(mv)) = kNaN;
      changed = true;
    }
  for (std::size_t cv = 0; cv < cv_end_.size(); ++cv)
    if (cv_end_[cv] > 0 && k >= cv_end_[cv]) {
      cv_end_[cv] = 0;
      off_.cvs(static_cast<Eigen::Index>(cv)) = false;
      changed = true;
    }
  for (; next_ < spells_.size() && spells_[next_].sample <= k; ++next_, changed = true) {
    const OffSpell& spell = spells_[next_];
    if (spell.sort == VariableSort::cv) {
      cv_end_[static_cast<std::size_t>(spell.variable)] = spell.end();
      off_.cvs(spell.variable) = true;
    } else {
      mv_end_[static_cast<std::size_t>(spell.variable)] = spell.end();
      off_.position(spell.variable) = spell.level.value_or(u(spell.variable));
    }
  }
  return changed;
}

}  // namespace mpm
