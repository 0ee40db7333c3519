#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "analysis/findings/finding.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// A claim about one number of a study: minimum <= number <= maximum.
struct Gate {
  std::string name;  ///< of the number, a finding of the study
  double minimum = -kInfinity;
  double maximum = kInfinity;
  bool with_confidence = false;    ///< judged by the interval of the number instead of the number itself
  std::int64_t minimum_count = 1;  ///< fewer experiments behind the number show nothing
  std::string reason = {};         ///< why the limits stand where they do
};

/// Whether the claim was shown to hold, shown not to hold, or neither.
enum class GateOutcome : std::int8_t { pass, fail, inconclusive };

template <>
inline constexpr auto kWords<GateOutcome> = word_list("pass", "fail", "inconclusive");

/// Why a gate is inconclusive.
enum class GateDoubt : std::int8_t {
  none,
  no_value,     ///< nothing was measured, or no finite number
  too_few,      ///< less than minimum_count
  no_interval,  ///< judged by an interval that the number does not have
  straddles,    ///< part of the interval is within the limits, and part is not
};

struct GateResult {
  Gate gate;
  Finding measured;
  GateOutcome outcome = GateOutcome::inconclusive;
  GateDoubt doubt = GateDoubt::none;
  /// Distance of the number or interval from changing the outcome, in the unit of the number; NaN without a
  /// number. For a gate that passes it is positive, the distance to the nearest limit. Otherwise it is
  /// negative, the distance by which a value, a whole interval, or (inconclusive) one end of an interval is
  /// beyond its limit.
  double margin = kNaN;
};

/// Judges `measured`, with [a, b] its interval, or a = b = its value without `with_confidence`:
///
/// | outcome      | when                                  | margin                         |
/// |--------------|---------------------------------------|--------------------------------|
/// | pass         | minimum <= a and b <= maximum         | min(a - minimum, maximum - b)  |
/// | fail         | b < minimum or maximum < a            | min(b - minimum, maximum - a)  |
/// | inconclusive | neither, or nothing to be judged      | min(a - minimum, maximum - b)  |
GateResult judge(const Gate& gate, const Finding& measured);

}  // namespace mpm
