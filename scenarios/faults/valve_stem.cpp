#include "scenarios/faults/valve_stem.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_width(const char* name, double width) {
  if (!std::isfinite(width) || width < 0.0)
    throw InputError(name, fmt::format("{}", width), "a finite number >= 0");
}

}  // namespace

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
