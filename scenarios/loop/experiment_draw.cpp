#include "scenarios/loop/experiment_draw.hpp"

#include <map>
#include <utility>

namespace mpm {

std::vector<AffectedCv> ExperimentDraw::affected() const {
  std::map<Eigen::Index, std::pair<bool, bool>> faults;  // CV -> mismatch, disturbance
  for (const Mismatch& mismatch : mismatches)
    faults[mismatch.cv].first = true;
  for (const Disturbance& disturbance : disturbances)
    if (disturbance.is_on_cv())
      faults[disturbance.cv].second = true;
  if (affected_cvs) {
    const auto own = std::exchange(faults, {});
    for (const Eigen::Index cv : *affected_cvs)
      faults[cv] = own.contains(cv)
                       ? own.at(cv)
                       : std::pair(!mismatches.empty() || !parameters.empty(), !disturbances.empty());
  }
  std::vector<AffectedCv> list;
  for (const auto& [cv, fault] : faults)
    list.push_back({cv, fault.first && fault.second ? FaultSource::mpm_ud
                        : fault.first               ? FaultSource::mpm
                        : fault.second              ? FaultSource::ud
                                                    : FaultSource::none});
  return list;
}

Eigen::Index ExperimentDraw::true_cv() const {
  const std::vector<AffectedCv> list = affected();
  return list.size() == 1 ? list.front().cv : -1;
}

ExperimentDraw ExperimentDraw::mismatch_alone() const {
  ExperimentDraw alone = *this;
  alone.disturbances.clear();
  alone.kind = kind_of(alone.mismatches, alone.parameters, alone.disturbances);
  return alone;
}

ExperimentDraw ExperimentDraw::disturbance_alone() const {
  ExperimentDraw alone = *this;
  alone.mismatches.clear();
  alone.parameters.clear();
  alone.kind = kind_of(alone.mismatches, alone.parameters, alone.disturbances);
  return alone;
}

ExperimentDraw ExperimentDraw::without_faults() const {
  ExperimentDraw healthy;
  healthy.index = index;
  healthy.noise_index = noise_index;
  healthy.noise_factor = noise_factor;
  healthy.world = world;
  return healthy;
}

}  // namespace mpm
