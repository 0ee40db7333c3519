#include "scenarios/faults/other_fault.hpp"

#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/same_members.hpp"

namespace mpm {
namespace {

auto members(const OtherFault& fault) {
  const auto& [kind, variable, size, jump] = fault;
  return std::tie(kind, variable, size, jump);
}

void require_width(const char* name, double width) {
  if (!std::isfinite(width) || width < 0.0)
    throw InputError(name, fmt::format("{}", width), "a finite number >= 0");
}

}  // namespace

VariableSort sort_of(OtherFaultKind kind) {
  switch (kind) {
    case OtherFaultKind::sensor_bias:
    case OtherFaultKind::sensor_drift:
    case OtherFaultKind::limit:
      return VariableSort::cv;
    case OtherFaultKind::stiction:
    case OtherFaultKind::deadband:
    case OtherFaultKind::held_mv:
      return VariableSort::mv;
    case OtherFaultKind::md_gain:
    case OtherFaultKind::md_noise:
      return VariableSort::md;
  }
  return VariableSort::cv;
}

bool operator==(const OtherFault& a, const OtherFault& b) {
  return same_members(members(a), members(b));
}

StickyValve::StickyValve(double stickband, double jump, double u)
    : stickband_(stickband), jump_(jump), position_(u), previous_(u), rest_(u) {
  require_width("stickband of a valve", stickband);
  require_width("jump of a valve", jump);
}

double StickyValve::follow(double u) {
  const double move = u - previous_;
  if (!rests_ && move * last_move_ <= 0.0) {
    rests_ = true;
    rest_ = previous_;
  }
  if (rests_ && -direction_ * (u - rest_) > stickband_) {
    direction_ = -direction_;
    rests_ = false;
  } else if (rests_ && direction_ * (u - rest_) > jump_) {
    rests_ = false;
  }
  if (!rests_)
    position_ = u - direction_ * (stickband_ - jump_) / 2.0;
  previous_ = u;
  last_move_ = move;
  return position_;
}

}  // namespace mpm
