#include "analysis/findings/fault_size.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

MismatchParameter parameter_of(FaultSize size) {
  switch (size) {
    case FaultSize::time_constant_factor:
      return MismatchParameter::time_constant;
    case FaultSize::dead_time_shift:
      return MismatchParameter::dead_time;
    default:
      return MismatchParameter::gain;
  }
}

/// Returns the size of the only fault of a random experiment; none if the fault is of another sort, such as a
/// changed actuator or a changed parameter of a nonlinear plant.
std::optional<double> size_of(const Study& study, const ExperimentDraw& draw, FaultSize size) {
  if (size == FaultSize::disturbance_deviation) {
    if (draw.kind != ExperimentKind::ud || draw.named || draw.disturbances.empty())
      return std::nullopt;
    return disturbance_deviation(draw.disturbances.front(), study.disturbance.v_standard_deviation,
                                 study.controller.sample_time);
  }
  if (draw.kind != ExperimentKind::mpm || draw.named || draw.mismatches.empty() ||
      draw.mismatches.front().parameter != parameter_of(size))
    return std::nullopt;
  return draw.mismatches.front().value;
}

SizeBin bin_of(std::span<const SizedFault> faults, double confidence) {
  std::vector<double> sizes;
  std::int64_t flagged = 0, diagnosed = 0;
  for (const SizedFault& fault : faults) {
    sizes.push_back(fault.size);
    flagged += fault.flagged ? 1 : 0;
    diagnosed += fault.diagnosed ? 1 : 0;
  }
  const auto total = static_cast<std::int64_t>(faults.size());
  return {sizes.front(), sorted_quantile(sizes, 0.5), sizes.back(), rate(flagged, total, confidence),
          rate(diagnosed, total, confidence)};
}

}  // namespace

double disturbance_deviation(const Disturbance& disturbance, double v_deviation, double sample_time) {
  // (1 - a)/(1 + a) = tanh(Ts/2 tau), without the cancellation in 1 - a for slow disturbances.
  return std::abs(disturbance.gain) * v_deviation *
         std::sqrt(std::tanh(0.5 * sample_time / disturbance.time_constant));
}

std::vector<SizedFault> faults_by_size(const Study& study, std::size_t method, const RecordRange& records,
                                       FaultSize size) {
  std::vector<SizedFault> faults;
  records.each([&](const ExperimentRecord& record) {
    const std::optional<double> found = size_of(study, record.draw, size);
    const AssessmentRecord& said = record.assessments[method];
    if (!said.answered() || !found || !std::isfinite(*found))
      return;
    faults.push_back(
        {record.draw.index, *found, said.flagged, said.flagged && !judge(study, record, said).wrong()});
  });
  std::stable_sort(faults.begin(), faults.end(),
                   [](const SizedFault& a, const SizedFault& b) { return a.size < b.size; });
  return faults;
}

std::vector<SizeBin> size_bins(std::span<const SizedFault> faults, int bins, double confidence) {
  if (bins < 1)
    throw InputError("number of bins", fmt::format("{}", bins), "1 or more");
  const std::size_t count = std::min(static_cast<std::size_t>(bins), faults.size());
  std::vector<SizeBin> result;
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t first = b * faults.size() / count;
    const std::size_t end = (b + 1) * faults.size() / count;
    result.push_back(bin_of(faults.subspan(first, end - first), confidence));
  }
  return result;
}

}  // namespace mpm
