#include "scenarios/faults/fault_ranges.hpp"

namespace mpm {

std::string_view to_string(MismatchExtent extent) {
  switch (extent) {
    case MismatchExtent::parameter:
      return "parameter";
    case MismatchExtent::channel:
      return "channel";
    case MismatchExtent::cv:
      return "cv";
    case MismatchExtent::mv:
      return "mv";
    case MismatchExtent::plant:
      return "plant";
  }
  return "unknown";
}

std::string_view to_string(DisturbanceShape shape) {
  switch (shape) {
    case DisturbanceShape::white:
      return "white";
    case DisturbanceShape::step:
      return "step";
    case DisturbanceShape::ramp:
      return "ramp";
    case DisturbanceShape::random_walk:
      return "random_walk";
    case DisturbanceShape::sine:
      return "sine";
    case DisturbanceShape::burst:
      return "burst";
  }
  return "unknown";
}

std::string_view to_string(DisturbancePlace place) {
  switch (place) {
    case DisturbancePlace::cv:
      return "cv";
    case DisturbancePlace::mv:
      return "mv";
    case DisturbancePlace::several:
      return "several";
  }
  return "unknown";
}

}  // namespace mpm
