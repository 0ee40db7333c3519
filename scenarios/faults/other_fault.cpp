#include "scenarios/faults/other_fault.hpp"

#include <cassert>
#include <tuple>

#include "base/same_members.hpp"

namespace mpm {
namespace {

auto members(const OtherFault& fault) {
  const auto& [kind, variable, size, jump] = fault;
  return std::tie(kind, variable, size, jump);
}

std::unique_ptr<ValveStem> sticky(const OtherFault& fault, double u) {
  return std::make_unique<StickyValve>(fault.size, fault.jump, u);
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
       .meaning = "of a sensor whose error grows linearly from the onset to the end of the record",
       .sort = VariableSort::cv,
       .effect = FaultEffect::sensor_error,
       .size = &R::sensor,
       .unit = SizeUnit::noise,
       .has_either_sign = true,
       .grows_to_end = true},
      {.kind = OtherFaultKind::stiction,
       .meaning = "of a valve with the two parameters S and J of Choudhury, Thornhill and Shah (2005)",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .jump = &R::jump,
       .stem = sticky},
      {.kind = OtherFaultKind::deadband,
       .meaning = "of a valve with J = 0",
       .sort = VariableSort::mv,
       .effect = FaultEffect::valve,
       .size = &R::valve,
       .unit = SizeUnit::hard_range,
       .stem = sticky},
      {.kind = OtherFaultKind::md_gain,
       .meaning = "of an MD whose measurement has a wrong gain",
       .sort = VariableSort::md,
       .effect = FaultEffect::md_error,
       .size = &R::md_gain,
       .is_factor = true},
      {.kind = OtherFaultKind::md_noise,
       .meaning = "of an MD whose measurement is noisy",
       .sort = VariableSort::md,
       .effect = FaultEffect::md_error,
       .size = &R::md_noise},
      {.kind = OtherFaultKind::limit,
       .meaning = "of a soft range that was moved in the controller",
       .sort = VariableSort::cv,
       .effect = FaultEffect::limit,
       .size = &R::limit,
       .unit = SizeUnit::soft_range,
       .has_either_sign = true},
      {.kind = OtherFaultKind::held_mv,
       .meaning = "of an MV that an operator holds where it is, without the controller being told",
       .sort = VariableSort::mv,
       .effect = FaultEffect::hold},
  }};
  assert(table[static_cast<std::size_t>(kind)].kind == kind);
  return table[static_cast<std::size_t>(kind)];
}

bool operator==(const OtherFault& a, const OtherFault& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
