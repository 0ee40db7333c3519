#include "scenarios/faults/told_source.hpp"

namespace mpm {

ToldSource told_source(const OtherFault& fault) {
  switch (info_of(fault.kind).effect) {
    case FaultEffect::sensor_error:
    case FaultEffect::sensor_stuck:
    case FaultEffect::md_error:
      return ToldSource::sensor;
    case FaultEffect::valve:
      return ToldSource::valve;
    case FaultEffect::limit:
    case FaultEffect::hold:
      break;
  }
  return ToldSource::other;
}

}  // namespace mpm
