#include "analysis/experiment/loop_conditions.hpp"

#include <algorithm>
#include <vector>

#include "analysis/sensitivity/active_limit.hpp"
#include "base/enum_words.hpp"
#include "scenarios/loop/off_schedule.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

using Indices = std::vector<Eigen::Index>;

/// The CVs with a soft limit that are not active in the basis case.
Indices cvs_inside(const Study& study, const OperatingPoint& point) {
  Indices cvs;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (study.controller.has_soft_limit(cv) &&
        std::none_of(point.active.begin(), point.active.end(),
                     [cv](const ActiveConstraint& reference) { return reference.cv == cv; }))
      cvs.push_back(cv);
  return cvs;
}

/// The MVs that are free in the basis case.
Indices free_mvs(const Study& study, const OperatingPoint& point) {
  Indices mvs;
  for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
    if (std::find(point.fixed_mvs.begin(), point.fixed_mvs.end(), mv) == point.fixed_mvs.end())
      mvs.push_back(mv);
  return mvs;
}

/// Share of the samples k of a record in which `reached(k, i)` holds for one of `variables`.
template <class Reached>
double share_of(Eigen::Index samples, const Indices& variables, const Reached& reached) {
  Eigen::Index hits = 0;
  for (Eigen::Index k = 0; k < samples; ++k)
    hits += std::any_of(variables.begin(), variables.end(), [&](Eigen::Index i) { return reached(k, i); })
                ? 1
                : 0;
  return samples > 0 ? static_cast<double>(hits) / static_cast<double>(samples) : kNaN;
}

}  // namespace

std::string_view title_of(NonlinearCause cause) {
  constexpr auto kTitles =
      word_list("none of these", "unstable loop", "another CV at a limit", "an MV at a limit");
  return kTitles.at(static_cast<std::size_t>(cause));
}

bool has_cause(const LoopConditions& conditions, NonlinearCause cause) {
  switch (cause) {
    case NonlinearCause::unstable:
      return conditions.spectral_radius >= 1.0;
    case NonlinearCause::other_cv_active:
      return conditions.other_cv_active > kOftenActive;
    case NonlinearCause::mv_at_limit:
      return conditions.mv_at_limit > kOftenActive;
    case NonlinearCause::none:
      break;
  }
  return first_cause(conditions) == NonlinearCause::none;
}

NonlinearCause first_cause(const LoopConditions& conditions) {
  for (const NonlinearCause cause : kNonlinearCauses)
    if (cause != NonlinearCause::none && has_cause(conditions, cause))
      return cause;
  return NonlinearCause::none;
}

LoopConditions loop_conditions(const Study& study, const BasisCase& basis, const Trajectory& loop) {
  LoopConditions conditions;
  if (!basis.sensitivity.is_known)
    return conditions;
  std::vector<Limits> soft;  // at each sample
  for (Eigen::Index k = 0; k < loop.samples_done; ++k)
    soft.push_back(soft_limits(study, k));
  conditions.other_cv_active =
      share_of(loop.samples_done, cvs_inside(study, basis.point), [&](Eigen::Index k, Eigen::Index cv) {
        const Limits& limits = soft[static_cast<std::size_t>(k)];
        return at_or_below(loop.y(cv, k), limits.lower(cv)) || at_or_above(loop.y(cv, k), limits.upper(cv));
      });
  const Limits& hard = study.controller.mv_hard;
  conditions.mv_at_limit =
      share_of(loop.samples_done, free_mvs(study, basis.point), [&](Eigen::Index k, Eigen::Index mv) {
        return at_or_below(loop.u(mv, k), hard.lower(mv)) || at_or_above(loop.u(mv, k), hard.upper(mv)) ||
               is_off(study, VariableSort::mv, mv, k);
      });
  return conditions;
}

}  // namespace mpm
