#include "analysis/findings/reference.hpp"

#include <limits>

namespace mpm {

double reference_value(const Study& study, std::string_view name) {
  for (const ReferenceValue& reference : study.reference)
    if (reference.name == name)
      return reference.value;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mpm
