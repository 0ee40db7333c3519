#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "analysis/basis/basis_case.hpp"
#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Whether one linear S0 can describe a loop: it can as long as the loop is stable and works with the
/// constraints of the basis case.
///
/// | member          | meaning                                                                          |
/// |-----------------|----------------------------------------------------------------------------------|
/// | spectral_radius | of the loop with the active set of the basis case (LoopStability)                |
/// | other_cv_active | share of the samples in which a CV that the basis case has inside its range is   |
/// |                 | at a soft limit or over it                                                       |
/// | mv_at_limit     | share of the samples in which an MV that the basis case has free is at a hard    |
/// |                 | limit or switched off                                                            |
///
/// Each is NaN when it is not known.
struct LoopConditions {
  double spectral_radius = kNaN;
  double other_cv_active = kNaN;
  double mv_at_limit = kNaN;

  /// None when it is not known.
  std::optional<bool> stable() const {
    return spectral_radius == spectral_radius ? std::optional(spectral_radius < 1.0) : std::nullopt;
  }
};

/// Above this share of the samples a constraint counts as a reason why a linear S0 fails. The
/// basis case of chapter6 has a CV at another limit in 6.5 % of its samples, from noise and steps alone.
inline constexpr double kOftenActive = 0.1;

/// Why one linear S0 does not describe a loop; the first that holds.
enum class NonlinearCause : std::int8_t { none = 0, unstable = 1, other_cv_active = 2, mv_at_limit = 3 };

inline constexpr std::array kNonlinearCauses{NonlinearCause::unstable, NonlinearCause::other_cv_active,
                                             NonlinearCause::mv_at_limit, NonlinearCause::none};

template <>
inline constexpr auto kWords<NonlinearCause> = word_list("none", "unstable", "other_cv_active",
                                                         "mv_at_limit");
/// "unstable loop", "another CV at a limit", "an MV at a limit", "none of these"
std::string_view title_of(NonlinearCause cause);

/// Does the cause hold for the loop, whether others hold or not? `none`: no other cause holds. A condition
/// that is not known is no cause.
bool has_cause(const LoopConditions& conditions, NonlinearCause cause);
/// The first cause of the loop, in the order of kNonlinearCauses.
NonlinearCause first_cause(const LoopConditions& conditions);

/// The shares of a loop over the samples that it ran; its radius is left unknown. Nothing is known for a
/// controller without an active set (NominalSensitivity::is_known).
LoopConditions loop_conditions(const Study& study, const BasisCase& basis, const Trajectory& loop);

}  // namespace mpm
