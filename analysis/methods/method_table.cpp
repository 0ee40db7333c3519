#include "analysis/methods/method_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/methods.hpp"
#include "plants/error.hpp"

namespace mpm {

const std::vector<AssessmentMethodInfo>& assessment_methods() {
  static const std::vector<AssessmentMethodInfo> methods{
      botelho_method(), sun_method(), badwe2009_method(), badwe2010_method(), yu_qin_method(), sse_method(),
  };
  return methods;
}

const AssessmentMethodInfo& assessment_method(std::string_view name) {
  for (const AssessmentMethodInfo& method : assessment_methods())
    if (method.name == name)
      return method;
  throw InputError("method", fmt::format("'{}'", name),
                   fmt::format("{}", fmt::join(assessment_method_names(), ", ")));
}

std::vector<std::string> assessment_method_names() {
  std::vector<std::string> names;
  for (const AssessmentMethodInfo& method : assessment_methods())
    names.push_back(method.name);
  return names;
}

}  // namespace mpm
