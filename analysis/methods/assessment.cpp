#include "analysis/methods/assessment.hpp"

#include <cmath>
#include <utility>

#include "base/non_finite.hpp"

namespace mpm {

SizeBound bound_within(double estimate, double first, double last, double share) {
  const double close = share * (last - first);
  if (!std::isfinite(close))
    return SizeBound::none;
  return estimate <= first + close  ? SizeBound::at_most
         : estimate >= last - close ? SizeBound::at_least
                                    : SizeBound::none;
}

bool NamedMismatch::holds(double value) const {
  return (lower <= value || bound == SizeBound::at_most) && (value <= upper || bound == SizeBound::at_least);
}

std::optional<Eigen::Index> Assessment::worst_cv() const {
  std::optional<Eigen::Index> worst;
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    const bool worse = !worst || cvs[i].score > cvs[static_cast<std::size_t>(*worst)].score;
    if (!std::isnan(cvs[i].score) && worse)
      worst = static_cast<Eigen::Index>(i);
  }
  return worst;
}

double Assessment::number(std::string_view name, Eigen::Index cv, Eigen::Index column) const {
  for (const AssessmentNumber& number : numbers)
    if (number.name == name && number.cv == cv && number.column == column)
      return number.value;
  return kNaN;
}

Assessment Assessment::not_applicable(std::string reason) {
  Assessment assessment;
  assessment.status = AssessmentStatus::not_applicable;
  assessment.reason = std::move(reason);
  return assessment;
}

Assessment Assessment::failed(std::string reason) {
  Assessment assessment;
  assessment.status = AssessmentStatus::failed;
  assessment.reason = std::move(reason);
  return assessment;
}

}  // namespace mpm
