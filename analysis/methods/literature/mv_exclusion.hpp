#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/enum_words.hpp"

namespace mpm {

/// Whether an MV carries information about its channels.
enum class MvUse : std::int8_t {
  evaluated = 0,
  saturated = 1,       ///< at a limit for too large a share of the record
  standing_still = 2,  ///< without excitation
  dependent = 3,       ///< moves only with the other MVs: no part of its own is left to correlate
};

template <>
inline constexpr auto kWords<MvUse> = word_list("evaluated", "saturated", "standing still", "dependent");

/// Limits of the MVs, one entry for each MV; infinite for no limit.
struct MvLimits {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// Share of samples at which each MV (nu x N, unit of the MV) is at a limit or beyond it (active_limit.hpp).
/// @throws InputError for limits other than one an MV, or a lower limit above the upper one
Eigen::VectorXd saturated_shares(const Eigen::Ref<const Eigen::MatrixXd>& u, const MvLimits& limits);

/// How each MV can be used. Saturated: a share above `largest_share` at a limit. Standing still: a standard
/// deviation of at most `smallest_deviation`, or one that rounding explains (`variance_floor`). Evaluated:
/// all others. u is nu x N.
/// @throws InputError as `saturated_shares`, and for fewer than 2 samples
std::vector<MvUse> mv_uses(const Eigen::Ref<const Eigen::MatrixXd>& u, const MvLimits& limits,
                           double largest_share, double smallest_deviation);

}  // namespace mpm
