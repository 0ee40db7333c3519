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

StickyValve::StickyValve(double stickband, double jump, double u, double start)
    : stickband_(stickband), jump_(jump), position_(u), previous_(u), rest_(u) {
  require_width("stickband of a valve", stickband);
  require_width("jump of a valve", jump);
  if (start != 0.0) {
    position_ += start * (stickband + jump) / 2.0;
    rest_ = position_ + (stickband - jump) / 2.0;
  }
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

FrictionValve::FrictionValve(double static_friction, double kinetic_friction, double u, double start)
    : static_(static_friction), kinetic_(kinetic_friction), position_(u + start * static_friction) {
  require_width("static friction of a valve", static_friction);
  require_width("kinetic friction of a valve", kinetic_friction);
  if (kinetic_friction > static_friction)
    throw InputError("kinetic friction of a valve", fmt::format("{}", kinetic_friction),
                     fmt::format("at most the static one, {}", static_friction));
}

double FrictionValve::follow(double u) {
  if (std::abs(u - position_) > static_)
    position_ = u - std::copysign(kinetic_, u - position_);
  return position_;
}

}  // namespace mpm
