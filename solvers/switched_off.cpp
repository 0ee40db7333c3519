#include "solvers/switched_off.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {

SwitchedOff SwitchedOff::none(Eigen::Index cv_count, Eigen::Index mv_count) {
  return {Eigen::VectorXd::Constant(mv_count, kNaN),
          Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(cv_count, false)};
}

void SwitchedOff::hold(Eigen::Ref<Eigen::VectorXd> u) const {
  for (Eigen::Index mv = 0; mv < position.size(); ++mv)
    if (has_mv(mv))
      u(mv) = position(mv);
}

Limits SwitchedOff::opened(Limits limits) const {
  for (Eigen::Index cv = 0; cv < cvs.size(); ++cv)
    if (cvs(cv)) {
      limits.lower(cv) = -kInfinity;
      limits.upper(cv) = kInfinity;
    }
  return limits;
}

void SwitchedOff::validate(Eigen::Index cv_count, Eigen::Index mv_count) const {
  if (position.size() != mv_count || cvs.size() != cv_count)
    throw InputError("variables that are off", fmt::format("{} MVs and {} CVs", position.size(), cvs.size()),
                     fmt::format("{} and {}", mv_count, cv_count));
  if (position.array().isInf().any())
    throw InputError("position of an MV that is off", "an infinite number", "a finite one");
}

}  // namespace mpm
