#include "analysis/findings/gate.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

GateDoubt doubt_about(const Gate& gate, const Finding& measured) {
  if (!std::isfinite(measured.value))
    return GateDoubt::no_value;
  if (measured.count < gate.minimum_count)
    return GateDoubt::too_few;
  if (gate.with_confidence &&
      (!std::isfinite(measured.interval.lower) || !std::isfinite(measured.interval.upper)))
    return GateDoubt::no_interval;
  return GateDoubt::none;
}

}  // namespace

GateResult judge(const Gate& gate, const Finding& measured) {
  GateResult result{gate, measured};
  result.doubt = doubt_about(gate, measured);
  if (result.doubt != GateDoubt::none)
    return result;
  const Interval judged = gate.with_confidence ? measured.interval : Interval{measured.value, measured.value};
  const double inside = std::min(judged.lower - gate.minimum, gate.maximum - judged.upper);
  const double reach = std::min(judged.upper - gate.minimum, gate.maximum - judged.lower);
  if (inside >= 0.0) {
    result.outcome = GateOutcome::pass;
    result.margin = inside;
  } else if (reach < 0.0) {
    result.outcome = GateOutcome::fail;
    result.margin = reach;
  } else {
    result.doubt = GateDoubt::straddles;
    result.margin = inside;
  }
  return result;
}

}  // namespace mpm
