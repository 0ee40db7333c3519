#include "scenarios/faults/other_fault.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

#include "base/same_members.hpp"

namespace mpm {
namespace {

auto members(const OtherFault& fault) {
  const auto& [kind, variable, size, jump, start] = fault;
  return std::tie(kind, variable, size, jump, start);
}

std::unique_ptr<ValveStem> sticky(const OtherFault& fault, double u) {
  return std::make_unique<StickyValve>(fault.size, fault.jump, u, fault.start);
}

std::unique_ptr<ValveStem> stick_slip(const OtherFault& fault, double u) {
  return std::make_unique<FrictionValve>(fault.size, 0.0, u, fault.start);
}

std::unique_ptr<ValveStem> friction(const OtherFault& fault, double u) {
  return std::make_unique<FrictionValve>(fault.size, std::max(0.0, fault.size - fault.jump), u, fault.start);
}

}  // namespace

const OtherFaultInfo& info_of(OtherFaultKind kind) {
  using R = OtherRanges;
  static const std::array<OtherFaultInfo, kOtherFaultKinds.size()> table{{
      {.kind = OtherFaultKind::sensor_bias,
       .meaning = "relative frequency of a sensor with a bias",
       .sort = VariableSort::cv,
       .effect = FaultEffect::sensor_error,
       .size = &R::sensor,
       .unit = SizeUnit::noise,
       .has_either_sign = true},
      {.kind = OtherFaultKind::sensor_drift,
       .meaning = "the same for a sensor whose error grows linearly from the onset to the end of the record",
       .sort = VariableSort::cv,
       .effect = FaultEffect::sensor_error,
       .size = &R::sensor,
       .unit = SizeUnit::noise,
       .has_either_sign = true,
       .grows_to_end = true},
      {.kind = OtherFaultKind::stiction,
       .meaning = "the same for a valve with the two parameters S and J of Choudhury, Thornhill and Shah "
                  "(2005); it stops at every reversal like that of Kano et al. (2004)",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .jump = &R::jump,
       .stem = sticky},
      {.kind = OtherFaultKind::deadband,
       .meaning = "the same for a valve with J = 0",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .stem = sticky},
      {.kind = OtherFaultKind::md_gain,
       .meaning = "the same for an MD whose measurement has a wrong gain",
       .sort = VariableSort::md,
       .effect = FaultEffect::md_error,
       .size = &R::md_gain,
       .is_factor = true},
      {.kind = OtherFaultKind::md_noise,
       .meaning = "the same for an MD whose measurement is noisy",
       .sort = VariableSort::md,
       .effect = FaultEffect::md_error,
       .size = &R::md_noise},
      {.kind = OtherFaultKind::limit,
       .meaning = "the same for a soft range that was moved in the controller",
       .sort = VariableSort::cv,
       .effect = FaultEffect::limit,
       .size = &R::limit,
       .unit = SizeUnit::soft_range,
       .has_either_sign = true},
      {.kind = OtherFaultKind::held_mv,
       .meaning = "the same for an MV that an operator holds where it is, unknown to the controller",
       .sort = VariableSort::mv,
       .effect = FaultEffect::hold},
      {.kind = OtherFaultKind::sensor_stuck,
       .meaning = "the same for a sensor that keeps the value that it measured at the onset",
       .sort = VariableSort::cv,
       .effect = FaultEffect::sensor_stuck},
      {.kind = OtherFaultKind::stick_slip,
       .meaning = "the same for a valve after Stenman, Gustafsson and Forsman (2003): it stays until the "
                  "signal is d away, and then jumps to it",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .stem = stick_slip},
      {.kind = OtherFaultKind::friction,
       .meaning = "the same for a valve with static and kinetic friction f_S and f_D after He et al. (2007)",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .jump = &R::jump,
       .stem = friction},
  }};
  assert(table[static_cast<std::size_t>(kind)].kind == kind);
  return table[static_cast<std::size_t>(kind)];
}

bool operator==(const OtherFault& a, const OtherFault& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
